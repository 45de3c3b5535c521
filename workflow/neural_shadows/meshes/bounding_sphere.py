"""The minimal enclosing sphere of a set of points."""

from itertools import combinations

import numpy as np

# Largest excess of a point's distance, relative to the radius, at which iteration stops; far above
# rounding, about 4e-16.
_SLACK = 1e-13


def minimal_bounding_sphere(points: np.ndarray) -> tuple[np.ndarray, float]:
    """Exact minimal enclosing sphere, the unit sphere of normalised space [3.3.1].

    Gärtner's pivot rule ("Fast and robust smallest enclosing balls", ESA 1999): grow the
    sphere of a support set of at most four points by the point that is furthest outside,
    until none is. The sphere of a support set is a lower bound for the radius, so the result
    is minimal to about 1e-13 of the radius, or to the rounding of the coordinates
    where that is larger. Coplanar, collinear and repeated points are legal.

    Args:
        points: (n, 3) finite coordinates in any unit, n >= 1.

    Returns:
        Centre (3,) and radius in the unit of `points`. No point is further from the centre
        than the radius, as computed in float64 from the returned centre.
    """
    points = np.asarray(points, dtype=np.float64)
    # About the origin and of size 1: an offset of 1e6 would cost six digits of every
    # squared distance, and the squares of very large or small units leave float64's range.
    low, high = points.min(axis=0), points.max(axis=0)
    middle = low / 2 + high / 2
    scale = float((high / 2 - low / 2).max())
    if scale == 0:
        return points[0].copy(), 0.0
    local = (points - middle) / scale

    support = local[[np.argmax(np.linalg.norm(local, axis=1))]]
    centre, radius = support[0], 0.0
    while True:
        distances = np.linalg.norm(local - centre, axis=1)
        furthest = np.argmax(distances)
        if distances[furthest] <= radius * (1 + _SLACK):
            break
        grown = _sphere_of_few(np.vstack([support, local[furthest]]))
        # Each step enlarges the sphere, up to rounding.
        if grown[1] <= radius:
            break
        centre, radius, support = grown

    centre = middle + scale * centre
    return centre, float(np.linalg.norm((points - centre) / scale, axis=1).max() * scale)


def _sphere_of_few(points: np.ndarray) -> tuple[np.ndarray, float, np.ndarray]:
    """Minimal enclosing sphere of at most five points, with its support.

    Its centre is the circumcentre of some one to four of the points, and it is the centre
    whose largest distance is least: so all are tried, without a tolerance.
    """
    best = (points[0], np.inf, points)
    for size in range(1, min(len(points), 4) + 1):
        for chosen in combinations(points, size):
            subset = np.array(chosen)
            # Circumcentre in their affine hull; least squares where they are dependent.
            edges = subset[1:] - subset[0]
            centre = subset[0] + np.linalg.lstsq(edges, (edges**2).sum(axis=1) / 2)[0]
            radius = float(np.linalg.norm(points - centre, axis=1).max())
            if radius < best[1]:
                best = (centre, radius, subset)
    return best
