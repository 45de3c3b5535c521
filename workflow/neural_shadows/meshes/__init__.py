"""Mesh files, and clean meshes in their unit sphere [3.3.1]."""
