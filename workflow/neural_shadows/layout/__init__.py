"""Paths of results, and inputs and parameters of jobs."""
