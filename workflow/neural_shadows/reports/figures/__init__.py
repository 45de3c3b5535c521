"""Figures, a module for each `kind` in the configuration."""
