"""Seeded scenes in metres, one module each: `arrange(rng)` draws its arrangement."""
