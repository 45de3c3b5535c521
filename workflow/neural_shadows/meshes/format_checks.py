"""What trimesh reads wrongly without a word, or at any cost, refused before it is read.

Each function takes the whole file and raises ValueError with the reason.
"""

import json
import re
from typing import Any

import numpy as np

# Instances make a large scene of a small file. The largest scans have 28 million triangles.
MAX_TRIANGLES = 30_000_000

# Scanners write a dozen properties; trimesh takes the square of their number.
_MOST_HEADER_LINES = 1000
_MOST_HEADER_BYTES = 2**20

_COMPRESSED = {"KHR_draco_mesh_compression", "EXT_meshopt_compression"}


def check_ply(data: bytes) -> None:
    """Refuse headers without bounds, and ASCII rows that are cut or have other than indices."""
    end = data.find(b"end_header", 0, _MOST_HEADER_BYTES)
    if end < 0:
        raise ValueError("its header has no end")
    lines = [line.decode("ascii", "replace").split() for line in data[:end].splitlines()]
    if len(lines) > _MOST_HEADER_LINES:
        raise ValueError(f"its header has {len(lines):,} lines")
    elements: list[tuple[str, int, list[list[str]]]] = []
    is_text = ["format", "ascii"] in (words[:2] for words in lines)
    for words in lines:
        if words[:1] == ["element"]:
            name, count = words[1:]
            # No element is smaller than a byte.
            if not count.isdecimal() or int(count[:20]) > len(data):
                raise ValueError(f"its header says {count[:20]} of {name}")
            elements.append((name, int(count), []))
        elif words[:1] == ["property"] and elements:
            elements[-1][2].append(words[1:])
    if not is_text:
        return
    rows = data[end:].strip().splitlines()[1:]
    for name, count, kinds in elements:
        if len(rows) < count:
            raise ValueError(
                f"truncated: its header says {count:,} of {name}, there are {len(rows):,} rows"
            )
        if any(kind[0] == "list" for kind in kinds):
            for row in rows[:count]:
                _check_row(name, kinds, row)
        rows = rows[count:]


def _check_row(name: str, kinds: list[list[str]], row: bytes) -> None:
    """Refuse an ASCII row with other than its header's values, or a polygon of other than indices.

    trimesh drops polygons of two corners, cuts indices to whole numbers, and takes the corners
    that are there for all.
    """
    words = iter(row.split())
    try:
        for kind in kinds:
            count = int(next(words)) if kind[0] == "list" else 1
            values = [next(words) for _ in range(count)]
            if kind[-1].startswith("vertex_ind"):
                if count < 3 or not all(value.lstrip(b"-").isdigit() for value in values):
                    raise ValueError
        if next(words, None) is not None:
            raise ValueError
    except (ValueError, StopIteration):
        shown = row[:60].decode("ascii", "replace")
        raise ValueError(f"the {name} '{shown}' is cut, or no polygon of whole numbers") from None


def check_stl(data: bytes) -> None:
    """Refuse a binary file of another size than it says, and text that ends within a solid."""
    expected = 84 + 50 * int.from_bytes(data[80:84], "little")
    if len(data) == expected:
        return
    if data[:200].lstrip()[:5].lower() != b"solid":
        raise ValueError(f"{len(data):,} bytes where its header says {expected:,}; nor is it text")
    vertices, facets, solids, ends = (
        len(re.findall(rb"(?im)^[ \t]*" + word + rb"\b", data))
        for word in (b"vertex", b"endfacet", b"solid", b"endsolid")
    )
    if vertices != 3 * facets or solids != ends:
        raise ValueError(
            f"truncated: {vertices:,} vertices in {facets:,} whole facets, "
            f"{solids:,} solids of which {ends:,} end"
        )


def check_glb(data: bytes) -> None:
    """Refuse data that is elsewhere, compressed, or larger once it is laid out than it may be."""
    size = int.from_bytes(data[12:16], "little")
    try:
        tree = json.loads(data[20 : 20 + size])
        _check_tree(tree, len(data))
    except (RecursionError, LookupError, TypeError, AttributeError) as error:
        raise ValueError(f"its JSON part is not of a scene: {error}") from error


def _check_tree(tree: dict[str, Any], size: int) -> None:
    if any("base64," not in buffer.get("uri", "base64,") for buffer in tree.get("buffers", [])):
        raise ValueError("its data is in another file: export it as a single one")
    if compressed := _COMPRESSED.intersection(tree.get("extensionsRequired", [])):
        raise ValueError(f"its data is compressed ({', '.join(compressed)}): export it without")
    accessors = tree.get("accessors", [])
    for accessor in accessors:
        # Not of data, and so as many zeros as it says; no row is smaller than a byte.
        if not 0 <= accessor["count"] <= size:
            raise ValueError(f"{accessor['count']:,} rows of data in {size:,} bytes")

    def triangles(primitive: dict[str, Any]) -> int:
        rows = accessors[primitive["attributes"]["POSITION"]]["count"]
        corners = accessors[primitive["indices"]]["count"] if "indices" in primitive else rows
        return max(rows, corners // 3)

    meshes = [sum(map(triangles, mesh["primitives"])) for mesh in tree.get("meshes", [])]
    placed = [meshes[node["mesh"]] for node in tree.get("nodes", []) if "mesh" in node]
    if max(sum(meshes), sum(placed)) > MAX_TRIANGLES:
        total = max(sum(meshes), sum(placed))
        raise ValueError(f"{total:,} triangles with all instances, more than {MAX_TRIANGLES:,}")


def check_indices(faces: np.ndarray, vertices: int) -> None:
    """Refuse faces (F, 3) that name vertices which are not there."""
    bad = np.argwhere((faces < 0) | (faces >= vertices))
    if len(bad):
        face = bad[0][0]
        raise ValueError(
            f"face {face} (counted from 0) names vertices {faces[face].tolist()} of {vertices}"
        )
