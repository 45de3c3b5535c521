"""Settings of trainings; in no digest of code."""
