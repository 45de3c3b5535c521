"""Names of a chart's points, without overlaps."""

from collections.abc import Sequence
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.lines import Line2D
from matplotlib.path import Path
from matplotlib.transforms import Bbox

# Offsets of names in points, to the right and up, nearest first.
SIDES = ((1, 0), (-1, 0), (0, 1), (0, -1), (1, 1), (-1, 1), (1, -1), (-1, -1))
OFFSETS = [(distance * x, distance * y) for distance in (7, 12, 18) for x, y in SIDES]
FAR_OFFSETS = [(distance * x, distance * y) for distance in (28, 40, 55, 75) for x, y in SIDES]
HORIZONTAL = {1: "left", 0: "center", -1: "right"}
VERTICAL = {1: "bottom", 0: "center", -1: "top"}
CLEARLY = 1.5  # distance of a name from others' points over that from its own, without a leader
APART = 2  # least distance of a name from others' middles, in radii of a marker
LEADER = {"color": "#777777", "linewidth": 0.6, "zorder": 0}
MARKER = 5  # radius, points


def label_points(
    axes: Axes, points: np.ndarray, names: Sequence[str], *, far: int = 0, **look: Any
) -> None:
    """Write each point's name at the first free of `OFFSETS`.

    The layout must be done (`Figure.draw_without_rendering`). A name without a free offset is
    left out; names are placed in order. None touches another's point, and a thin line leads to one
    that is not clearly nearer to its own.

    Args:
        points: shape (N, 2), in data coordinates.
        far: how many of the first names may also stand at `FAR_OFFSETS`.
        look: of `Axes.annotate`.
    """
    pixels = axes.get_figure(root=True).dpi / 72
    radius = MARKER * pixels
    centres = axes.transData.transform(points)
    taken = [_marker(centre, radius) for centre in centres]
    taken += [text.get_window_extent() for text in axes.texts]
    paths = [line.get_transform().transform_path(line.get_path()) for line in axes.lines]
    for bars in axes.collections:
        paths += map(bars.get_transform().transform_path, bars.get_paths())
    for number, (point, centre, name) in enumerate(zip(points, centres, names)):
        # Without markers that cover its own.
        others = centres[np.linalg.norm(centres - centre, axis=1) > radius]
        # Laid out once, not at each offset: 2.5 instead of 25 s for eight panels of 17 points.
        text = axes.annotate(name, point, (0, 0), textcoords="offset points", va="bottom", **look)
        text.set_in_layout(False)
        size = text.get_window_extent().size
        for right, up in OFFSETS + FAR_OFFSETS * (number < far):
            sides = np.sign((right, up))
            corner = centre + pixels * np.array((right, up)) + (sides - 1) / 2 * size
            box = Bbox([corner, corner + size])
            own, other = _distances(box, centre), _distances(box, others).min(initial=np.inf)
            leader = CLEARLY * own > other
            line = Path([centre, np.clip(centre, box.min, box.max)])
            if (
                _inside(box, axes.bbox)
                and other > APART * radius
                and not any(path.intersects_bbox(box, filled=False) for path in paths)
                and not any(map(box.overlaps, taken))
                and not (leader and any(line.intersects_bbox(_marker(o, radius)) for o in others))
            ):
                taken.append(box)
                text.set(position=(right, up), ha=HORIZONTAL[sides[0]], va=VERTICAL[sides[1]])
                if leader:
                    paths.append(line)
                    ends = axes.transData.inverted().transform(line.vertices)
                    axes.add_artist(Line2D(*ends.T, **LEADER))  # leaves the limits as they are
                break
        else:
            text.remove()


def _marker(centre: np.ndarray, radius: float) -> Bbox:
    return Bbox([centre - radius, centre + radius])


def _distances(box: Bbox, points: np.ndarray) -> np.ndarray:
    """Distances of points (…, 2) from a box, in pixels."""
    return np.linalg.norm(points - np.clip(points, box.min, box.max), axis=-1)


def _inside(box: Bbox, outer: Bbox) -> bool:
    return outer.x0 <= box.x0 and box.x1 <= outer.x1 and outer.y0 <= box.y0 and box.y1 <= outer.y1
