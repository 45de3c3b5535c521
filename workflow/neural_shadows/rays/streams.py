"""The random streams of a ray set.

Each use draws from (seed, stream, …), so that none repeats another's numbers, and a direction's
draws depend neither on shards nor on threads.
"""

DIRECTIONS = 0  # (seed, 0)
POINTS = 1  # (seed, 1, index of the direction)
PATTERNS = 2  # (seed, 2), Poisson-disk patterns shared by all directions
