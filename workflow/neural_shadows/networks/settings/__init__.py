"""Settings common to kinds of networks; in no digest of code."""
