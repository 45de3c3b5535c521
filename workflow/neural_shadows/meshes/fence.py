"""Procedural fence: woven diagonal wires in a frame [4.1.1].

x is along the panel, y up, z through it. The panel is 1 wide and `HEIGHT` high between the
centre lines of its bars; the lower bar lies on y = 0.
"""

import numpy as np
import trimesh

from neural_shadows.errors import InputError

HEIGHT = 0.75
SIDES = 8  # of a wire's cross-section
STEPS = 8  # rings of a wire from one crossing to the next
BAR_SIDES = 24
# Bars enclose the ends of the wires, up to WEAVE + 1 radii out of the plane.
BAR_RADII = 3.0
# Crossing wires are 2.1 radii apart between centre lines: they almost touch.
WEAVE = 1.05
# Widest wire, as a share of the distance between neighbours: beyond it the diamonds close.
MOST_COVERED = 0.5


def make_fence(*, wires: int, wire_radius: float) -> tuple[np.ndarray, np.ndarray]:
    """Vertices (V, 3) float64 and faces (F, 3) int64, closed parts.

    Args:
        wires: diamonds along the panel's width, 2 or more.
        wire_radius: of a wire, in widths of the panel.

    Raises:
        InputError: the wires leave no hole.
    """
    pitch = 1 / wires  # width and height of a diamond
    apart = pitch / np.sqrt(2)
    if not 0 < 2 * wire_radius <= MOST_COVERED * apart:
        raise InputError(
            f"fence: wire_radius = {wire_radius}: must be above 0 and at most "
            f"{MOST_COVERED * apart / 2:.4g} for {wires} wires, so that holes remain"
        )
    bar = BAR_RADII * wire_radius
    parts = [_tube(path, wire_radius) for path in _wire_paths(pitch, WEAVE * wire_radius)]
    corners = np.array([[0, 0, 0], [1, 0, 0], [1, HEIGHT, 0], [0, HEIGHT, 0]], float)
    for a, b in zip(corners, np.roll(corners, -1, axis=0), strict=True):
        along = (b - a) / np.linalg.norm(b - a)
        segment = np.stack([a - bar * along, b + bar * along])  # bars meet in full corners
        parts.append(trimesh.creation.cylinder(bar, segment=segment, sections=BAR_SIDES))
    fence = trimesh.util.concatenate(parts)
    return fence.vertices + [0, bar, 0], np.asarray(fence.faces, np.int64)


def _wire_paths(pitch: float, weave: float) -> list[np.ndarray]:
    """Centre lines (n, 3) of all wires, from bar to bar.

    Wires lie on x − y = i·pitch and x + y = j·pitch and cross at the pairs (i, j). At each the
    first is above the second where i + j is even and below it where odd, so that every wire goes
    over one and under the next.
    """
    paths = []
    # Along a wire its own number is fixed; the other's varies.
    for slope, first, last in ((1, -HEIGHT, 1), (-1, 0, 1 + HEIGHT)):
        for own in range(int(first / pitch), int(last / pitch) + 1):
            low, high = sorted([own * pitch, own * pitch + slope * HEIGHT])
            low, high = max(0, low), min(1, high)
            if high - low < pitch / 2:  # a corner's: shorter than one side of a diamond
                continue
            count = 1 + int(np.ceil((high - low) / (pitch / 2) * STEPS))
            x = np.linspace(low, high, count)
            y = slope * (x - own * pitch)
            side = slope * np.cos(np.pi * (own + (x + slope * y) / pitch))
            paths.append(np.stack([x, y, weave * side], axis=1))
    return paths


def _tube(path: np.ndarray, radius: float) -> trimesh.Trimesh:
    """Closed tube of `SIDES` sides along an upright planar path (n, 3)."""
    tangent = np.gradient(path, axis=0)
    tangent /= np.linalg.norm(tangent, axis=1, keepdims=True)
    across = np.cross([0.0, 0.0, 1.0], path[-1] - path[0])
    across /= np.linalg.norm(across)
    outward = np.cross(tangent, across)
    angle = 2 * np.pi * np.arange(SIDES) / SIDES
    ring = np.cos(angle)[:, None] * across + np.sin(angle)[:, None] * outward[:, None]
    vertices = np.concatenate([(path[:, None] + radius * ring).reshape(-1, 3), path[[0, -1]]])

    rings = len(path)
    k = np.arange(SIDES)
    after = (k + 1) % SIDES
    first = (np.arange(rings - 1) * SIDES)[:, None]
    a, b = first + k, first + after
    sides = np.stack([a, b, a + SIDES, b, b + SIDES, a + SIDES], axis=-1).reshape(-1, 3)
    start, end = rings * SIDES, rings * SIDES + 1
    last = (rings - 1) * SIDES
    caps = [
        np.stack([np.full(SIDES, start), after, k], axis=1),
        np.stack([np.full(SIDES, end), last + k, last + after], axis=1),
    ]
    return trimesh.Trimesh(vertices, np.concatenate([sides, *caps]), process=False)
