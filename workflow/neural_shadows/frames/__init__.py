"""Frames for screen-space networks: buffers, light maps and exact soft shadows."""
