"""Computation of soft shadows, imported when methods run."""
