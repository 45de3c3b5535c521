"""What holds of the objects of every generated scene."""

import numpy as np

from neural_shadows.frames.draw_settings import FrameKind, draw_setting
from neural_shadows.frames.soft_scene import SoftScene
from neural_shadows.scenes.arrangement import Arrangement
from neural_shadows.scenes.generated import arrange

PICTURE = {"kind": "perspective", "fov": 120, "resolution": 64}
KINDS = {
    "whole": FrameKind(512, 256, 55, None, PICTURE, radius=0.25),
    "window": FrameKind(512, 256, 55, (1024, 512), PICTURE, radius=0.5),
    "small": FrameKind(512, 256, 55, (2048, 1024), {"kind": "cube", "resolution": 64}, 0.0625),
}

NEAR = ("passage",)  # lights hang among objects: no room for the large ones


def check_objects(drawn: Arrangement) -> None:
    """Assert that names are unique, nothing is under the floor, and meshes have no empty faces."""
    names = [part.name for part in drawn.objects]
    assert len(set(names)) == len(names) and drawn.mover in names
    for part in drawn.objects:
        corners = part.vertices[part.faces].astype(float)
        doubled = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
        assert np.linalg.norm(doubled, axis=1).min() > 1e-9, part.name
        assert part.vertices[:, 1].min() >= -1e-5, part.name
        assert len(np.unique(part.faces)) == len(part.vertices), part.name


def check_layout(name: str, seed: int) -> Arrangement:
    """Assert that a seed gives a layout with frames of each kind, and give it."""
    drawn = arrange(name, seed)
    assert 8_000 <= sum(len(part.faces) for part in drawn.objects) <= 60_000
    assert len(drawn.spots) == 2
    check_objects(drawn)
    scene = SoftScene({"generate": name, "seed": seed, "inserted": {}}, [])
    for kind in [KINDS["small"]] if name in NEAR else KINDS.values():
        draw_setting(scene, kind, np.random.default_rng(0))  # or an InputError that says why not
    return drawn
