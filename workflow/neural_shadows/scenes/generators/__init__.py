"""Seeded scenes in metres, one module each with `arrange(rng)`."""
