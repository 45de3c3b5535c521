"""Procedural stand-in dragon: signed-distance parts, meshed by marching cubes.

x is forward, y up, z to the creature's right. It is about 2.2 units long, standing on y = 0, in an
arbitrary unit.
"""

from dataclasses import replace
from itertools import pairwise

import numpy as np
from scipy.interpolate import CubicSpline, PchipInterpolator
from scipy.spatial.transform import Rotation

from neural_shadows.meshes.meshed_parts import meshed
from neural_shadows.meshes.signed_distances import Part

# Rows (x, y, z, radius) from the nape over neck, withers, back and hips to the tail's tip.
SPINE = [
    (0.74, 1.33, 0.05, 0.085),
    (0.62, 1.30, 0.10, 0.085),
    (0.56, 1.12, 0.13, 0.088),
    (0.58, 0.92, 0.12, 0.105),
    (0.47, 0.74, 0.06, 0.140),
    (0.25, 0.64, 0.00, 0.175),
    (-0.05, 0.63, -0.04, 0.155),
    (-0.33, 0.60, 0.02, 0.160),
    (-0.58, 0.47, 0.08, 0.115),
    (-0.82, 0.24, 0.02, 0.085),
    (-0.93, 0.09, -0.22, 0.070),
    (-0.80, 0.06, -0.52, 0.058),
    (-0.48, 0.05, -0.68, 0.047),
    (-0.14, 0.05, -0.64, 0.038),
    (0.08, 0.10, -0.55, 0.030),
    (0.15, 0.25, -0.52, 0.024),
    (0.05, 0.36, -0.54, 0.018),
]


def curve(*points, count: int = 24) -> np.ndarray:
    """Spline (count, 4) through points (x, y, z, radius).

    Radii do not overshoot."""
    points = np.array(points, dtype=float)
    knots = np.r_[0, np.cumsum(np.linalg.norm(np.diff(points[:, :3], axis=0), axis=1))]
    at = np.linspace(0, knots[-1], count)
    return np.c_[CubicSpline(knots, points[:, :3])(at), PchipInterpolator(knots, points[:, 3])(at)]


def cones(rows: np.ndarray, blend: float) -> Part:
    """Chain of cones along rows (x, y, z, radius)."""
    return Part(np.stack([rows[:-1], rows[1:]], axis=1), blend)


def tube(blend: float, *points, count: int = 24) -> Part:
    """Chain of cones along the spline through points (x, y, z, radius)."""
    return cones(curve(*points, count=count), blend)


def ellipsoid(centre, radii, blend: float, carve: bool = False) -> Part:
    """One axis-aligned ellipsoid."""
    return Part(np.vstack([centre, np.diag(radii)])[None], blend, carve)


def membrane(rows_a: np.ndarray, rows_b: np.ndarray, scallop: float) -> Part:
    """Sheet of least thickness between two curves from one root.

    Its free edge is indented by `scallop`, a fraction of the curves' length.
    """
    lines = []
    for u in np.linspace(0, 1, 10):
        at = np.linspace(0, 1 - scallop * np.sin(np.pi * u), 20)
        a, b = (
            np.stack([np.interp(at, np.linspace(0, 1, len(r)), c) for c in r.T[:3]], axis=1)
            for r in (rows_a, rows_b)
        )
        lines.append(np.pad((1 - u) * a + u * b, ((0, 0), (0, 1))))
    grid = np.stack(lines)
    a, b, c, d = grid[:-1, :-1], grid[1:, :-1], grid[1:, 1:], grid[:-1, 1:]
    # At the root a = b: the other triangle of these quads has no area.
    halves = [(a, c, d), (a[:, 1:], b[:, 1:], c[:, 1:])]
    return Part(np.concatenate([np.stack(h, axis=2).reshape(-1, 3, 4) for h in halves]), 0.004)


def mirrored(parts: list[Part]) -> list[Part]:
    """Parts with their mirror images in z."""
    flip = np.array([1.0, 1.0, -1.0, 1.0])
    return parts + [replace(p, pieces=p.pieces * flip[: p.pieces.shape[2]]) for p in parts]


def placed(parts: list[Part], origin, scale: float, yaw: float, pitch: float = 0.0) -> list[Part]:
    """Parts scaled, pitched about z, turned about y, then moved.

    Angles in degrees."""
    turn = Rotation.from_euler("zy", [pitch, yaw], degrees=True).as_matrix()
    result = []
    for part in parts:
        pieces = part.pieces * scale
        pieces[..., :3] = pieces[..., :3] @ turn.T
        points = pieces[:, :1] if pieces.shape[1] == 4 else pieces  # semi-axes stay
        points[..., :3] += origin
        result.append(replace(part, pieces=pieces, blend=part.blend * scale))
    return result


def hide() -> list[Part]:
    """Belly plates, flank scales, crest, and tail blade."""
    rows = curve(*SPINE, count=240)
    tangents = np.gradient(rows[:, :3], axis=0)
    step = np.linalg.norm(tangents, axis=1).mean()
    tangents /= np.linalg.norm(tangents, axis=1, keepdims=True)
    plates, scales, crest = [], [], []
    dorsal, next_ring, ring = np.array([0.0, 1.0, 0.0]), 8.0, 0
    for i, ((*centre, radius), t) in enumerate(zip(rows, tangents, strict=True)):
        dorsal = dorsal + [0.0, 0.05, 0.0]  # counters the roll of parallel transport
        dorsal -= (dorsal @ t) * t
        dorsal /= np.linalg.norm(dorsal)
        side = np.cross(t, dorsal)
        if i < next_ring or i > len(rows) - 12:
            continue
        pitch = 0.030 + 0.12 * radius
        around = max(6, int(2 * np.pi * radius / pitch))
        for angle in 2 * np.pi * (np.arange(around) + 0.5 * (ring % 2)) / around:
            out = np.cos(angle) * dorsal + np.sin(angle) * side
            if np.cos(angle) > -0.55:
                # Tilted by 15 degrees: the rear edge stands off, as on a tiled roof.
                along, lift = 0.966 * t - 0.259 * out, 0.966 * out + 0.259 * t
                axes = 0.62 * pitch * along, 0.47 * pitch * np.cross(out, t), 0.26 * pitch * lift
                scales.append([centre + radius * out, *axes])
        along, lift = 0.966 * t + 0.259 * dorsal, 0.259 * t - 0.966 * dorsal
        axes = 0.75 * pitch * along, 0.72 * radius * side, 0.3 * pitch * lift
        plates.append([centre - 0.93 * radius * dorsal, *axes])
        if ring % 2 == 0:
            foot = centre + 0.9 * radius * dorsal
            front, back = foot - 0.75 * pitch * t, foot + pitch * t
            tip = foot + 1.5 * pitch * t + (0.65 * radius + 0.02) * dorsal
            crest.append([[*front, 0.012], [*back, 0.010], [*tip, 0.003]])
        next_ring += 0.8 * pitch / step
        ring += 1
    end = rows[-1, :3]
    for barb in (end - 0.03 * t - 0.09 * side, end - 0.03 * t + 0.09 * side):
        crest.append([[*(end + 0.03 * t), 0.014], [*barb, 0.003], [*(end + 0.22 * t), 0.003]])
    return [
        Part(np.array(plates), 0.012),
        Part(np.array(scales), 0.006),
        Part(np.array(crest), 0.006),
    ]


def head() -> list[Part]:
    """Head of about unit length: nape at the origin, snout along x."""
    teeth = []
    for x, long in [(0.5, 0.07), (0.61, 0.09), (0.72, 0.10), (0.83, 0.12), (0.94, 0.17)]:
        z = 0.146 - 0.09 * x
        teeth.append([(x, -0.07, z, 0.04), (x - 0.03, -0.1 - long, z + 0.01, 0.002)])
        low = 0.14 - 0.8 * x  # the lower jaw's rim
        teeth.append([(x - 0.13, low, z, 0.036), (x - 0.07, low + 0.07 + long, z, 0.002)])
    frill = [
        curve((0.08, -0.1, 0.13, 0.04), (-0.13, -0.04, 0.275, 0.026), (-0.34, 0.02, 0.42, 0.008)),
        curve((0.08, -0.1, 0.13, 0.04), (-0.16, -0.15, 0.255, 0.026), (-0.40, -0.2, 0.38, 0.008)),
        curve((0.08, -0.1, 0.13, 0.04), (-0.09, -0.24, 0.205, 0.026), (-0.26, -0.38, 0.28, 0.008)),
    ]
    sides = [
        # lip, jaw, nostril, brow, eye
        tube(0.04, (0.2, -0.04, 0.1, 0.08), (0.5, -0.05, 0.085, 0.055), (0.95, -0.06, 0.03, 0.042)),
        tube(0.03, (0.02, -0.06, 0.11, 0.08), (0.38, -0.3, 0.09, 0.05), (0.75, -0.6, 0.03, 0.045)),
        ellipsoid((0.9, 0.02, 0.05), (0.07, 0.05, 0.045), 0.03),
        ellipsoid((0.97, 0.035, 0.06), (0.03, 0.022, 0.03), 0.01, carve=True),
        tube(0.03, (0.5, 0.06, 0.06, 0.03), (0.3, 0.16, 0.13, 0.05), (0.05, 0.17, 0.15, 0.05)),
        ellipsoid((0.34, 0.075, 0.165), (0.075, 0.05, 0.05), 0.02, carve=True),
        ellipsoid((0.34, 0.075, 0.125), (0.05, 0.045, 0.045), 0.005),
        # great horn, small horn, frill
        tube(
            0.03,
            (0.05, 0.15, 0.11, 0.075),
            (-0.2, 0.32, 0.18, 0.06),
            (-0.52, 0.42, 0.23, 0.045),
            (-0.8, 0.40, 0.25, 0.028),
            (-1.02, 0.5, 0.24, 0.006),
            count=40,
        ),
        tube(0.03, (0.02, 0.05, 0.16, 0.055), (-0.18, 0.1, 0.28, 0.04), (-0.42, 0.2, 0.36, 0.006)),
        *[cones(rows, 0.02) for rows in frill],
        membrane(frill[0], frill[1], 0.25),
        membrane(frill[1], frill[2], 0.25),
        Part(np.array(teeth), 0.008),
    ]
    return [
        # skull, snout, floor of the mouth
        ellipsoid((0.14, 0.02, 0), (0.26, 0.2, 0.18), 0.08),
        tube(0.08, (0.2, 0.04, 0, 0.16), (0.5, 0.02, 0, 0.105), (0.98, -0.03, 0, 0.06)),
        tube(0.05, (0.05, -0.12, 0, 0.1), (0.38, -0.33, 0, 0.06), (0.75, -0.61, 0, 0.05)),
        *mirrored(sides),
        # tongue, nose horn, chin spike
        tube(0.01, (0.1, -0.14, 0, 0.06), (0.42, -0.28, 0, 0.055), (0.98, -0.42, 0, 0.015)),
        tube(0.03, (0.82, 0.0, 0, 0.06), (0.80, 0.11, 0, 0.035), (0.74, 0.21, 0, 0.004)),
        tube(0.03, (0.67, -0.58, 0, 0.05), (0.6, -0.69, 0, 0.03), (0.5, -0.78, 0, 0.004)),
    ]


def leg(points, yaw: float, size: float) -> list[Part]:
    """Leg along rows (x, y, z, radius), with a clawed foot.

    The foot has length `size`."""
    toe = [
        tube(0.05, (0.0, 0.3, 0, 0.2), (0.4, 0.3, 0, 0.15), (0.72, 0.15, 0, 0.13)),
        tube(0.02, (0.7, 0.2, 0, 0.12), (0.98, 0.22, 0, 0.08), (1.2, 0.02, 0, 0.015)),
    ]
    x, _, z, _ = points[-1]
    turns = [(-38, 1.0), (0, 1.0), (38, 1.0), (180, 0.7)]
    toes = [placed(toe, (x, 0, z), size * scale, yaw + turn) for turn, scale in turns]
    return [tube(0.04, *points, count=48), *(part for parts in toes for part in parts)]


def wing() -> list[Part]:
    """Half-raised right wing: arm, three fingers, thumb, membranes."""
    wrist = (0.12, 1.26, 0.36)
    fingers = [
        curve((*wrist, 0.03), (-0.03, 1.50, 0.50, 0.02), (-0.34, 1.60, 0.56, 0.006)),
        curve((*wrist, 0.03), (-0.24, 1.37, 0.57, 0.02), (-0.66, 1.32, 0.66, 0.006)),
        curve((*wrist, 0.03), (-0.33, 1.12, 0.54, 0.02), (-0.70, 0.98, 0.58, 0.006)),
    ]
    arm = curve(
        (0.22, 0.72, 0.10, 0.07),
        (0.08, 0.83, 0.20, 0.05),
        (-0.02, 0.96, 0.26, 0.042),
        (0.04, 1.12, 0.32, 0.036),
        (*wrist, 0.034),
        count=25,
    )
    elbow = 12
    fold = curve(
        (*arm[elbow, :3], 0.0), (-0.16, 0.82, 0.19, 0.0), (-0.36, 0.72, 0.10, 0.0), count=13
    )
    edges = [*fingers, np.concatenate([arm[:elbow:-1], fold])]
    return [
        cones(arm, 0.03),
        *[cones(rows, 0.01) for rows in fingers],
        tube(0.01, (*wrist, 0.03), (0.22, 1.33, 0.38, 0.02), (0.26, 1.27, 0.39, 0.005)),
        *[
            membrane(*pair, cut)
            for pair, cut in zip(pairwise(edges), (0.22, 0.22, 0.3), strict=True)
        ],
        membrane(arm[elbow::-1], fold, 0.0),
    ]


def creature() -> list[Part]:
    """All parts in joining order: bulk first, thin detail last."""
    legs = []
    for side, hind, fore in [(1, 0.0, 0.04), (-1, 0.12, -0.12)]:  # mid-stride
        z = 0.2 * side
        thigh, knee = (-0.36, 0.5, 0.6 * z, 0.13), (-0.22 + hind / 2, 0.33, 1.2 * z, 0.1)
        hock, sole = (-0.46 + hind, 0.17, 1.2 * z, 0.06), (-0.38 + hind, 0.06, 1.2 * z, 0.05)
        legs += leg([thigh, knee, hock, sole], -15 * side, 0.19)
        upper, elbow = (0.24, 0.56, 0.6 * z, 0.11), (0.16 + fore / 2, 0.34, 1.15 * z, 0.075)
        wrist, sole = (0.3 + fore, 0.15, 1.15 * z, 0.052), (0.3 + fore, 0.06, 1.15 * z, 0.05)
        legs += leg([upper, elbow, wrist, sole], -12 * side, 0.18)
    haunch = ellipsoid((-0.36, 0.5, 0.12), (0.17, 0.2, 0.1), 0.05)
    shoulder = ellipsoid((0.22, 0.56, 0.14), (0.12, 0.17, 0.08), 0.05)
    return [
        tube(0.01, *SPINE, count=200),
        ellipsoid((0.3, 0.55, 0.0), (0.19, 0.22, 0.17), 0.06),  # chest
        *mirrored([haunch, shoulder]),
        *hide(),
        *legs,
        *placed(head(), (0.72, 1.33, 0.05), 0.46, 12, -10),
        *mirrored(wing()),
    ]


def make_wyrm(cells: int = 220) -> tuple[np.ndarray, np.ndarray]:
    """Watertight mesh of the dragon: one piece, lowest point on y = 0.

    Args:
        cells: cells along the creature's longest side (x), 48 or more. At 48 the least radius
            enlarges the volume by 40 % and closes the jaws. The number of triangles grows with its
            square: 22,000 at 64, 240,000 at 220, 510,000 at 320.

    Returns:
        Vertices (V, 3) float64 and faces (F, 3) int64. Wound outward, and deterministic to the byte.
    """
    return meshed(creature(), cells)
