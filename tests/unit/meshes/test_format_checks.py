"""Damage that trimesh takes in silence, and small files that it lays out to any size."""

import json
import struct

import pytest

from neural_shadows.meshes.format_checks import MAX_TRIANGLES, check_glb, check_ply, check_stl
from neural_shadows.meshes.obj_file import parse_obj

PLY = """ply
format ascii 1.0
element vertex 3
property float x
property float y
property float z
element face 2
property list uchar int vertex_indices
end_header
0 0 0
1 0 0
0 1 0
3 0 1 2
3 2 1 0
"""


@pytest.mark.parametrize("end", ["\n", "\r\n"])
def test_whole_plys_pass(end):
    check_ply(PLY.replace("\n", end).encode())
    check_ply(PLY.replace("3 0 1 2", "11" + " 0" * 11).encode())
    check_ply(PLY.replace("format ascii", "format binary_little_endian").encode())


@pytest.mark.parametrize(
    ("old", "new", "reason"),
    [
        ("3 0 1 2", "2 0 1", "the face '2 0 1' is cut, or no polygon"),
        ("3 0 1 2", "3 0 1 2.5", "the face '3 0 1 2.5'"),
        ("3 0 1 2", "3 0 1 nan", "the face '3 0 1 nan'"),
        ("3 0 1 2", "4 0 1 2", "the face '4 0 1 2' is cut"),
        ("3 0 1 2", "3 0 1 2 2", "the face '3 0 1 2 2'"),
        ("3 0 1 2", "-3 0 1 2", "the face '-3 0 1 2'"),
        ("3 0 1 2\n", "\n", "the face '' is cut"),
        ("3 2 1 0\n", "", "says 2 of face, there are 1 rows"),
        ("vertex 3", "vertex -3", "says -3 of vertex"),
        ("vertex 3", f"vertex {2**31}", "says 2147483648 of vertex"),
        ("vertex 3", f"vertex {10**100}", "says 10000000000000000000 of vertex"),
        ("end_header", "end", "no end"),
        ("end_header", "property float a\n" * 1000 + "end_header", "1,008 lines"),
    ],
)
def test_damaged_plys(old, new, reason):
    assert old in PLY
    with pytest.raises(ValueError, match=reason):
        check_ply(PLY.replace(old, new, 1).encode())


COLOURED = (
    PLY.replace("end_header", "property list uchar float uv\nproperty uchar red\nend_header")
    .replace("0 1 2", "0 1 2 2 0.5 0.5 255")
    .replace("2 1 0", "2 1 0 0 0")
    .replace("ascii 1.0\n", "ascii 1.0\ncomment as exported\n")
)


def test_faces_with_more_than_corners_are_checked_too():
    check_ply(COLOURED.encode())
    for row in (
        "3 0 1",
        "3 0 1 2 2 0.5 0.5",
        "2 1 2 0 255",
        "3 1.7 2.2 3.9 0 255",
        "4 0 1 2 0 255",
    ):
        with pytest.raises(ValueError, match=f"the face '{row}' is cut, or no polygon"):
            check_ply(COLOURED.replace("3 2 1 0 0 0", row).encode())


def test_the_format_is_what_the_header_says_and_not_a_comment():
    binary = PLY.replace("format ascii", "comment once in ascii\nformat binary_little_endian")
    check_ply(binary[: binary.index("end_header") + 11].encode() + bytes(62))


SOLID = "solid {name}\nfacet normal 0 0 1\nouter loop\n{rows}endloop\nendfacet\nendsolid {name}\n"


def solid(name: str = "a", vertices: int = 3) -> bytes:
    return SOLID.format(name=name, rows="vertex 0 0 1\n" * vertices).encode()


def test_stls():
    check_stl(solid() + solid("vertex of a facet").upper())
    check_stl(b"solid".ljust(80) + struct.pack("<I", 1) + bytes(50))  # a binary one
    for size in range(4, len(solid()) - 7):
        with pytest.raises(ValueError, match="truncated"):
            check_stl((solid() + solid())[:-size])
    with pytest.raises(ValueError, match="2 vertices in 1 whole facets"):
        check_stl(solid(vertices=2))
    with pytest.raises(ValueError, match="185 bytes where its header says 184; nor is it text"):
        check_stl(bytes(80) + struct.pack("<I", 2) + bytes(101))


PRIMITIVE = {"attributes": {"POSITION": 0}, "indices": 1}


def glb(**changes) -> bytes:
    tree = {
        "nodes": [{"mesh": 0}],
        "meshes": [{"primitives": [PRIMITIVE]}],
        "accessors": [{"count": 4, "bufferView": 0}, {"count": 300, "bufferView": 1}],
        "buffers": [{"byteLength": 10}],
    }
    text = json.dumps(tree | changes).encode()
    head = struct.pack("<III", 2, 420 + len(text), len(text))
    return b"glTF" + head + b"JSON" + text + bytes(400)


def test_whole_glbs_pass():
    check_glb(glb())
    check_glb(glb(buffers=[{"uri": "data:application/octet-stream;base64,AAAA"}]))
    check_glb(glb(nodes=[{"mesh": 0}] * (MAX_TRIANGLES // 100)))
    check_glb(glb(nodes=[{}], extensionsRequired=["KHR_mesh_quantization"]))


@pytest.mark.parametrize(
    ("changes", "reason"),
    [
        ({"buffers": [{"uri": "mesh.bin"}]}, "another file"),
        ({"buffers": [{"uri": "file:///etc/passwd"}]}, "another file"),
        ({"extensionsRequired": ["KHR_draco_mesh_compression"]}, "compressed .KHR_draco_mesh"),
        ({"accessors": [{"count": 2**31}, {"count": 3}]}, "2,147,483,648 rows of data in"),
        ({"accessors": [{"count": -1}, {"count": 3}]}, "-1 rows"),
        ({"nodes": [{"mesh": 0}] * (MAX_TRIANGLES // 100 + 1)}, "30,000,100 triangles with all"),
        ({"meshes": [{"primitives": [PRIMITIVE] * 300_001}]}, "30,000,100 triangles with all"),
        ({"nodes": [{"mesh": 7}]}, "not of a scene"),
        ({"meshes": 3}, "not of a scene"),
        ({"accessors": [{}]}, "not of a scene"),
    ],
)
def test_damaged_glbs(changes, reason):
    with pytest.raises(ValueError, match=reason):
        check_glb(glb(**changes))


def test_glbs_without_json():
    nested = b"glTF" + struct.pack("<III", 2, 20, 10**6) + b"JSON" + b"[" * 10**6
    for data in (b"glTF" + bytes(20), glb()[:100], nested):
        with pytest.raises(ValueError):
            check_glb(data)


def test_obj_lines_of_other_kinds():
    text = b"vn 0 0 1\nvt 0 0\nvp 1\nv 0 0 0 1\nv 1 0 0\nv 0 1 0\nfo 9 9 9\nf 1/1/1 2//1 3 # no\n"
    vertices, faces = parse_obj(text)
    assert faces.tolist() == [[0, 1, 2]] and vertices.shape == (3, 3)
    with pytest.raises(ValueError, match="the line 'v 1_' is not understood"):
        parse_obj(text + b"v 1_0 0 0\n")
