"""What is lit and seen: lights, cameras, and rays against the object."""
