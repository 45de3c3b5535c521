"""Shapes of lights: a module each."""
