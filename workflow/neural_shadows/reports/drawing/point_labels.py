"""Names beside a chart's points that cover neither points, lines nor each other."""

from collections.abc import Sequence
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.lines import Line2D
from matplotlib.path import Path
from matplotlib.transforms import Bbox

# Where a name may stand: so many points to the right of its point and above it, nearest first.
SIDES = ((1, 0), (-1, 0), (0, 1), (0, -1), (1, 1), (-1, 1), (1, -1), (-1, -1))
PLACES = [(distance * x, distance * y) for distance in (7, 12, 18) for x, y in SIDES]
HORIZONTAL = {1: "left", 0: "center", -1: "right"}
VERTICAL = {1: "bottom", 0: "center", -1: "top"}
CLEARLY = 1.5  # times its distance from its own point a name is from others
APART = 2  # times a marker's reach that a name is at least from others' middles
LEADER = {"color": "#777777", "linewidth": 0.6, "zorder": 0}
MARKER = 5  # points about a point's middle


def label_points(axes: Axes, points: np.ndarray, names: Sequence[str], **look: Any) -> None:
    """Write a name beside each point, in the first of `PLACES` that is free.

    The layout must be done (`Figure.draw_without_rendering`). A name that finds no free place is
    left out; those first in order look for theirs first. None touches another's point, and a
    thin line leads to one that is not clearly nearer to its own.

    Args:
        points: shape (N, 2), in data coordinates.
        look: of `Axes.annotate`.
    """
    reach = MARKER * axes.get_figure(root=True).dpi / 72
    places = axes.transData.transform(points)
    taken = [_marker(place, reach) for place in places]
    taken += [text.get_window_extent() for text in axes.texts]
    paths = [line.get_transform().transform_path(line.get_path()) for line in axes.lines]
    for bars in axes.collections:
        paths += map(bars.get_transform().transform_path, bars.get_paths())
    for point, place, name in zip(points, places, names):
        # A marker that covers its own is no other.
        others = places[np.linalg.norm(places - place, axis=1) > reach]
        for right, up in PLACES:
            sides = {"ha": HORIZONTAL[np.sign(right)], "va": VERTICAL[np.sign(up)]}
            offset = {"xytext": (right, up), "textcoords": "offset points"}
            text = axes.annotate(name, point, **offset, **sides, **look)
            text.set_in_layout(False)
            box = text.get_window_extent()
            own, other = _distances(box, place), _distances(box, others).min(initial=np.inf)
            led = CLEARLY * own > other
            line = Path([place, np.clip(place, box.min, box.max)])
            if (
                _inside(box, axes.bbox)
                and other > APART * reach
                and not any(path.intersects_bbox(box, filled=False) for path in paths)
                and not any(map(box.overlaps, taken))
                and not (led and any(line.intersects_bbox(_marker(o, reach)) for o in others))
            ):
                taken.append(box)
                if led:
                    paths.append(line)
                    ends = axes.transData.inverted().transform(line.vertices)
                    axes.add_artist(Line2D(*ends.T, **LEADER))  # leaves the limits as they are
                break
            text.remove()


def _marker(place: np.ndarray, reach: float) -> Bbox:
    return Bbox([place - reach, place + reach])


def _distances(box: Bbox, places: np.ndarray) -> np.ndarray:
    """Of places (…, 2) from a box, in pixels; 0 within it."""
    return np.linalg.norm(places - np.clip(places, box.min, box.max), axis=-1)


def _inside(box: Bbox, outer: Bbox) -> bool:
    return outer.x0 <= box.x0 and box.x1 <= outer.x1 and outer.y0 <= box.y0 and box.y1 <= outer.y1
