"""The kinds of claims, a file each."""
