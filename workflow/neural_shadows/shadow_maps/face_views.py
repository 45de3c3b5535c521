"""Faces of a light's map with margins for kernels, and their receivers.

A cube's margin has its neighbours' depths along the same directions, so that a kernel goes on over
the seams; that of a single picture repeats its rim, as graphics hardware's "clamp to edge".
"""

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from neural_shadows.shadow_maps.light_map import LightMap


@dataclass(frozen=True, eq=False)
class FaceView:
    """A face's m receivers and its depths, with a margin."""

    face: int
    corner: tuple[int, int]  # row and column in the face of the first texel; below 0 in the margin
    receivers: np.ndarray  # (m,) int64, indices among all n
    places: np.ndarray  # (m, 2) float64, row and column; the centre of texel i is at i
    depths: np.ndarray  # (H, W) float32, may be a view of the map


def face_views(
    light_map: LightMap, depths: np.ndarray, from_light: np.ndarray, kernel: int
) -> Iterator[FaceView]:
    """Yield the faces with receivers: of a cube of 6 × 2048² 17 MB each.

    Args:
        depths: (texels,) float32 of the whole map. from_light: (n, 3) from the light to receivers.
        kernel: width in texels of the bilinear look-up, odd; the margin is wide enough.
    """
    margin = kernel // 2 + 1
    faces, places = light_map.places_of(from_light)
    for face in range(len(light_map.faces)):
        receivers = np.flatnonzero(faces == face)
        if not len(receivers):
            continue
        within = np.take(places, receivers, axis=0)  # seven times as fast as places[receivers]
        parts, corner = [], []
        for along in within.T:  # whole columns: numpy is slow along pairs
            along += margin - 0.5
            begin, end = int(along.min()) - kernel // 2, int(along.max()) + kernel // 2 + 2
            along -= begin
            parts.append(slice(begin, end))
            corner.append(begin - margin)
        part = _with_margin(light_map, depths, face, margin, *parts)
        yield FaceView(face, tuple(corner), receivers, within, part)


def _with_margin(
    light_map: LightMap, depths: np.ndarray, face: int, margin: int, rows: slice, columns: slice
) -> np.ndarray:
    """A part of a face with a margin: of the map itself if it is inside."""
    size = light_map.resolution
    inner = depths.reshape(-1, size, size)[face]
    spans = [(part.start - margin, part.stop - margin) for part in (rows, columns)]
    inside = [slice(max(begin, 0), min(end, size)) for begin, end in spans]
    beyond = [(max(-begin, 0), max(end - size, 0)) for begin, end in spans]
    if not np.any(beyond):
        return inner[*inside]
    if len(light_map.faces) == 1:
        return np.pad(inner[*inside], beyond, "edge")
    part = np.pad(inner[*inside], beyond)
    outside = np.pad(np.zeros_like(inner[*inside], bool), beyond, constant_values=True)
    row, column = np.nonzero(outside)
    texels = (row + rows.start) * (size + 2 * margin) + column + columns.start
    directions = light_map.widened(face, margin).directions_of(texels)
    part[outside] = depths[light_map.texels_of(directions)]
    return part
