"""A ball over a plane under a spherical light: what points on the plane see of it, by quadrature.

The exact predicate: whether a segment or ray passes a sphere.
"""

import numpy as np

LIGHT, LIGHT_RADIUS = np.array([0.0, 4.0, 0.0]), 0.25
BALL, BALL_RADIUS = np.array([0.0, 1.5, 0.0]), 0.3
POINTS, WIDTH = 128, 1.0  # on the plane y = 0, at x from 0 to WIDTH, in the middle of as many cells
X = (np.arange(POINTS) + 0.5) / POINTS * WIDTH
_GOLDEN = 0.6180339887498949


def seen_of_disc(x: float, count: int = 40_000) -> float:
    """Share that is visible of the disc that faces the point, as this project's lights do."""
    at = np.array([x, 0.0, 0.0])
    across, along, distance = _frame(at)
    radius = LIGHT_RADIUS * np.sqrt((np.arange(count) + 0.5) / count)
    ways = LIGHT - at + radius[:, None] * _around(count, across, along)
    return float(_free(at, ways).mean())


def seen_of_sphere(x: float, count: int = 40_000) -> float:
    """Share of the irradiance that the sphere's light makes on the plane."""
    at = np.array([x, 0.0, 0.0])
    across, along, distance = _frame(at)
    least = np.sqrt(1 - (LIGHT_RADIUS / distance) ** 2)
    cosine = 1 - (1 - least) * (np.arange(count) + 0.5) / count
    sine = np.sqrt(1 - cosine**2)[:, None]
    ways = cosine[:, None] * (LIGHT - at) / distance + sine * _around(count, across, along)
    # To beyond the ball, which is nearer than the light.
    return float(np.average(_free(at, 3 * ways), weights=ways[:, 1]))


def _frame(at: np.ndarray) -> tuple[np.ndarray, np.ndarray, float]:
    way = LIGHT - at
    distance = np.linalg.norm(way)
    across = np.cross(way / distance, [0, 0, 1.0])
    across /= np.linalg.norm(across)
    return across, np.cross(way / distance, across), distance


def _around(count: int, across: np.ndarray, along: np.ndarray) -> np.ndarray:
    angle = 2 * np.pi * ((np.arange(count) + 0.5) * _GOLDEN % 1)
    return np.cos(angle)[:, None] * across + np.sin(angle)[:, None] * along


def _free(at: np.ndarray, ways: np.ndarray) -> np.ndarray:
    nearest = np.clip(ways @ (BALL - at) / (ways * ways).sum(1), 0, 1)
    away = at + nearest[:, None] * ways - BALL
    return (away * away).sum(1) > BALL_RADIUS**2
