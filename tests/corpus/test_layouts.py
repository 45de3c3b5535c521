"""Many seeds of the scenes whose whole layout is drawn; the shipped ones are in tests/unit."""

import pytest
from placed_objects import check_layout


@pytest.mark.parametrize("name", ["interior", "court", "grove", "passage"])
@pytest.mark.parametrize("seed", range(9, 49))
def test_each_seed_has_usable_frames(name, seed):
    check_layout(name, seed)
