"""Consistency checks between sections, one file per section."""
