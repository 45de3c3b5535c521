"""What must hold between the sections of a configuration; a file for each section."""
