"""Scenes whose whole layout is drawn: another for each seed, and usable for each."""

from functools import cache

import numpy as np
import pytest
from placed_objects import check_objects

from neural_shadows.frames.draw_settings import FrameKind, draw_setting
from neural_shadows.frames.soft_scene import SoftScene
from neural_shadows.scenes.generated import arrange

NAMES = ("interior", "court")
SEEDS = range(1, 21)
PICTURE = {"kind": "perspective", "fov": 120, "resolution": 64}
KINDS = {
    "whole": FrameKind(512, 256, 55, None, PICTURE, radius=0.25),
    "window": FrameKind(512, 256, 55, (1024, 512), PICTURE, radius=0.5),
    "small": FrameKind(512, 256, 55, (2048, 1024), {"kind": "cube", "resolution": 64}, 0.0625),
}

made = cache(arrange)


@pytest.mark.parametrize("name", NAMES)
@pytest.mark.parametrize("seed", SEEDS)
def test_each_seed_has_usable_frames(name, seed):
    drawn = made(name, seed)
    assert 10_000 <= sum(len(part.faces) for part in drawn.objects) <= 60_000
    assert len(drawn.spots) == 2
    check_objects(drawn)
    scene = SoftScene({"generate": name, "seed": seed, "inserted": {}}, [])
    for kind in KINDS.values():
        draw_setting(scene, kind, np.random.default_rng(0))  # or an InputError that says why not


@pytest.mark.parametrize("name", NAMES)
def test_seeds_are_layouts_of_their_own(name):
    """Of another size, with other objects, lit and seen from elsewhere."""
    drawn = [made(name, seed) for seed in SEEDS[:8]]
    sizes = [np.ptp(one.objects[0].vertices, axis=0)[[0, 2]] for one in drawn]
    assert np.ptp(sizes, axis=0).min() > 1.0
    pieces = [tuple(sorted(len(part.faces) for part in one.objects)) for one in drawn]
    assert len(set(pieces)) == len(drawn)
    for region in ("lights", "cameras"):
        boxes = [getattr(one, region) for one in drawn]
        middles = np.array([(box.low + box.high) / 2 for box in boxes])
        apart = np.linalg.norm(middles[:, None] - middles, axis=-1)
        assert np.median(apart[np.triu_indices(len(drawn), 1)]) > 0.5, region
