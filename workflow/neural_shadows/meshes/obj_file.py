"""Wavefront OBJ files: positions and faces.

trimesh counts relative indices from the file's end (its issue 2364), takes the index 0 for 1, and
drops vertices after a tab and truncated lines.
"""

import re
from array import array
from itertools import pairwise

import numpy as np

# A line of a position or a face, up to a comment. Python allows underscores in numbers, the format
# does not.
_LINE = re.compile(rb"^[ \t]*([vf])(?!\S)([^\n_#]*)(_?)", re.MULTILINE)


def parse_obj(data: bytes) -> tuple[np.ndarray, np.ndarray]:
    """Positions (V, 3) float64 and faces (F, 3) int64 of an OBJ.

    Polygons become fans. No other file is opened. Relative indices count from their line.

    Raises:
        ValueError: a line is malformed.
    """
    data = data.replace(b"\r\n", b"\n").replace(b"\r", b"\n").replace(b"\\\n", b" ")
    coordinates, corners = array("d"), array("q")
    for line in _LINE.finditer(data):
        key, text, underscore = line.groups()
        values = text.split()
        try:
            if underscore:
                raise ValueError
            if key == b"v":
                x, y, z = values[:3]
                coordinates.extend((float(x), float(y), float(z)))
            else:
                indices = [int(value.partition(b"/")[0]) for value in values]
                if 0 in indices or len(indices) < 3:
                    raise ValueError
                count = len(coordinates) // 3
                first, *rest = (i - 1 if i > 0 else count + i for i in indices)
                for pair in pairwise(rest):
                    corners.extend((first, *pair))
        except (ValueError, OverflowError):
            shown = line.group().strip()[:80].decode("utf-8", "replace")
            raise ValueError(f"the line '{shown}' is malformed") from None
    faces = np.frombuffer(corners, np.int64).reshape(-1, 3)
    return np.frombuffer(coordinates, float).reshape(-1, 3), faces
