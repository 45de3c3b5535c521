"""Forms of screen-space networks, a file each."""
