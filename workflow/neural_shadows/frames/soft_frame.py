"""One frame as the methods for soft shadows are given it: surface points, a light, its map."""

from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np

from neural_shadows.rendering.soft_shadows import OFFSET
from neural_shadows.rendering.surface import Surface, see_surface
from neural_shadows.scenes.scene import Scene
from neural_shadows.shadow_maps.light_filters import receiver_bias
from neural_shadows.shadow_maps.light_map import LightMap, distances_of
from neural_shadows.shadow_maps.rasterised_light_map import rasterised_depths


@dataclass(frozen=True, eq=False)
class SoftFrame:
    """A frame's n surface points at pixel centres, and the light that they are asked about.

    Lengths are in the scene's unit. What is cached is made when it is first asked for, so that a
    method is timed with what it uses and no more.
    """

    scene: Scene
    surface: Surface
    centre: np.ndarray  # (3,) float64, of the light
    light_map: LightMap
    number: int = 0  # in a sequence: noise is another in each frame

    @cached_property
    def depths(self) -> np.ndarray:
        """The whole map, (texels,) float32: distances from the light, ∞ where there is nothing."""
        mesh = self.scene.joined
        return rasterised_depths(self.light_map, mesh.vertices, mesh.faces)

    @cached_property
    def ways(self) -> np.ndarray:
        """From the light to each point, (n, 3) float32."""
        return self.surface.p - self.centre.astype(np.float32)

    @cached_property
    def cosines(self) -> np.ndarray:
        """Between each point's geometric normal and the direction to the light, (n,) float32."""
        away = np.einsum("ij,ij->i", self.ways, self.surface.n_g)
        return -away / distances_of(self.ways)

    @cached_property
    def bias(self) -> np.ndarray:
        """By how much a point may lie behind its texel and still be lit, (n,) float32."""
        return receiver_bias(self.light_map, self.ways, self.cosines, self.scene.size)

    @cached_property
    def starts(self) -> np.ndarray:
        """Where rays start, (n, 3) float32: a little off the surface, on the side that is seen."""
        return self.surface.p + np.float32(OFFSET * self.scene.size) * self.surface.n_g

    def with_map_of(self, resolution: int) -> "SoftFrame":
        """The same frame by a map of another number of texels a side, made once."""
        if resolution not in self._by_resolution:
            finer = replace(self.light_map, resolution=resolution)
            self._by_resolution[resolution] = replace(self, light_map=finer)
        return self._by_resolution[resolution]

    @cached_property
    def _by_resolution(self) -> "dict[int, SoftFrame]":
        return {self.light_map.resolution: self}

    def at_places(self, places: "tuple[tuple[float, float], ...]") -> "list[SoftFrame]":
        """The same frame seen at other places in its pixels, each made once; each has a number of its
        own, so that their rays go elsewhere.
        """
        if places not in self._by_places:
            surface, first = self.surface, self.number * len(places)
            seen = (surface.camera, surface.width, surface.height)
            self._by_places[places] = [
                replace(self, surface=see_surface(self.scene, *seen, place), number=first + k)
                for k, place in enumerate(places)
            ]
        return self._by_places[places]

    @cached_property
    def _by_places(self) -> "dict[tuple[tuple[float, float], ...], list[SoftFrame]]":
        return {}
