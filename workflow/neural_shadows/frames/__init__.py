"""Frames of scenes in metres: buffers, light maps, exact soft shadows."""
