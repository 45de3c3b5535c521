"""Voxels of an object, and their octrees."""
