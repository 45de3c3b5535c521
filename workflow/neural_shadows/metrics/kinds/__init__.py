"""Metrics by family: see `metrics.registry`."""
