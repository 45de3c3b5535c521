"""Shapes that are odd but right, and some that are not."""

from collections.abc import Iterator

import numpy as np
import trimesh
from hypothesis import strategies as st
from mesh_files import TETRAHEDRON, TETRAHEDRON_FACES

BALL = trimesh.creation.icosphere(2)


def sheet(triangles: int) -> tuple[np.ndarray, np.ndarray]:
    """A wavy sheet of about so many triangles."""
    n = int((triangles / 2) ** 0.5)
    y, x = np.mgrid[0 : n + 1, 0 : n + 1] / n
    z = 0.1 * np.sin(9 * x) * np.sin(7 * y)
    corner = (np.arange(n)[:, None] * (n + 1) + np.arange(n)).ravel()[:, None]
    faces = np.concatenate([corner + [0, 1, n + 2], corner + [0, n + 2, n + 1]])
    return np.stack([x, y, z], axis=-1).reshape(-1, 3), faces


def _with(vertices: np.ndarray, row: int, *values: float) -> np.ndarray:
    changed = np.array(vertices, dtype=float)
    changed[row] = values
    return changed


def right() -> Iterator[tuple[str, np.ndarray, np.ndarray]]:
    """Name, vertices and faces of meshes that must be read."""
    v, f = BALL.vertices, BALL.faces
    yield "some without area", v, np.vstack([f, f[:20, [0, 0, 1]], f[:20, [0, 1, 1]]])
    yield "needles", _with(TETRAHEDRON, 3, 1e-5, 1e-5, 1e6), TETRAHEDRON_FACES
    yield "a hundred times", v, np.tile(f, (100, 1))
    yield "both sides", v, np.vstack([f, f[:, ::-1]])
    yield "soup", v[f].reshape(-1, 3), np.arange(f.size).reshape(-1, 3)
    yield "vertices of no face", np.vstack([v, v * 9]), f
    yield "turned", v, np.where(np.arange(len(f))[:, None] % 2, f, f[:, ::-1])
    edge = np.array([[0, 0, 0], [0, 0, 1], [1, 0, 0], [0, 1, 0], [-1, 0, 0]], dtype=float)
    yield "three sheets at an edge", edge, np.array([[0, 1, 2], [0, 1, 3], [0, 1, 4]])
    second = np.where(TETRAHEDRON_FACES == 0, 0, TETRAHEDRON_FACES + 3)[:, ::-1]
    touching = np.vstack([TETRAHEDRON, -TETRAHEDRON[1:]])
    yield "two bodies at a vertex", touching, np.vstack([TETRAHEDRON_FACES, second])
    yield "a hemisphere", v, f[BALL.triangles_center[:, 2] > 0]
    yield "a hole", v, f[1:]
    yield "a sheet", *sheet(200)
    yield "through each other", np.vstack([v, v + [0.7, 0.1, 0]]), np.vstack([f, f + len(v)])
    scattered = np.random.default_rng(0).normal(size=(300, 3))
    yield "random triangles", scattered, np.arange(300).reshape(-1, 3)
    yield "one triangle", TETRAHEDRON[:3], np.array([[0, 1, 2], [2, 1, 0]])
    for unit in (1e-6, 1e9, 1e-30, 1e30):
        yield f"times {unit:g}", v * unit, f


def wrong() -> Iterator[tuple[str, np.ndarray, np.ndarray]]:
    """Meshes that must be refused."""
    v, f = BALL.vertices, BALL.faces
    yield "a NaN", _with(v, 5, np.nan, 0, 0), f
    yield "an infinity", _with(v, 5, 0, -np.inf, 0), f
    yield "near float64's limit", v * 1.7e308, f
    yield "on a line", np.outer(np.arange(len(v)), [1.0, 2, 3]), f
    yield "in a point", np.ones_like(v), f
    yield "an index thrice", v, np.repeat(f[:, :1], 3, axis=1)
    yield "vertices alone", v, np.zeros((0, 3), int)


@st.composite
def drawn(draw: st.DrawFn) -> tuple[list, list]:
    """Few vertices anywhere, and triangles between them, some of them nowhere."""
    coordinate = st.floats(width=32) | st.floats(-1, 1, width=32) | st.integers(-2, 2).map(float)
    points = draw(st.lists(st.tuples(*[coordinate] * 3), min_size=1, max_size=9))
    some = st.integers(0, len(points) - 1)
    index = draw(st.sampled_from([some, some, some | st.integers(-(2**31), 2**31 - 1)]))
    return points, draw(st.lists(st.tuples(*[index] * 3), max_size=12))
