"""Denoisers of pictures of few shadow rays a pixel."""
