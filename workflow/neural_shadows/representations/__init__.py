"""Representations of an object besides its mesh."""
