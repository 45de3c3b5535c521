"""Views of a scene under a sun, with references [4.1]."""

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, replace
from itertools import groupby
from pathlib import Path

import numpy as np

from neural_shadows.evaluation.frame import Inputs
from neural_shadows.evaluation.method import BIASES, Constants, Method, OfBias
from neural_shadows.evaluation.references import References
from neural_shadows.evaluation.registry import is_network, method_of, unbiased
from neural_shadows.metrics.kinds.errors_of_visibility import shadow_error
from neural_shadows.rendering.gbuffer import GBuffer
from neural_shadows.scenes.scene import Scene, open_scene

ERRORS = ("false_shadow", "light_leak")


@dataclass(frozen=True, eq=False)
class View:
    """A viewpoint of a batch.

    n of its points are of a surface, m of them on the lit side.

    Args:
        reference: visibility (n,). scene: None for a network.
    """

    path: Path
    number: int
    frame: GBuffer
    reference: np.ndarray
    scene: Scene | None

    @property
    def scene_name(self) -> str:
        """Name of its scene."""
        return self.path.parent.name

    def visibilities(self, method: Method, constants: Sequence[Constants]) -> Iterator[np.ndarray]:
        """The method's visibility (n,), once."""
        (chosen,) = constants
        yield self._of_bias(method, chosen)(chosen.get("depth_bias", 0.0))

    def _of_bias(self, method: Method, constants: Constants) -> OfBias:
        others = {name: value for name, value in constants.items() if name != "depth_bias"}
        return method.of_view(self.frame, self.scene, **others)

    def errors_of(
        self, method: Method, tried: Sequence[Sequence[Constants]]
    ) -> tuple[list[np.ndarray], float]:
        """Shares of points in error, of one radius (settings, 2), and 1.

        The method is evaluated once for all depth biases.
        """
        (settings,) = tried
        errors = []
        for _, of_equal_push in groupby(settings, lambda constants: constants.get("push")):
            chosen = [*of_equal_push]
            visibility = self._of_bias(method, chosen[0])
            for constants in chosen:
                error = shadow_error(visibility(constants["depth_bias"]), self.reference)
                errors.append((error.false_shadow, error.light_leak))
        return [np.array(errors)], 1

    def key(self, radius: int) -> dict[str, str | int]:
        """Columns of its metrics: the part is its view set."""
        view = self.frame.view
        place = {"scene": self.scene_name, "part": view.view_set, "frame": view.index}
        return place | {"radius": radius}

    def stored(self, visibility: np.ndarray, radius: int) -> dict[str, np.ndarray]:
        """Visibilities (m,) of the lit side, by its number."""
        return {str(self.number): visibility[self.frame.lit_side]}


def count_frames(paths: Sequence[Path]) -> int:
    """Views in files of references."""
    return sum(len(References(path)) for path in paths)


def count_radii(path: Path) -> int:
    """A sun has one radius, 0."""
    return 1


def open_frames(inputs: Inputs) -> Iterator[View]:
    """All views of some batches of a scene.

    Raises:
        InputError: a file cannot be read.
    """
    scene = open_scene(*inputs.meshes, **inputs.scene) if inputs.meshes else None
    for path in inputs.frames:
        for number, (frame, reference) in enumerate(References(path)):
            yield View(path, number, frame, reference, scene)


def open_methods(key: str, inputs: Inputs) -> Callable[[str], Method | None]:
    """The method of a key, for all scenes.

    Raises:
        InputError: a file of weights cannot be read.
    """
    name = unbiased(key)
    if not is_network(name):
        method = replace(method_of(name), constants={"depth_bias": BIASES}, joint=True)
    else:
        from neural_shadows.evaluation.ray_network import ray_method

        (weights,) = inputs.weights
        method = ray_method(weights, inputs.device, inputs.threads, inputs.precision)
    return lambda scene: method
