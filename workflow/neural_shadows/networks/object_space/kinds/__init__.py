"""Kinds of networks of one object, a file each."""
