"""Families of methods for soft shadows: how much of a spherical light each point of a frame sees."""
