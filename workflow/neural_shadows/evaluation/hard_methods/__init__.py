"""Families of methods for hard shadows without a network."""
