"""A forest of copies of three objects: shadow rays through their fields, beside Embree's instances.

On one thread, of the points that two cameras see; Embree is sent single rays and packets of eight
from C. Also beside one tree over all triangles of as many copies as fit into memory; what a frame costs
in which all copies move; and an object that deforms.
"""

import time
from collections.abc import Iterator, Sequence
from functools import partial
from pathlib import Path
from tempfile import TemporaryDirectory

import numpy as np
import torch
from embree_instances import EmbreeInstances
from embree_rays import (
    PACKETS,
    SINGLE,
    WIDE,
    EmbreeScene,
    EmbreeTriangles,
    best_of_forms,
    check_compiled,
)
from measurement import Row, median_seconds

from neural_shadows.meshes.generate_mesh import generate_mesh
from neural_shadows.meshes.prepare_mesh import prepare_mesh
from neural_shadows.meshes.prepared_mesh import PreparedMesh, read_prepared
from neural_shadows.networks.object_space.field_bricks import FieldBricks
from neural_shadows.networks.object_space.field_instances import FieldInstances
from neural_shadows.networks.object_space.untrained_field import untrained_field
from neural_shadows.reports.figures.forest import LAMP, SUN, cameras, see
from neural_shadows.scenes.forest import scattered
from neural_shadows.scenes.mesh_instances import MeshInstances
from neural_shadows.scenes.tracing import NEARLY_ALL

RESOLUTION = 256
INSTANCES = 1000
JOINED = (10, 100)  # copies whose triangles are one mesh; 100 take 4 GiB
SEED = 2026
OTHERS = {
    "fence": {"generate": "fence", "wires": 16, "wire_radius": 0.006},
    "oak": {"generate": "oak", "cells": 256},
}
PEER = "Embree's instances"
MIB = 1 << 20


def rows(mesh_ply: Path, quick: bool) -> list[Row]:
    """Of the mesh, a fence and an oak."""
    torch.set_num_threads(1)
    check_compiled()
    with TemporaryDirectory() as folder:
        paths = [mesh_ply, *_others(Path(folder))]
        objects = [read_prepared(path) for path in paths]
        untrained_field(paths[1], RESOLUTION)  # compiles the kernels, which no field is charged for
        fields, seconds = zip(
            *(_timed(partial(untrained_field, path, RESOLUTION)) for path in paths)
        )
    rounds = 3 if quick else 7
    found = _forest_rows(objects, fields, rounds)
    for count in JOINED[: 1 if quick else None]:
        found += _joined_rows(objects, fields, count, rounds)
    return found + _deformed_rows(objects, seconds)


def _others(folder: Path) -> Iterator[Path]:
    for name, mesh in OTHERS.items():
        made, mesh_ply = folder / f"{name}_made.ply", folder / f"{name}.ply"
        generate_mesh(made, mesh)
        prepare_mesh(made, mesh_ply, folder / f"{name}.json", mesh, name)
        yield mesh_ply


def _timed(work) -> tuple:
    """What it gives, and its seconds of processors: both sides build on one thread."""
    started = time.process_time()
    found = work()
    return found, time.process_time() - started


def _placed(objects: Sequence[PreparedMesh], count: int) -> tuple[np.ndarray, np.ndarray]:
    vertices = [mesh.vertices for mesh in objects]
    return scattered(vertices, ["y"] * len(objects), count, np.random.default_rng(SEED))


def _forest_rows(objects, fields: Sequence[FieldBricks], rounds: int) -> list[Row]:
    """Rates, errors and bytes of the whole forest, and what it costs to move all of it."""
    kinds, placements = _placed(objects, INSTANCES)
    forest = FieldInstances(fields, kinds, placements)
    peer = EmbreeInstances([(mesh.vertices, mesh.faces) for mesh in objects], kinds, placements)
    shares = forest.bytes / MIB, peer.bytes / MIB
    triangles = sum(len(objects[kind].faces) for kind in kinds)
    name = f"forest, {INSTANCES:,} copies, {triangles / 1e6:.0f} M triangles"
    exact = MeshInstances(objects, kinds, placements)
    found = []
    to_sun = (SUN / np.linalg.norm(SUN)).astype(np.float32)
    for number, camera in enumerate(cameras(placements)):
        points = see(exact, camera).p
        to_lamp = np.float32([0, LAMP, 0]) - points
        stage = f"{name}, frame {number}"
        answer = partial(forest.occluded, points, np.tile(to_sun, (len(points), 1)))
        found += _rate_rows(f"{stage}, sun", answer, peer, (points, to_sun), rounds)
        answer = partial(forest.blocked, points, to_lamp)
        rays = points, to_lamp, NEARLY_ALL
        found += _rate_rows(f"{stage}, lamp", answer, peer, rays, rounds)
    moved = placements.copy()
    moved[:, 0, 3] += 0.1
    found.append(
        Row(f"{name}, in memory", "cpu x1", shares[0], "MiB", peer=PEER, peer_rate=shares[1])
    )
    works = {"field": partial(forest.place, moved), PEER: partial(peer.place, moved)}
    seconds = median_seconds(works, 3 * rounds, "thread_time")
    told = {"peer": PEER, "peer_rate": 1 / seconds[PEER]}
    stage = f"{name}, all of them moved"
    found.append(Row(stage, "cpu x1", 1 / seconds["field"], "frames/s", **told))
    peer.close()
    return found


def _joined_rows(objects, fields: Sequence[FieldBricks], count: int, rounds: int) -> list[Row]:
    """The same of fewer copies, whose triangles are one mesh for Embree."""
    kinds, placements = _placed(objects, count)
    forest = FieldInstances(fields, kinds, placements)
    joined = _joined(objects, kinds, placements)
    peer, built = _timed(partial(EmbreeTriangles, *joined))
    points = see(MeshInstances(objects, kinds, placements), next(cameras(placements))).p
    to_sun = (SUN / np.linalg.norm(SUN)).astype(np.float32)
    answer = partial(forest.occluded, points, np.tile(to_sun, (len(points), 1)))
    name, one_tree = f"forest, {count} copies, {len(joined[1]) / 1e6:.1f} M triangles", "one tree"
    found = _rate_rows(f"{name}, sun", answer, peer, (points, to_sun), rounds)
    told = {"peer": one_tree, "peer_rate": peer.bytes / MIB}
    found.append(Row(f"{name}, in memory", "cpu x1", forest.bytes / MIB, "MiB", **told))
    works = {"field": partial(forest.place, placements)}
    place = median_seconds(works, rounds, "thread_time")["field"]
    told = {"peer": "one tree, built anew", "peer_rate": 1 / built}
    found.append(Row(f"{name}, some moved", "cpu x1", 1 / place, "frames/s", **told))
    peer.close()
    return found


def _joined(objects, kinds, placements) -> tuple[np.ndarray, np.ndarray]:
    vertices, faces, first = [], [], 0
    for kind, one in zip(kinds, placements):
        at = objects[kind].vertices @ one[:3, :3].T.astype(np.float32)
        vertices.append(at + one[:3, 3].astype(np.float32))
        faces.append(objects[kind].faces + first)
        first += len(at)
    return np.concatenate(vertices), np.concatenate(faces)


def _deformed_rows(objects, seconds: Sequence[float]) -> list[Row]:
    """Of an object whose shape changes its field is built anew, as Embree's tree over its triangles."""
    found = []
    for mesh, field in zip(objects, seconds):
        peer, tree = _timed(partial(EmbreeTriangles, mesh.vertices, mesh.faces))
        peer.close()
        stage = f"object of {len(mesh.faces):,} triangles, deformed: {RESOLUTION}³ field built anew"
        told = {"peer": "Embree's tree", "peer_rate": 1 / tree}
        found.append(Row(stage, "cpu x1", 1 / field, "shapes/s", **told))
    return found


def _rate_rows(stage: str, answer, peer: EmbreeScene, rays: tuple, rounds: int) -> list[Row]:
    """Rays a second of fields, beside Embree's single rays and packets."""
    works = {
        "field": answer,
        SINGLE: partial(peer.single, *rays),
        **peer.packet_forms(*rays),
    }
    exact = works[SINGLE]()
    wrong, unlike = 100 * np.mean(answer() != exact), (works[PACKETS]() != exact).sum()
    seconds = best_of_forms(median_seconds(works, rounds, "thread_time"))
    rate = {name: len(exact) / value for name, value in seconds.items()}
    differ = f"{stage}, {wrong:.2f} % of points differ"
    return [
        *(
            Row(differ, "cpu x1", rate["field"], "rays/s", peer=peer, peer_rate=rate[peer])
            for peer in (SINGLE, PACKETS, WIDE)
        ),
        Row(f"{stage}, {PACKETS} unlike {SINGLE}", "cpu x1", unlike, "answers"),
    ]
