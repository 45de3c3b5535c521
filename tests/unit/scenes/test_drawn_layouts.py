"""Scenes whose whole layout is drawn: another for each seed, and usable for each.

tests/corpus/test_layouts.py has more seeds.
"""

import numpy as np
import pytest
from placed_objects import check_layout


@pytest.mark.parametrize("name", ["interior", "court", "grove", "passage"])
def test_seeds_are_usable_layouts_of_their_own(name):
    """Of another size, with other objects, lit and seen from elsewhere."""
    drawn = [check_layout(name, seed) for seed in range(1, 9)]
    sizes = [np.ptp(one.objects[0].vertices, axis=0)[[0, 2]] for one in drawn]
    assert np.ptp(sizes, axis=0).min() > 1.0
    pieces = [tuple(sorted(len(part.faces) for part in one.objects)) for one in drawn]
    assert len(set(pieces)) == len(drawn)
    for region in ("lights", "cameras"):
        boxes = [getattr(one, region) for one in drawn]
        middles = np.array([(box.low + box.high) / 2 for box in boxes])
        apart = np.linalg.norm(middles[:, None] - middles, axis=-1)
        assert np.median(apart[np.triu_indices(len(drawn), 1)]) > 0.5, region
