"""A scene in metres, from its settings, with a movable object."""

from collections.abc import Sequence
from functools import cached_property, lru_cache
from pathlib import Path

import numpy as np

from neural_shadows.frames.plate_height import height_of
from neural_shadows.meshes.prepared_mesh import PreparedMesh, read_prepared, with_normals
from neural_shadows.scenes.arrangement import Arrangement, scene_of
from neural_shadows.scenes.generated import arrange, generator
from neural_shadows.scenes.scene import Scene
from neural_shadows.settings.records import GeneratedScene


class SoftScene:
    """An arrangement with inserted meshes.

    Args:
        scene: `generate`, the generator's name; `seed`; `inserted`, of each mesh by name its up axis;
            of a plate `penumbra`, its width, see `height_of`, or the `height` found for it.
        meshes: the prepared mesh of each, in that order.

    Raises:
        InputError: an unknown generator, fewer spots than meshes, an unreadable mesh, or a penumbra
            width out of reach.
    """

    def __init__(self, scene: GeneratedScene, meshes: Sequence[Path]):
        ups = scene["inserted"].items()
        self._inserted = {name: _upright(path, up) for (name, up), path in zip(ups, meshes)}
        self.settings = dict(scene)  # reopens the scene: with the height found
        if scene.get("penumbra") is None:
            self.arrangement: Arrangement = arrange(scene["generate"], scene["seed"])
        else:
            if "height" not in scene:
                rng = np.random.default_rng(scene["seed"])
                self.settings["height"] = height_of(self._inserted, scene["penumbra"], rng)
            self.arrangement = generator("plate").arrange_plate(self.settings["height"])

    @cached_property
    def at_rest(self) -> Scene:
        """The scene with its mover at rest."""
        return scene_of(self.arrangement, self._inserted)

    def moved(self, motion: np.ndarray) -> Scene:
        """The scene after a (4, 4) motion of its mover."""
        if np.array_equal(motion, np.eye(4)):
            return self.at_rest
        return scene_of(self.arrangement, self._inserted, motion)

    def before(self, scene: Scene, face: np.ndarray, p: np.ndarray, now, then) -> np.ndarray:
        """Positions after the motion `then` of points (n, 3) after `now`.

        Args:
            face: (n,) of the scene's joined mesh.
        """
        moving = scene.owner[face] == self.arrangement.mover_index
        motion = then @ np.linalg.inv(now)
        was = p.copy()
        was[moving] = p[moving] @ motion[:3, :3].T + motion[:3, 3]
        return was


# Else each of 18 scenes with the same two meshes reads them anew: 0.25 s of 0.45.
@lru_cache(maxsize=4)
def _upright(mesh_ply: Path, up: str) -> PreparedMesh:
    """Read a mesh and turn its axis `up` to y."""
    mesh = read_prepared(mesh_ply)
    turn = np.roll(np.eye(3, dtype=np.float32), 1 - "xyz".index(up), axis=0)
    return with_normals(mesh.vertices @ turn.T, mesh.faces)
