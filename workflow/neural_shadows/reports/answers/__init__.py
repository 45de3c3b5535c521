"""Visibility of the user's own frames by a method."""
