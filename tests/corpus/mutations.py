"""Strategies: whole files with something changed, as hypothesis draws it."""

import json
import re
from typing import Any

from hypothesis import strategies as st

# What a damaged disk, an editor or an enemy puts where a number was.
NUMBERS = [
    *("nan", "inf", "-inf", "-0", "0", "-1", "1e999", "1e-320", "0.5", "1e308", "x", ""),
    *(str(2**n + d) for n in (7, 8, 15, 16, 31, 32, 63, 64) for d in (-1, 0)),
]
NUMBER = re.compile(rb"-?\d+(?:\.\d+)?(?:e[+-]?\d+)?")

# Bounded, since what one input holds is written out whole when it fails.
json_values = st.recursive(
    st.none() | st.booleans() | st.integers() | st.floats() | st.text(max_size=9),
    lambda inner: (
        st.lists(inner, max_size=3) | st.dictionaries(st.text(max_size=4), inner, max_size=3)
    ),
    max_leaves=6,
)


@st.composite
def changed_bytes(draw: st.DrawFn, whole: bytes) -> bytes:
    """One to three places cut, repeated, overwritten or filled; or the file cut off."""
    data = bytearray(whole)
    for _ in range(draw(st.integers(1, 3))):
        # Headers decide most: half of the places are in the first kilobyte.
        last = max(0, len(data) - 1)
        at = draw(st.integers(0, min(last, 1023)) | st.integers(0, last))
        length = draw(st.integers(1, 64))
        match draw(st.sampled_from(["overwrite", "flip", "cut", "repeat", "insert", "end"])):
            case "overwrite":
                new = draw(st.binary(min_size=1, max_size=8))
                data[at : at + len(new)] = new
            case "flip":
                if data:
                    data[at] ^= 1 << draw(st.integers(0, 7))
            case "cut":
                del data[at : at + length]
            case "repeat":
                data[at:at] = data[at : at + length] * draw(st.integers(1, 3))
            case "insert":
                data[at:at] = draw(st.binary(min_size=1, max_size=32))
            case "end":
                del data[at:]
    return bytes(data)


@st.composite
def changed_numbers(draw: st.DrawFn, whole: bytes) -> bytes:
    """One to four of a text's numbers replaced."""
    found = list(NUMBER.finditer(whole))
    assert found, "no numbers in it"
    chosen = draw(
        st.lists(st.sampled_from(found), min_size=1, max_size=4, unique_by=lambda m: m.start())
    )
    data = whole
    for match in sorted(chosen, key=lambda match: -match.start()):
        new = draw(st.sampled_from(NUMBERS)).encode()
        data = data[: match.start()] + new + data[match.end() :]
    return data


def _places(value: Any, path: tuple = ()) -> list[tuple]:
    items = value.items() if isinstance(value, dict) else ()
    items = enumerate(value) if isinstance(value, list) else items
    return [path, *(place for key, inner in items for place in _places(inner, (*path, key)))]


def _put(value: Any, path: tuple, new: Any) -> Any:
    if not path:
        return new
    key, *rest = path
    copy = dict(value) if isinstance(value, dict) else list(value)
    copy[key] = _put(copy[key], tuple(rest), new)
    return copy


@st.composite
def changed_tree(draw: st.DrawFn, whole: Any) -> Any:
    """Plain data with one part of it replaced."""
    return _put(whole, draw(st.sampled_from(_places(whole))), draw(json_values))


def changed_json(whole: bytes) -> st.SearchStrategy[bytes]:
    """A JSON text with one part of it replaced."""
    return changed_tree(json.loads(whole)).map(lambda tree: json.dumps(tree).encode())


coordinates = st.floats(width=32) | st.floats(-1, 1, width=32) | st.integers(-2, 2).map(float)
indices = st.integers(0, 8)


@st.composite
def meshes(draw: st.DrawFn) -> tuple[list, list]:
    """Few vertices anywhere, and triangles between them, some of them nowhere."""
    points = draw(st.lists(st.tuples(*[coordinates] * 3), min_size=0, max_size=9))
    some = st.integers(0, len(points) - 1) if points else indices
    index = draw(st.sampled_from([some, some, some | indices | st.integers(-(2**31), 2**31 - 1)]))
    faces = draw(st.lists(st.tuples(*[index] * 3), min_size=0, max_size=12))
    return points, faces
