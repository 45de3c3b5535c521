"""Untrained baselines for the networks' query."""
