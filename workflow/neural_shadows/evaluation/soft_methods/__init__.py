"""Families of methods for soft shadows: visibility of a spherical light at a frame's points."""
