"""Signed distances in a sparse grid of 4³-cell bricks."""
