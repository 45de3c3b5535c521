"""What holds of the objects of every generated scene."""

import numpy as np

from neural_shadows.scenes.arrangement import Arrangement


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
