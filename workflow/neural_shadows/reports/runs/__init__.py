"""A run as a whole: its manifest, and its numbers beside another's."""
