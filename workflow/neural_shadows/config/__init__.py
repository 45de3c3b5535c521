"""The configuration: modules named after its sections."""
