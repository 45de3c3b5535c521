"""Calls of `ShadowField`, its kernel their ceiling, beside Embree's packets; and the C header.

A million points on a ground, on the mesh in the order of its faces, and anywhere around it.
"""

import re
import shutil
import subprocess
import tempfile
from pathlib import Path

import numpy as np
import trimesh
from measurement import Row, Work, median_seconds

from neural_shadows import ShadowField
from neural_shadows.meshes.reading import read_mesh
from neural_shadows.representations.distance_bricks.field_occlusion import occluded
from neural_shadows.scenes.tracing import Tracer

COUNT, SIDE = 1_000_000, 1000
SUN, LAMP = np.array([0.6, 0.7, 0.3]), np.array([0.5, 1.5, 0.2])
FIELD = Path(__file__).parents[2] / "workflow/field"
PACKETS = "Embree's packets"


def rows(mesh_ply: Path, quick: bool) -> list[Row]:
    """Rates of a 256³ field of a prepared mesh."""
    vertices, faces = read_mesh(mesh_ply)
    field, tracer = (
        ShadowField.fit((vertices, faces)),
        Tracer(np.float32(vertices), np.int32(faces)),
    )
    result = []
    for name, points in _points(vertices, faces, field).items():
        result += _parallel_rows(name, points, field, tracer, quick)
        result += _header_rows(name, points, field)
    return result + _any_rows(points, field, tracer, quick)


def _points(vertices, faces, field: ShadowField) -> dict[str, np.ndarray]:
    side, rng = np.linspace(-1.5, 1.5, SIDE), np.random.default_rng(0)
    ground = np.stack(np.meshgrid(side, [-1.0], side, indexing="ij"), axis=-1).reshape(-1, 3)
    mesh = trimesh.Trimesh(vertices, faces, process=False)
    on_it, face = trimesh.sample.sample_surface(mesh, COUNT, seed=0)
    order = np.argsort(face)
    lifted = on_it[order] + field.cell / 6 * mesh.face_normals[face[order]]
    return {"ground": ground, "surface": lifted, "space": rng.uniform(-1, 1, (COUNT, 3))}


def _parallel_rows(name, points, field: ShadowField, tracer: Tracer, quick: bool) -> list[Row]:
    in_radii, sun = field._in_radii(points, "points"), SUN / np.linalg.norm(SUN)
    directions = np.tile(np.float32(SUN), (COUNT, 1))
    works: dict[str, Work] = {
        "occluded": lambda: field.occluded(points, SUN),
        "intersects_any": lambda: field.intersects_any(points, directions),
        "kernel": lambda: occluded(in_radii, sun, field._field_bricks),
        PACKETS: lambda: tracer.occluded(np.float32(points), directions),
    }
    rate = _rates(works, quick)
    return [
        Row(
            f"{call}, {name}",
            "cpu x1",
            rate[call],
            "rays/s",
            rate["kernel"],
            PACKETS,
            rate[PACKETS],
        )
        for call in ("occluded", "intersects_any")
    ]


def _any_rows(points, field: ShadowField, tracer: Tracer, quick: bool) -> list[Row]:
    directions = np.random.default_rng(1).normal(size=points.shape)
    to_lamp = LAMP - points
    of_lamp = {
        "occluded_from": lambda: field.occluded_from(points, LAMP),
        PACKETS: lambda: tracer.blocked(np.float32(points), np.float32(to_lamp)),
    }
    anywhere = {
        "intersects_any": lambda: field.intersects_any(points, directions),
        PACKETS: lambda: tracer.occluded(np.float32(points), np.float32(directions)),
    }
    lamp, anywhere = _rates(of_lamp, quick), _rates(anywhere, quick)
    soft = _rates({"soft": lambda: field.soft(points, SUN, 0.27)}, True)["soft"]
    peer = [PACKETS, lamp[PACKETS]]
    return [
        Row("occluded_from, space", "cpu x1", lamp["occluded_from"], "rays/s", None, *peer),
        Row(
            *("intersects_any, all directions", "cpu x1", anywhere["intersects_any"], "rays/s"),
            *(None, PACKETS, anywhere[PACKETS]),
        ),
        Row("soft, space", "cpu x1", soft, "points/s"),
    ]


def _rates(works: dict[str, Work], quick: bool) -> dict[str, float]:
    seconds = median_seconds(works, 1 if quick else 5)
    return {name: COUNT / value for name, value in seconds.items()}


def _header_rows(name: str, points: np.ndarray, field: ShadowField) -> list[Row]:
    """The C header's rate, by its sample; none without a compiler."""
    if (compiler := shutil.which("cc")) is None:
        return []
    with tempfile.TemporaryDirectory() as folder:
        program, saved, given, answers = (f"{folder}/{file}" for file in "sfpa")
        field.save(saved)
        points.astype(np.float32).tofile(given)
        options = ["-O3", "-march=native", str(FIELD / "sample.c"), "-o", program, "-lm"]
        subprocess.run([compiler, *options], check=True)
        command = [program, saved, given, *map(str, SUN), answers]
        printed = subprocess.run(command, check=True, capture_output=True, text=True).stdout
    rate = 1e6 * float(re.search(r"([\d.]+) million", printed)[1])
    return [Row(f"C header, {name}", "cpu x1", rate, "rays/s")]
