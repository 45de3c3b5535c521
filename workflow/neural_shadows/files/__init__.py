"""Atomic writing of files, and reading with clear errors."""
