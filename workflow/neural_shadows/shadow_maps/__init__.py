"""Depth seen from the light, and the test against it [4.1]."""
