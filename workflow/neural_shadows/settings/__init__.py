"""What all settings are made of: models that refuse unknown keys, and kinds that are found by file."""
