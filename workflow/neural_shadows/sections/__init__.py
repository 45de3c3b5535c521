"""Models of the configuration's sections."""
