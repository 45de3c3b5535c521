"""Input of soft-shadow methods: surface points, a light, its map."""

from collections.abc import Hashable
from dataclasses import dataclass, replace
from functools import cached_property
from typing import Any

import numpy as np

from neural_shadows.rendering.lengths import lengths_and_cosines
from neural_shadows.rendering.light_shape import SPHERE, LightShape
from neural_shadows.rendering.soft_shadows import OFFSET
from neural_shadows.rendering.surface import Surface, see_surface
from neural_shadows.scenes.scene import Scene
from neural_shadows.shadow_maps.light_filters import receiver_bias
from neural_shadows.shadow_maps.light_map import LightMap
from neural_shadows.shadow_maps.rasterised_light_map import rasterised_depths


@dataclass(frozen=True, eq=False)
class SoftFrame:
    """A frame's n surface points at pixel centres, and a light.

    Lengths are in the scene's unit. Cached properties are computed on first use, so that a method's
    time includes only what it uses.
    """

    scene: Scene
    surface: Surface
    centre: np.ndarray  # (3,) float64, of the light
    light_map: LightMap
    number: int = 0  # in a sequence, for different noise in each frame
    shape: LightShape = SPHERE

    @cached_property
    def depths(self) -> np.ndarray:
        """The whole map, (texels,) float32: distances from the light, ∞ without a surface."""
        mesh = self.scene.joined
        return rasterised_depths(self.light_map, mesh.vertices, mesh.faces)

    @cached_property
    def shown(self) -> np.ndarray:
        """Faces seen in the looked-up texels, (texels,) int32; by rays."""
        return self.traced(self.light_map.texels_of(self.from_light))[1]

    def traced(self, texels: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Trace a map's depths and faces, (texels,) float32 and int32.

        Args:
            texels: those traced, −1 for none; the others have 0.
        """
        looked_up = np.zeros(self.light_map.count, bool)
        looked_up[texels[texels >= 0]] = True
        texels = np.flatnonzero(looked_up)
        # np.zeros: only written pages take memory and time.
        depths = np.zeros(self.light_map.count, np.float32)
        faces = np.zeros(self.light_map.count, np.int32)
        depths[texels], faces[texels] = self.light_map.first_hits(self.scene.tracer, texels)
        return depths, faces

    @cached_property
    def from_light(self) -> np.ndarray:
        """Vectors from the light to each point, (n, 3) float32."""
        return self.surface.p - self.centre.astype(np.float32)

    @cached_property
    def cosines(self) -> np.ndarray:
        """Cosines of geometric normals with the light's direction, (n,) float32."""
        return -lengths_and_cosines(self.from_light, self.surface.n_g)[1]

    @cached_property
    def bias(self) -> np.ndarray:
        """Depth bias of each point, (n,) float32."""
        return receiver_bias(self.light_map, self.from_light, self.cosines, self.scene.size)

    @cached_property
    def starts(self) -> np.ndarray:
        """Ray origins, (n, 3) float32, offset from the surface to the seen side."""
        return self.surface.p + np.float32(OFFSET * self.scene.size) * self.surface.n_g

    def with_map_of(self, resolution: int) -> "SoftFrame":
        """The same frame with a map of another resolution, cached."""
        if resolution not in self._by_resolution:
            finer = replace(self.light_map, resolution=resolution)
            self._by_resolution[resolution] = replace(self, light_map=finer)
        return self._by_resolution[resolution]

    @cached_property
    def _by_resolution(self) -> "dict[int, SoftFrame]":
        return {self.light_map.resolution: self}

    @cached_property
    def kept(self) -> dict[Hashable, Any]:
        """What a method computes alike for many constants, the last alone; not in timed frames."""
        return {}

    def at_places(self, places: "tuple[tuple[float, float], ...]") -> "list[SoftFrame]":
        """The same frame at other places in its pixels, cached.

        Each has a number of its own, for different random rays.
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
