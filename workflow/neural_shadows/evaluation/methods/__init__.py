"""Families of shadow methods: `METHODS` by key, and `LOOK`."""
