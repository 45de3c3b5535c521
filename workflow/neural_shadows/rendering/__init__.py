"""What a camera sees of a scene, and the grey picture made of it [4.1]."""
