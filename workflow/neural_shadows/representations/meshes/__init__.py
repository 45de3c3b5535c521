"""Meshes with fewer triangles, or in fewer bytes."""
