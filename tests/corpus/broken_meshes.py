"""Meshes as they are found: shapes that are odd but right, and files that are not right."""

import gzip
import json
from collections.abc import Iterator
from typing import NamedTuple

import numpy as np
import trimesh
from mesh_formats import WRITERS, ascii_ply, binary_ply, glb_tree, obj, pack_glb, ply_header

WORKS, ERROR = "works", "clear error"

BALL = trimesh.creation.icosphere(2)
TETRAHEDRON = np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]], dtype=float)
TETRAHEDRON_FACES = np.array([[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]])
TRIANGLE = np.array([[0, 1, 2]])


class Shape(NamedTuple):
    """Vertices and faces, and how reading them must end (None: as the format has it)."""

    kind: str
    name: str
    vertices: np.ndarray
    faces: np.ndarray
    end: str | None


def _with(vertices: np.ndarray, row: int, *values: float) -> np.ndarray:
    changed = np.array(vertices, dtype=float)
    changed[row] = values
    return changed


def shapes() -> Iterator[Shape]:
    """Each is written in each format."""
    v, f = BALL.vertices, BALL.faces
    nan, inf = np.nan, np.inf
    kind = "NaN or infinity"
    for name, bad in {
        "one NaN": (nan, 0, 0),
        "one infinity": (0, inf, 0),
        "minus infinity": (0, 0, -inf),
        "three NaN": (nan, nan, nan),
    }.items():
        yield Shape(kind, name, _with(v, 5, *bad), f, ERROR)
    yield Shape(kind, "all NaN", v * nan, f, ERROR)
    yield Shape(kind, "near float64's limit", v * 1.7e308, f, ERROR)

    kind = "zero area"
    line = np.outer(np.arange(len(v)), [1.0, 2, 3])
    yield Shape(kind, "all on a line", line, f, ERROR)
    yield Shape(kind, "all in a point", np.ones_like(v), f, ERROR)
    yield Shape(kind, "an index thrice", v, np.repeat(f[:, :1], 3, axis=1), ERROR)
    yield Shape(kind, "some", v, np.vstack([f, f[:20, [0, 0, 1]], f[:20, [0, 1, 1]]]), WORKS)
    needle = _with(TETRAHEDRON, 3, 1e-5, 1e-5, 1e6)
    yield Shape(kind, "needles", needle, TETRAHEDRON_FACES, WORKS)

    yield Shape("duplicate faces", "twice", v, np.vstack([f, f]), WORKS)
    yield Shape("duplicate faces", "a hundred times", v, np.tile(f, (100, 1)), WORKS)
    yield Shape("duplicate faces", "both sides", v, np.vstack([f, f[:, ::-1]]), WORKS)
    soup = v[f].reshape(-1, 3)
    yield Shape("duplicate vertices", "soup", soup, np.arange(len(soup)).reshape(-1, 3), WORKS)
    yield Shape("duplicate vertices", "of no face", np.vstack([v, v * 9]), f, WORKS)

    yield Shape("flipped faces", "all", v, f[:, ::-1], WORKS)
    some = np.where(np.arange(len(f))[:, None] % 2, f, f[:, ::-1])
    yield Shape("flipped faces", "every second", v, some, WORKS)

    sheets = np.array([[0, 0, 0], [0, 0, 1], [1, 0, 0], [0, 1, 0], [-1, 0, 0]], dtype=float)
    at_edge = np.array([[0, 1, 2], [0, 1, 3], [0, 1, 4]])
    yield Shape("non-manifold", "three sheets at an edge", sheets, at_edge, WORKS)
    touching = np.vstack([TETRAHEDRON, -TETRAHEDRON[1:]])
    second = np.where(TETRAHEDRON_FACES == 0, 0, TETRAHEDRON_FACES + 3)[:, ::-1]
    yield Shape(
        "non-manifold",
        "two bodies at a vertex",
        touching,
        np.vstack([TETRAHEDRON_FACES, second]),
        WORKS,
    )

    yield Shape("open", "a hemisphere", v, f[BALL.triangles_center[:, 2] > 0], WORKS)
    yield Shape("open", "a hole", v, f[1:], WORKS)
    grid = np.stack(np.meshgrid(range(5), range(5), [0.0]), -1).reshape(-1, 3)
    corner = (np.arange(4)[:, None] * 5 + np.arange(4)).ravel()
    squares = np.concatenate([corner[:, None] + [0, 1, 6], corner[:, None] + [0, 6, 5]])
    yield Shape("open", "flat", grid, squares, WORKS)

    through = np.vstack([v, v + [0.7, 0.1, 0]])
    yield Shape("self-intersecting", "two balls", through, np.vstack([f, f + len(v)]), WORKS)
    scattered = np.random.default_rng(0).normal(size=(300, 3))
    random = np.arange(300).reshape(-1, 3)
    yield Shape("self-intersecting", "random triangles", scattered, random, WORKS)
    bow_tie = np.array([[0, 0, 0], [1, 1, 0], [1, 0, 0], [0, 1, 0.0]])
    yield Shape("self-intersecting", "bow tie", bow_tie, np.array([[0, 1, 2], [0, 3, 1]]), WORKS)

    yield Shape("one triangle", "alone", TETRAHEDRON[:3], TRIANGLE, WORKS)
    yield Shape("one triangle", "twice", TETRAHEDRON[:3], np.array([[0, 1, 2], [2, 1, 0]]), WORKS)
    far = np.vstack([TETRAHEDRON[:3], np.full((50, 3), 1e6)])
    yield Shape("one triangle", "and vertices far off", far, TRIANGLE, WORKS)

    kind = "units and offsets"
    for unit in (1e-6, 1e9, 1e-30, 1e30):
        yield Shape(kind, f"times {unit:g}", v * unit, f, WORKS)
    # STL and GLB have float32, in which these are no numbers any more.
    yield Shape(kind, "times 1e-300", v * 1e-300, f, None)
    yield Shape(kind, "times 1e150", v * 1e150, f, None)
    yield Shape(kind, "1e-6 at 1e3", v * 1e-6 + 1e3, f, None)
    yield Shape(kind, "1 at 1e9", v + 1e9, f, None)
    yield Shape(
        kind, "a corner at 1e12", _with(TETRAHEDRON, 3, 0, 0, 1e12), TETRAHEDRON_FACES, None
    )

    yield Shape("no surface", "vertices alone", v, np.zeros((0, 3), int), ERROR)
    yield Shape("no surface", "nothing", np.zeros((0, 3)), np.zeros((0, 3), int), ERROR)


def sheet(triangles: int) -> tuple[np.ndarray, np.ndarray]:
    """A wavy sheet of about so many triangles."""
    n = int((triangles / 2) ** 0.5)
    y, x = np.mgrid[0 : n + 1, 0 : n + 1] / n
    z = 0.1 * np.sin(9 * x) * np.sin(7 * y)
    corner = (np.arange(n)[:, None] * (n + 1) + np.arange(n)).ravel()[:, None]
    faces = np.concatenate([corner + [0, 1, n + 2], corner + [0, n + 2, n + 1]])
    return np.stack([x, y, z], axis=-1).reshape(-1, 3), faces


class File(NamedTuple):
    """A file as it lies on a disk."""

    kind: str
    name: str
    file: str
    """A key of `WRITERS`."""
    content: bytes
    end: str | None


def shaped_files() -> Iterator[File]:
    """Every shape in every format."""
    for shape in shapes():
        for file, write in WRITERS.items():
            if file.endswith(".gz") or not (len(shape.faces) or "stl" not in file):
                continue
            yield File(shape.kind, shape.name, file, write(shape.vertices, shape.faces), shape.end)


# --- files that are not right --------------------------------------------------------------


def raw_files() -> Iterator[File]:
    """What a format's own rules make possible."""
    yield from _plys()
    yield from _objs()
    yield from _stls()
    yield from _glbs()
    yield from _gzips()


HUGE = 2**31


def _plys() -> Iterator[File]:
    text = ascii_ply(TETRAHEDRON, TETRAHEDRON_FACES).decode()
    binary = binary_ply(TETRAHEDRON, TETRAHEDRON_FACES)
    header, body = text.split("end_header\n")

    def ascii(kind: str, name: str, old: str, new: str, end: str | None = ERROR) -> File:
        assert old in text, old
        return File(kind, name, "ascii.ply", text.replace(old, new, 1).encode(), end)

    def raw(kind: str, name: str, old: bytes, new: bytes, end: str | None = ERROR) -> File:
        assert old in binary, old
        return File(kind, name, "source.ply", binary.replace(old, new, 1), end)

    kind = "2³¹ vertices or faces"
    yield ascii(kind, "vertices", "vertex 4", f"vertex {HUGE}")
    yield ascii(kind, "faces", "face 4", f"face {HUGE}")
    yield raw(kind, "vertices", b"vertex 4", b"vertex %d" % HUGE)
    yield raw(kind, "faces", b"face 4", b"face %d" % HUGE)
    yield raw(kind, "2⁶³ faces", b"face 4", b"face %d" % 2**63)
    yield ascii(kind, "10¹⁰⁰ vertices", "vertex 4", f"vertex {10**100}")
    yield raw(kind, "10¹⁰⁰ vertices", b"vertex 4", b"vertex %d" % 10**100)
    empty = ply_header("ascii", "double", HUGE, HUGE).encode()
    yield File(kind, "and no data", "ascii.ply", empty, ERROR)

    kind = "header"
    yield ascii(kind, "negative count", "vertex 4", "vertex -4")
    yield raw(kind, "negative count", b"vertex 4", b"vertex -4")
    yield ascii(kind, "count is no number", "face 4", "face four")
    yield ascii(kind, "fewer vertices", "vertex 4", "vertex 3")
    yield raw(kind, "fewer vertices", b"vertex 4", b"vertex 3")
    yield ascii(kind, "fewer faces", "face 4", "face 2", None)
    yield ascii(kind, "more faces", "face 4", "face 5")
    yield ascii(kind, "no end", "end_header\n", "")
    yield raw(kind, "no end", b"end_header\n", b"")
    yield ascii(kind, "no format", "format ascii 1.0\n", "")
    yield ascii(kind, "unknown format", "ascii 1.0", "utf_16 1.0")
    yield ascii(kind, "unknown type", "property double x", "property quad x")
    yield ascii(kind, "no z", "property double z\n", "")
    yield ascii(kind, "x twice", "property double z", "property double x")
    yield raw(kind, "x twice", b"property double z", b"property double x")
    yield ascii(kind, "no list", "list uchar int vertex_indices", "int vertex_indices")
    yield ascii(kind, "list of names", "uchar int vertex_indices", "uchar", None)
    yield ascii(kind, "elements twice", "element face", "element vertex")
    yield File(kind, "megabytes", "ascii.ply", b"ply\n" + b"comment x\n" * 100_000, ERROR)
    yield File(
        kind,
        "100,000 elements",
        "ascii.ply",
        ("ply\nformat ascii 1.0\n" + "element a 1\nproperty int b\n" * 100_000).encode(),
        ERROR,
    )
    yield File(
        kind,
        "100,000 properties",
        "source.ply",
        (
            "ply\nformat binary_little_endian 1.0\nelement vertex 1\n"
            + "".join(f"property list uchar int p{i}\n" for i in range(100_000))
            + "end_header\n"
        ).encode()
        + bytes(100_000),
        ERROR,
    )
    yield File(kind, "zero bytes", "source.ply", binary[:200] + bytes(10**6), ERROR)
    lists = binary.replace(b"list uchar int", b"list uint int")
    yield File(kind, "lists of 4 billion", "source.ply", lists + b"\xff" * 400, ERROR)

    kind = "indices"
    for name, row in {
        "past the end": "3 1 2 4",
        "negative": "3 1 2 -1",
        "2³¹": f"3 1 2 {HUGE}",
        "10³⁰": f"3 1 2 {10**30}",
        "half": "3 1 2 2.5",
        "NaN": "3 1 2 nan",
        "two": "2 1 2",
        "fewer than promised": "9 1 2 3",
        "a negative number of them": "-3 1 2 3",
        "words": "3 one two three",
        "none": "",
    }.items():
        yield ascii(kind, name, "3 1 2 3", row)
    bad = TETRAHEDRON_FACES.copy()
    bad[3] = 1, 2, -(2**31)
    yield File(kind, "-2³¹", "source.ply", binary_ply(TETRAHEDRON, bad), ERROR)

    kind = "values"
    yield ascii(kind, "words", "0.0 1.0 0.0", "zero one zero")
    yield ascii(kind, "a word among numbers", "0.0 1.0 0.0", "0.0 1.0x 0.0")
    yield ascii(kind, "comma for point", "0.0 1.0 0.0", "0,0 1,0 0,0")
    yield ascii(kind, "four numbers", "0.0 1.0 0.0", "0.0 1.0 0.0 0.0", None)
    yield ascii(kind, "two numbers", "0.0 1.0 0.0", "0.0 1.0")
    yield ascii(kind, "1e999", "0.0 1.0 0.0", "0.0 1e999 0.0")
    yield ascii(kind, "an empty row", "0.0 1.0 0.0\n", "0.0 1.0 0.0\n\n", None)
    yield File(
        kind,
        "all in one row",
        "ascii.ply",
        (header + "end_header\n" + body.replace("\n", " ")).encode(),
        None,
    )
    yield File(kind, "Windows line ends", "ascii.ply", text.replace("\n", "\r\n").encode(), WORKS)
    yield File(kind, "old Mac line ends", "ascii.ply", text.replace("\n", "\r").encode(), None)
    yield File(kind, "UTF-16", "ascii.ply", text.encode("utf-16"), ERROR)
    yield File(kind, "a byte order mark", "ascii.ply", b"\xef\xbb\xbf" + text.encode(), None)
    yield File(
        kind,
        "Latin-1 comment",
        "ascii.ply",
        text.replace("element", "comment B\xe4r\nelement", 1).encode("latin-1"),
        None,
    )
    yield File(kind, "another file behind it", "source.ply", binary + binary, ERROR)


def _objs() -> Iterator[File]:
    good = obj(TETRAHEDRON, TETRAHEDRON_FACES)

    def file(kind: str, name: str, content: bytes, end: str | None = ERROR) -> File:
        return File(kind, name, "source.obj", content, end)

    kind = "indices"
    for name, line in {
        "past the end": "f 1 2 9",
        "zero": "f 0 1 2",
        "before the start": "f -1 -2 -9",
        "two": "f 1 2",
        "none": "f",
        "words": "f a b c",
        "2³¹": f"f 1 2 {HUGE}",
        "2⁶³": f"f 1 2 {2**63}",
        "10³⁰": f"f 1 2 {10**30}",
        "10⁵⁰⁰⁰": "f 1 2 1" + "0" * 5000,
        "half": "f 1 2 2.5",
        "a slash": "f / / /",
    }.items():
        yield file(kind, name, good + line.encode() + b"\n")
    many = b"f " + b"1 2 3 " * 100_000 + b"\n"
    yield file(kind, "a polygon of 300,000", good + many, WORKS)

    kind = "values"
    for name, line in {
        "two": "v 1 2",
        "none": "v",
        "words": "v a b c",
        "comma for point": "v 1,5 2,5 3,5",
        "1e999": "v 1e999 0 0",
        "hexadecimal": "v 0x1 0 0",
        "zero bytes": "v 1\0 0 0",
        "underscores": "v 1_0 0 0",
    }.items():
        yield file(kind, name, line.encode() + b"\n" + good)
    yield file(kind, "free-form curves", good + b"cstype bezier\ncurv 0 1 1 2 3\nend\n", WORKS)
    yield file(kind, "points and lines", good + b"p 1 2\nl 1 2 3\n", WORKS)
    yield file(kind, "other files", good + b"call /etc/passwd\nmtllib /etc/passwd\n", WORKS)
    yield file(kind, "a command", good + b"csh -rm -rf /\n", WORKS)
    yield file(kind, "Windows line ends", good.replace(b"\n", b"\r\n"), WORKS)
    yield file(kind, "old Mac line ends", good.replace(b"\n", b"\r"), WORKS)
    yield file(kind, "a byte order mark", b"\xef\xbb\xbf# x\n" + good, WORKS)
    yield file(kind, "UTF-16", good.decode().encode("utf-16"))
    yield file(kind, "continued lines", good.replace(b" ", b" \\\n"), WORKS)
    yield file(kind, "megabytes of comment", b"#" * 10**7 + b"\n" + good, WORKS)
    yield file(kind, "megabytes of empty lines", b"\n" * 10**7 + good, WORKS)


def _stls() -> Iterator[File]:
    binary = WRITERS["source.stl"](TETRAHEDRON, TETRAHEDRON_FACES)
    text = WRITERS["ascii.stl"](TETRAHEDRON, TETRAHEDRON_FACES)

    def raw(kind: str, name: str, content: bytes, end: str | None = ERROR) -> File:
        return File(kind, name, "source.stl", content, end)

    def ascii(kind: str, name: str, old: bytes, new: bytes, end: str | None = ERROR) -> File:
        assert old in text, old
        return File(kind, name, "ascii.stl", text.replace(old, new, 1), end)

    def count(n: int) -> bytes:
        return binary[:80] + np.uint32(n).tobytes() + binary[84:]

    yield raw("2³¹ vertices or faces", "faces", count(HUGE))
    yield raw("2³¹ vertices or faces", "2³²−1 faces", count(2**32 - 1))
    kind = "header"
    yield raw(kind, "more faces", count(5))
    yield raw(kind, "fewer faces", count(3))
    yield raw(kind, "no faces", count(0))
    yield raw(kind, "header alone", binary[:84])
    yield raw(kind, "begins with solid", b"solid" + binary[5:], WORKS)
    yield raw(kind, "all bytes", bytes(range(256)) * 4000)
    kind = "values"
    yield ascii(kind, "words", b"vertex 0.0 0.0 0.0", b"vertex zero zero zero")
    yield ascii(kind, "a word among numbers", b"vertex 0.0 0.0 0.0", b"vertex 0.0 x 0.0")
    yield ascii(kind, "comma for point", b"vertex 0.0 0.0 0.0", b"vertex 0,0 0,0 0,0")
    yield ascii(kind, "two numbers", b"vertex 0.0 0.0 0.0", b"vertex 0.0 0.0")
    yield ascii(kind, "four numbers", b"vertex 0.0 0.0 0.0", b"vertex 0.0 0.0 0.0 0.0")
    yield ascii(kind, "1e999", b"vertex 0.0 0.0 0.0", b"vertex 1e999 0.0 0.0")
    yield ascii(kind, "two vertices", b"vertex 0.0 0.0 0.0\n", b"")
    yield ascii(kind, "no end", b"endsolid thing\n", b"")
    yield ascii(kind, "end before start", b"solid thing", b"endsolid\nsolid thing")
    yield ascii(kind, "upper case", text, text.upper(), WORKS)
    yield ascii(kind, "Windows line ends", text, text.replace(b"\n", b"\r\n"), WORKS)
    yield ascii(kind, "two solids", text, text + text, WORKS)
    yield ascii(kind, "the second solid is cut", text, text + text[:-60])
    yield ascii(
        kind, "a name of other words", b"solid thing", b"solid vertex of an endsolid facet", None
    )
    yield ascii(kind, "UTF-16", text, text.decode().encode("utf-16"))


def _glbs() -> Iterator[File]:
    positions = TETRAHEDRON.astype("<f4").tobytes()
    binary = positions + TETRAHEDRON_FACES.astype("<u4").tobytes()

    def tree() -> dict:
        return glb_tree(4, 12)

    def file(kind: str, name: str, content: bytes, end: str | None = ERROR) -> File:
        return File(kind, name, "source.glb", content, end)

    def changed(kind: str, name: str, path: str, value: object, end: str | None = ERROR) -> File:
        """A value of the JSON part, or with None none."""
        made = tree()
        *parents, last = [int(key) if key.isdigit() else key for key in path.split("/")]
        node = made
        for key in parents:
            node = node[key]
        if value is None:
            del node[last]
        else:
            node[last] = value
        return file(kind, name, pack_glb(made, binary), end)

    kind = "2³¹ vertices or faces"
    yield changed(kind, "vertices", "accessors/0/count", HUGE)
    yield changed(kind, "indices", "accessors/1/count", 3 * HUGE)
    yield changed(kind, "bytes", "bufferViews/0/byteLength", HUGE, None)
    yield changed(
        kind,
        "vertices without data",
        "accessors/0",
        {"componentType": 5126, "count": HUGE, "type": "VEC3"},
    )
    yield changed(
        kind,
        "indices without data",
        "accessors/1",
        {"componentType": 5125, "count": 3 * HUGE, "type": "SCALAR"},
    )
    spare = tree()
    spare["accessors"].append({"componentType": 5126, "count": HUGE, "type": "MAT4"})
    yield file(kind, "of an accessor that nothing uses", pack_glb(spare, binary), None)

    kind = "bomb"
    finer = trimesh.creation.icosphere(3)
    big = WRITERS["source.glb"](finer.vertices, finer.faces)
    size = int.from_bytes(big[12:16], "little")
    instances, rest = json.loads(big[20 : 20 + size]), big[28 + size :]
    instances["nodes"] = [{"mesh": 0, "translation": [i, 0, 0]} for i in range(100_000)]
    instances["scenes"] = [{"nodes": list(range(100_000))}]
    yield file(kind, "100,000 instances of 1,280 triangles", pack_glb(instances, rest))
    shared = json.loads(big[20 : 20 + size])
    shared["meshes"][0]["primitives"] *= 100_000
    yield file(kind, "100,000 primitives of the same data", pack_glb(shared, rest))

    kind = "header"
    for name, path, value in [
        ("negative count", "accessors/0/count", -4),
        ("half a vertex", "accessors/0/count", 3.5),
        ("count is a word", "accessors/0/count", "four"),
        ("no count", "accessors/0/count", None),
        ("unknown component", "accessors/0/componentType", 9999),
        ("positions of two numbers", "accessors/0/type", "VEC2"),
        ("positions of bytes", "accessors/0/componentType", 5121),
        ("unknown type", "accessors/0/type", "VEC9"),
        ("a view that is not there", "accessors/0/bufferView", 7),
        ("a negative view", "accessors/0/bufferView", -9),
        ("an offset past the end", "bufferViews/0/byteOffset", 10**9),
        ("a negative offset", "bufferViews/0/byteOffset", -10),
        ("stride of nothing", "bufferViews/0/byteStride", 0),
        ("stride of 2⁴⁰", "bufferViews/0/byteStride", 2**40),
        ("a buffer that is not there", "bufferViews/0/buffer", 5),
        ("another file", "buffers/0/uri", "mesh.bin"),
        ("a file of the system", "buffers/0/uri", "file:///etc/passwd"),
        ("a page", "buffers/0/uri", "http://127.0.0.1:9/mesh.bin"),
        ("no positions", "meshes/0/primitives/0/attributes", {}),
        ("a mesh that is not there", "nodes/0/mesh", 3),
        ("a node that is not there", "scenes/0/nodes", [4]),
        ("a scene that is not there", "scene", 4),
        ("no meshes", "meshes", []),
        ("no nodes", "nodes", None),
        ("no accessors", "accessors", None),
        ("a matrix of three", "nodes/0/matrix", [1, 2, 3]),
        ("a matrix of NaN", "nodes/0/matrix", [float("nan")] * 16),
        ("a matrix of zeros", "nodes/0/matrix", [0] * 16),
        ("a scale of nothing", "nodes/0/scale", [0, 0, 0]),
        ("a scale of infinity", "nodes/0/scale", [float("inf")] * 3),
        ("a rotation of zeros", "nodes/0/rotation", [0, 0, 0, 0]),
        ("nodes are a word", "nodes", "many"),
    ]:
        end = None if name in ("stride of nothing", "a rotation of zeros") else ERROR
        yield changed(kind, name, path, value, end)
    draco = tree()
    draco["extensionsRequired"] = draco["extensionsUsed"] = ["KHR_draco_mesh_compression"]
    primitive = draco["meshes"][0]["primitives"][0]
    primitive["extensions"] = {"KHR_draco_mesh_compression": {"bufferView": 0, "attributes": {}}}
    for accessor in draco["accessors"]:
        del accessor["bufferView"]
    yield file(kind, "compressed by Draco", pack_glb(draco, binary))
    loop = tree()
    loop["nodes"] = [{"children": [1]}, {"children": [0], "mesh": 0}]
    yield file(kind, "nodes in a circle", pack_glb(loop, binary), None)
    own = tree()
    own["nodes"] = [{"children": [0], "mesh": 0}]
    yield file(kind, "a node in itself", pack_glb(own, binary), None)
    deep = tree()
    deep["nodes"] = [{"children": [i + 1]} for i in range(20_000)] + [{"mesh": 0}]
    yield file(kind, "20,000 nodes in each other", pack_glb(deep, binary), None)
    doubled = tree()
    doubled["nodes"] = [{"children": [i + 1, i + 1]} for i in range(60)] + [{"mesh": 0}]
    yield file(kind, "2⁶⁰ paths to a node", pack_glb(doubled, binary), None)
    good = pack_glb(tree(), binary)
    yield file(kind, "no JSON", pack_glb(b"not JSON", binary))
    yield file(kind, "a list", pack_glb([], binary))
    yield file(kind, "nested a million deep", pack_glb(b"[" * 10**6, binary))
    yield file(kind, "version 1", good[:4] + b"\1\0\0\0" + good[8:])
    yield file(kind, "a chunk of 4 GiB", good[:12] + b"\xff\xff\xff\xff" + good[16:])
    yield file(kind, "twice as long as it is", good[:8] + b"\xff\xff\xff\x7f" + good[12:], None)


def _gzips() -> Iterator[File]:
    whole = gzip.compress(binary_ply(BALL.vertices, BALL.faces))
    yield File("header", "members", "source.ply.gz", whole[:10] + b"\xff" * 40, ERROR)
    yield File("values", "wrong check sum", "source.ply.gz", whole[:-8] + bytes(8), ERROR)
    yield File("values", "garbage behind it", "source.ply.gz", whole + b"garbage" * 9, None)
    twice = gzip.compress(whole)
    yield File("wrong extension", "compressed twice", "source.ply.gz", twice, ERROR)
    plain = binary_ply(BALL.vertices, BALL.faces)
    yield File("wrong extension", "not compressed", "source.ply.gz", plain, ERROR)
    yield File("wrong extension", "compressed", "source.ply", whole, ERROR)
    zeros = gzip.compress(bytes(2**24), 9)
    kind = "bomb"
    header = gzip.compress(ply_header("binary_little_endian", "double", HUGE, HUGE).encode())
    for suffix in ("ply", "obj", "stl", "glb"):
        yield File(kind, "1 GiB of zeros", f"source.{suffix}.gz", zeros * 64, ERROR)
    yield File(kind, "2³¹ vertices at zero", "source.ply.gz", header + zeros * 64, ERROR)
    for name, line in (("line ends", b"\n"), ("vertices", b"v 0 0 0\n"), ("faces", b"f 1 1 1\n")):
        block = gzip.compress(line * (2**24 // len(line)), 9)
        yield File(kind, f"1 GiB of {name}", "source.obj.gz", block * 64, ERROR)
