"""Primary visibility, exact shadows, and grey pictures [4.1]."""
