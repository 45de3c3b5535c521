"""Rivals of the networks for the same query, without any training."""
