"""Forms of networks of whole frames, a file each."""
