"""Ways of a given length, as lights at a place need them."""

import numpy as np
from shapes import prepared, sheet


def test_what_lies_behind_the_goal_blocks_nothing():
    """embreex takes a ray's length in units of its direction; held to the pinned version."""
    _, tracer = prepared(sheet(0.0, 1.0))
    points = np.array([[0, 2, 0]] * 4, np.float32)
    ways = np.array([[0, -1.9, 0], [0, -2.1, 0], [0, -2, 0], [0, 1, 0]], np.float32)
    # The third ends on the sheet itself.
    assert tracer.blocked(points, ways).tolist() == [False, True, False, False]
