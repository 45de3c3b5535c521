"""A scene in metres, opened from its settings, with its mover at any place."""

from collections.abc import Mapping, Sequence
from functools import cached_property, lru_cache
from pathlib import Path
from typing import Any

import numpy as np

from neural_shadows.frames.plate_height import height_of
from neural_shadows.meshes.prepared_mesh import PreparedMesh, read_prepared, with_normals
from neural_shadows.scenes.arrangement import Arrangement, scene_of
from neural_shadows.scenes.generators.registry import arrange, generator
from neural_shadows.scenes.scene import Scene


class SoftScene:
    """An arrangement with the meshes that are inserted into it.

    Args:
        scene: `generate`, the generator's name; `seed`; `inserted`, of each mesh by name the axis
            that points up; of a plate `penumbra`, which is as wide, see `height_of`, or the
            `height` that was found for it.
        meshes: the prepared mesh of each, in that order.

    Raises:
        InputError: there is no such generator, it has fewer spots than meshes, a mesh cannot be
            read, or penumbrae cannot be as wide.
    """

    def __init__(self, scene: Mapping[str, Any], meshes: Sequence[Path]):
        ups = scene["inserted"].items()
        self._inserted = {name: _upright(path, up) for (name, up), path in zip(ups, meshes)}
        self.settings = dict(scene)  # as the scene can be opened again: with the height found
        if scene.get("penumbra") is None:
            self.arrangement: Arrangement = arrange(scene["generate"], scene["seed"])
        else:
            if "height" not in scene:
                rng = np.random.default_rng(scene["seed"])
                self.settings["height"] = height_of(self._inserted, scene["penumbra"], rng)
            self.arrangement = generator("plate").arrange_plate(self.settings["height"])

    @cached_property
    def at_rest(self) -> Scene:
        """The scene with its mover where it stands at rest."""
        return scene_of(self.arrangement, self._inserted)

    def moved(self, motion: np.ndarray) -> Scene:
        """The scene after a (4, 4) motion of its mover."""
        if np.array_equal(motion, np.eye(4)):
            return self.at_rest
        return scene_of(self.arrangement, self._inserted, motion)

    def before(self, scene: Scene, face: np.ndarray, p: np.ndarray, now, then) -> np.ndarray:
        """Where points (n, 3) of the scene after the motion `now` were after the motion `then`.

        Args:
            face: (n,) of the scene's joined mesh.
        """
        mover = [part.name for part in self.arrangement.objects].index(self.arrangement.mover)
        moves = scene.owner[face] == mover
        way = then @ np.linalg.inv(now)
        was = p.copy()
        was[moves] = p[moves] @ way[:3, :3].T + way[:3, 3]
        return was


# Of 18 scenes that insert the same two meshes, each would read them anew: 0.25 s of 0.45.
@lru_cache(maxsize=4)
def _upright(mesh_ply: Path, up: str) -> PreparedMesh:
    """The mesh turned so that its axis `up` becomes y."""
    mesh = read_prepared(mesh_ply)
    turn = np.roll(np.eye(3, dtype=np.float32), 1 - "xyz".index(up), axis=0)
    return with_normals(mesh.vertices @ turn.T, mesh.faces)
