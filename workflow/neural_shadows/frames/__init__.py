"""Frames that screen-space networks learn from: what a camera and a light's map see, and targets."""
