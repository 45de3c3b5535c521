"""What makes a smooth picture of few shadow rays a pixel."""
