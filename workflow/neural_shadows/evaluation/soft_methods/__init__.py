"""Every way of answering how much of a spherical light each point of a frame sees."""
