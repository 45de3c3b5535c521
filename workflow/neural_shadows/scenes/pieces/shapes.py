"""Basic shapes in metres; y is up.

Faces at an edge have separate vertices, so that interpolated normals keep the edge.
"""

from functools import cache

import numpy as np
import trimesh

from neural_shadows.scenes.arrangement import Placed

Shape = trimesh.Trimesh


def placed(name: str, *shapes: Shape) -> Placed:
    """Shapes as one object."""
    shape = joined(*shapes)
    return Placed(name, np.array(shape.vertices, np.float32), np.array(shape.faces, np.int32))


def joined(*shapes: Shape) -> Shape:
    """Several shapes as one."""
    return trimesh.util.concatenate(shapes)


def copies(shape: Shape, transforms: np.ndarray) -> Shape:
    """One copy per transform (n, 4, 4), without mirroring."""
    vertices = np.einsum("nij,vj->nvi", transforms[:, :3, :3], shape.vertices)
    vertices += transforms[:, None, :3, 3]
    firsts = len(shape.vertices) * np.arange(len(transforms))
    faces = shape.faces + firsts[:, None, None]
    return Shape(vertices.reshape(-1, 3), faces.reshape(-1, 3), process=False)


def at(shape: Shape, position, turn: float = 0.0) -> Shape:
    """The shape rotated about y, then moved to (3,) `position`.

    `turn` in radians, from z towards x."""
    motion = trimesh.transformations.rotation_matrix(turn, [0, 1, 0])
    motion[:3, 3] = position
    return copies(shape, motion[None])


def boxes(lows, highs) -> Shape:
    """Boxes with sides along the axes, between corners (n, 3)."""
    lows, highs = np.broadcast_arrays(np.asarray(lows, float), np.asarray(highs, float))
    transforms = np.tile(np.eye(4), (len(lows), 1, 1))
    transforms[:, [0, 1, 2], [0, 1, 2]] = highs - lows
    transforms[:, :3, 3] = (lows + highs) / 2
    return copies(_unit_box(), transforms)


def box(low, high) -> Shape:
    """One box between two corners (3,)."""
    return boxes([low], [high])


def bars(starts, ends, radii, sections: int = 8) -> Shape:
    """Round bars between points (n, 3); radii one, or (n,)."""
    return copies(_unit_bar(sections), _between(starts, ends, radii, radii))


def beams(starts, ends, width: float, depth: float) -> Shape:
    """Square bars between points (n, 3).

    `width` is level, along z for upright bars."""
    return copies(_unit_box(), _between(starts, ends, width, depth))


def balls(centres, radii, subdivisions: int = 1) -> Shape:
    """Balls about points (n, 3); radii one, or (n,)."""
    centres = np.asarray(centres, float)
    transforms = np.tile(np.eye(4), (len(centres), 1, 1))
    transforms[:, [0, 1, 2], [0, 1, 2]] = np.broadcast_to(radii, len(centres))[:, None]
    transforms[:, :3, 3] = centres
    return copies(trimesh.creation.icosphere(subdivisions), transforms)


def ring(radius: float, thickness: float, height: float = 0.0) -> Shape:
    """A level ring about y; `thickness` is the wire's radius."""
    shape = trimesh.creation.torus(radius, thickness, major_sections=32, minor_sections=8)
    return _upright(shape, height)


def lathe(profile, sections: int = 24) -> Shape:
    """A solid of revolution about y, from rows (radius, height)."""
    return _upright(trimesh.creation.revolve(np.asarray(profile, float), sections=sections))


def sheet(low, high) -> Shape:
    """A level rectangle facing up, between corners (x, z)."""
    (a, b), (c, d) = low, high
    corners = [[a, 0, b], [a, 0, d], [c, 0, d], [c, 0, b]]
    return Shape(corners, [[0, 1, 2], [0, 2, 3]], process=False)


def prisms(outlines, depth: float) -> Shape:
    """Prisms along z over counter-clockwise outlines (n, 4, 2)."""
    outlines = np.asarray(outlines, float)
    near = np.concatenate([outlines, np.full((*outlines.shape[:2], 1), depth / 2)], axis=2)
    corners = np.concatenate([near * [1, 1, -1], near], axis=1)
    around = [[k, (k + 1) % 4, 4 + (k + 1) % 4, 4 + k] for k in range(4)]
    quads = np.array([[4, 5, 6, 7], [3, 2, 1, 0], *around])
    triangles = corners[:, quads[:, [0, 1, 2, 0, 2, 3]].reshape(-1, 3)]
    vertices = triangles.reshape(-1, 3)
    return Shape(vertices, np.arange(len(vertices)).reshape(-1, 3), process=False)


def smooth(points) -> Shape:
    """A smooth open sheet over a grid of points (m, n, 3)."""
    m, n = points.shape[:2]
    corner = np.arange(m * n).reshape(m, n)
    a, b, c, d = corner[:-1, :-1], corner[1:, :-1], corner[1:, 1:], corner[:-1, 1:]
    faces = np.stack([a, b, c, a, c, d], axis=-1).reshape(-1, 3)
    return Shape(points.reshape(-1, 3), faces, process=False)


def leaves(feet, tips, width: float) -> Shape:
    """Folded leaves from foot to tip (n, 3), two triangles each."""
    points = [[0, 0, -0.5], [0.5, 0.15, 0], [0, 0, 0.5], [-0.5, 0.15, 0]]
    leaf = Shape(points, [[0, 2, 1], [0, 3, 2]], process=False)
    leaf = Shape(
        leaf.vertices[leaf.faces].reshape(-1, 3), np.arange(6).reshape(2, 3), process=False
    )
    return copies(leaf, _between(feet, tips, width, width))


@cache
def _unit_box() -> Shape:
    """The cube of side 1 about the origin."""
    cube = trimesh.creation.box()
    corners = cube.vertices[cube.faces].reshape(-1, 3)
    return Shape(corners, np.arange(36).reshape(12, 3), process=False)


@cache
def _unit_bar(sections: int) -> Shape:
    """Unit cylinder along z about the origin, radius and length 1."""
    bar = trimesh.creation.cylinder(1.0, 1.0, sections=sections)
    ends = np.abs(bar.face_normals[:, 2]) > 0.5
    faces = bar.faces + len(bar.vertices) * ends[:, None]
    bar = Shape(np.tile(bar.vertices, (2, 1)), faces, process=False)
    bar.remove_unreferenced_vertices()
    return bar


def _upright(shape: Shape, height: float = 0.0) -> Shape:
    """A shape about z, turned to stand about y."""
    turn = trimesh.transformations.rotation_matrix(-np.pi / 2, [1, 0, 0])
    turn[1, 3] = height
    return copies(shape, turn[None])


def _between(starts, ends, width, depth) -> np.ndarray:
    """Transforms (n, 4, 4) from the unit z-axis to segments (n, 3)."""
    starts, ends = np.broadcast_arrays(np.asarray(starts, float), np.asarray(ends, float))
    along = ends - starts
    forward = along / np.linalg.norm(along, axis=1, keepdims=True)
    steep = np.abs(forward[:, 1:2]) > 0.99
    level = np.cross(np.where(steep, [1.0, 0, 0], [0, 1.0, 0]), forward)
    level /= np.linalg.norm(level, axis=1, keepdims=True)
    transforms = np.tile(np.eye(4), (len(along), 1, 1))
    transforms[:, :3, 0] = level * np.broadcast_to(width, len(along))[:, None]
    upward = np.cross(forward, level)
    transforms[:, :3, 1] = upward * np.broadcast_to(depth, len(along))[:, None]
    transforms[:, :3, 2] = along
    transforms[:, :3, 3] = (starts + ends) / 2
    return transforms
