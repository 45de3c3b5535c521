"""Common settings of the kinds of networks; in no digest of code."""
