"""The configuration: a module for each section of config.yaml."""
