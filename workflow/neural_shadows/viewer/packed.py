"""Arrays as compact text for a page."""

import base64
import zlib

import numpy as np


def packed(array: np.ndarray) -> dict[str, str]:
    """`kind`, such as uint16, and `data`: byte planes, deflated, base64.

    Planes have all values' first bytes before all second ones, since the high bytes of small numbers are
    equal: the Stanford dragon takes 660 KiB instead of 835.
    """
    little = np.ascontiguousarray(array, array.dtype.newbyteorder("<"))
    planes = little.reshape(-1).view(np.uint8).reshape(little.size, -1).T
    data = base64.b64encode(zlib.compress(planes.tobytes(), 9)).decode()
    return {"kind": array.dtype.name, "data": data}
