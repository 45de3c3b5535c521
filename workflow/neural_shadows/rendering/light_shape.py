"""Shape of an area light: a sphere or a polygon; kinds are in `light_shapes`."""

from collections.abc import Mapping
from importlib import import_module
from pathlib import Path
from typing import TYPE_CHECKING, Any, ClassVar, NamedTuple

import numpy as np
from pydantic import Field

from neural_shadows.settings.base import Model

if TYPE_CHECKING:  # sections import shapes for their settings
    from neural_shadows.scenes.arrangement import Region
    from neural_shadows.scenes.scene import Scene

# Symbols of the units in which radii of lights are configured.
UNITS = {"metres": "m", "scene_sizes": "S", "degrees": "°"}


class MapView(NamedTuple):
    """View of a light map that fits a whole scene."""

    forward: np.ndarray  # (3,) float64
    fov: float  # degrees
    near: float  # distance before which nothing lies, in the scene's unit


class LightShape(Model):
    """A light about its centre: a sphere, or a polygon that shines to both sides.

    From a point a sphere is a disc across the direction to its centre. Visibility is the visible
    share of the light's area, uniform, without cosines or distances, also of a polygon seen aslant. A
    light of radius r has the area of a disc of radius r, whatever its shape: methods that assume a
    sphere take the radius as it is. Lights of all radii about one centre are scaled copies, so that
    rings between them share samples.
    """

    shape: str = Field(description="name of a module of `light_shapes`")

    RADIUS_UNITS: ClassVar[tuple[str, ...]] = ("metres", "scene_sizes")
    MAPS: ClassVar[tuple[str, ...]] = ("perspective", "cube")  # kinds of light maps
    AWAY: ClassVar[float] = 0.0  # distance of a light far outside the scene, in the scene's sizes

    def corners(self) -> np.ndarray | None:
        """Corners of a polygon of size 1 about its centre, in turn; None for a sphere.

        (S, 3) float64. The triangles of the centre and two neighbours have equal areas.
        """
        return None

    def radius_of(self, size: float, unit: str, scene_size: float) -> float:
        """Radius in the scene's unit of a configured size in one of `UNITS`."""
        return {"metres": 1.0, "scene_sizes": scene_size}[unit] * self._radius_of_one() * size

    def reach(self, radius: float) -> float:
        """Largest distance of the light's points from its centre, for a radius."""
        corners = self.corners()
        if corners is None:
            return radius
        return radius / self._radius_of_one() * float(np.linalg.norm(corners, axis=1).max())

    def _radius_of_one(self) -> float:
        """Radius of the disc with the area of a light of size 1."""
        corners = self.corners()
        if corners is None:
            return 1.0
        doubled_areas = np.linalg.norm(np.cross(corners, np.roll(corners, -1, axis=0)), axis=1)
        return float(np.sqrt(doubled_areas.sum() / 2 / np.pi))

    def draw_centre(self, lights: "Region", scene: "Scene", rng: np.random.Generator) -> np.ndarray:
        """Draw a centre (3,) float64; `lights`: the scene's region for them."""
        return lights.draw(rng)

    def motion_unit(self, scene_size: float) -> float:
        """Length in which the light's motions are shares."""
        return max(1.0, self.AWAY) * scene_size

    def map_view(self, scene: "Scene", centre: np.ndarray) -> MapView | None:
        """View of a map that fits the scene; None where settings decide."""
        return None

    def ring_vectors(
        self,
        points: np.ndarray,
        shifts: np.ndarray,
        samples: np.ndarray,
        centre: np.ndarray,
        radii: np.ndarray,
        counts: np.ndarray,
        vectors: np.ndarray,
    ) -> None:
        """Fill `vectors` (n, Σ counts, 3) from points to the light, by ring.

        See `light_samples.ring_vectors` for the arguments.
        """
        from neural_shadows.rendering.light_samples import polygon_vectors, ring_vectors

        corners = self.corners()
        if corners is None:
            ring_vectors(points, shifts, samples, centre, radii, counts, vectors)
        else:
            corners = corners / self._radius_of_one()
            polygon_vectors(points, shifts, samples, centre, corners, radii, counts, vectors)


SPHERE = LightShape(shape="sphere")


def shape_module(name: str) -> Path:
    """Path of a shape's module: `sun.py` for `sun`."""
    return Path(__file__).with_name("light_shapes") / f"{name}.py"


def light_shape(settings: Mapping[str, Any] | None) -> LightShape:
    """Shape of its settings; a sphere without any.

    Imported by name, so that frames depend on their own shape only."""
    if settings is None:
        return SPHERE
    name = settings["shape"]
    return import_module(f"neural_shadows.rendering.light_shapes.{name}").Settings(**settings)
