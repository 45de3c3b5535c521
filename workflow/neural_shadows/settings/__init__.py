"""Base of all settings: strict models, and kinds found by file."""
