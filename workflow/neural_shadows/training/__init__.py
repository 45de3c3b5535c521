"""Training of networks: resumable, reproducible from the seed [3.5, 4.1]."""
