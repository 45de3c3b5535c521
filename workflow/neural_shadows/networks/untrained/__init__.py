"""Rivals of the networks: what answers the same query without any training."""
