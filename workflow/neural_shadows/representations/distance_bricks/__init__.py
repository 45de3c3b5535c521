"""Signed distances in a sparse grid of bricks, 4³ cells each."""
