"""Names beside a chart's points that cover neither points, lines nor each other."""

from collections.abc import Sequence
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.transforms import Bbox

# Where a name may stand: so many points to the right of its point and above it, nearest first.
SIDES = ((1, 0), (-1, 0), (0, 1), (0, -1), (1, 1), (-1, 1), (1, -1), (-1, -1))
PLACES = [(distance * x, distance * y) for distance in (7, 12) for x, y in SIDES]
HORIZONTAL = {1: "left", 0: "center", -1: "right"}
VERTICAL = {1: "bottom", 0: "center", -1: "top"}
MARKER = 5  # points about a point's middle


def label_points(axes: Axes, points: np.ndarray, names: Sequence[str], **look: Any) -> None:
    """Write a name beside each point, in the first of `PLACES` that is free.

    The layout must be done (`Figure.draw_without_rendering`). A name that finds no free place is
    left out; those first in order look for theirs first.

    Args:
        points: shape (N, 2), in data coordinates.
        look: of `Axes.annotate`.
    """
    reach = MARKER * axes.get_figure(root=True).dpi / 72
    taken = [Bbox([place - reach, place + reach]) for place in axes.transData.transform(points)]
    taken += [text.get_window_extent() for text in axes.texts]
    paths = [line.get_transform().transform_path(line.get_path()) for line in axes.lines]
    for bars in axes.collections:
        paths += map(bars.get_transform().transform_path, bars.get_paths())
    for point, name in zip(points, names):
        for right, up in PLACES:
            sides = {"ha": HORIZONTAL[np.sign(right)], "va": VERTICAL[np.sign(up)]}
            offset = {"xytext": (right, up), "textcoords": "offset points"}
            text = axes.annotate(name, point, **offset, **sides, **look)
            text.set_in_layout(False)
            box = text.get_window_extent()
            crossed = any(path.intersects_bbox(box, filled=False) for path in paths)
            if _inside(box, axes.bbox) and not crossed and not any(map(box.overlaps, taken)):
                taken.append(box)
                break
            text.remove()


def _inside(box: Bbox, outer: Bbox) -> bool:
    return outer.x0 <= box.x0 and box.x1 <= outer.x1 and outer.y0 <= box.y0 and box.y1 <= outer.y1
