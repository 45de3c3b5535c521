"""Shadow rays through an occupancy field beside Embree: embreex, and its library called from C.

From points to answers, the same points for all, one thread, interleaved rounds, times of the thread.
Of the mesh itself; of the smallest decimated one whose answers are no more unlike the mesh's than the
field's are; and of a surface with detail that a field of its own cannot hold, in up to 20 million
triangles. And how long it takes from a mesh's file to a frame's first answers.
"""

import time
from collections.abc import Iterator, Sequence
from itertools import islice
from pathlib import Path
from tempfile import TemporaryDirectory

import numpy as np
import torch
import trimesh
from detailed_mesh import detailed_meshes
from embree_rays import PACKETS, check_compiled
from field_rivals import (
    FIELD,
    ShadowRays,
    Triangles,
    median_rows,
    rate_rows,
    rates,
    total_rates,
    wrong_shares,
)
from measurement import Row

from neural_shadows.meshes.prepare_mesh import prepare_mesh
from neural_shadows.meshes.prepared_mesh import PreparedMesh
from neural_shadows.networks.kinds import make_network
from neural_shadows.networks.object_space.occupancy_field_network import OccupancyFieldNetwork
from neural_shadows.networks.weight_file import load_network, save_network
from neural_shadows.rendering.gbuffer import render_gbuffer
from neural_shadows.rendering.viewpoints import draw_viewpoints
from neural_shadows.representations.meshes.decimation import decimated
from neural_shadows.scenes.cameras import Viewpoint
from neural_shadows.scenes.scene import Scene, open_scene
from neural_shadows.scenes.tracing import Tracer

SCENE = {"up": "y", "ground": True, "light": {"domain": "sphere", "min_elevation_deg": 20}}
WIDTH, HEIGHT, SEED = 1200, 800, 2026
VIEW_SETS, VIEWS = ("shadow", "surface", "centre"), range(3)
UNTRAINED = {"encoding": "occupancy_field", "resolution": 256, "surface": "solid"}
UNTRAINED |= {"stored": "coded", "start": "fitted"}
MOST = 20_000_000  # triangles with detail
NEAR = 0.05  # share by which the decimated mesh's number of triangles is off


def rows(source: Path, mesh_ply: Path, weights: list[Path], quick: bool) -> list[Row]:
    """Rates of each field of a solid that is given, or of a fitted one if there is none.

    Args:
        source: the file that the prepared mesh was made of.
    """
    torch.set_num_threads(1)
    check_compiled()
    scene = open_scene(mesh_ply, **SCENE)
    views = draw_viewpoints(scene, VIEW_SETS, VIEWS, WIDTH / HEIGHT, SEED)
    frames = _frames(scene, views)
    (mesh,) = scene.objects
    triangles = Triangles(mesh.vertices, mesh.faces)
    result, rounds = [], 3 if quick else 5
    for name, network in _fields(mesh_ply, weights):
        result += _frame_rows(name, network, triangles, frames, rounds)
        result += _equal_error_rows(name, network, triangles, frames, rounds)
    triangles.scene.close()
    result += _first_answer_rows(source, frames[0], 3)
    arrays = mesh.vertices, mesh.faces, mesh.vertex_normals
    meshes = detailed_meshes(*arrays, 2 / UNTRAINED["resolution"], MOST)
    return result + _detail_rows(scene, views, islice(meshes, 2 if quick else None), 3)


def _frames(scene: Scene, views: Sequence[Viewpoint]) -> list[ShadowRays]:
    return [ShadowRays.of_frame(render_gbuffer(scene, view, WIDTH, HEIGHT)) for view in views]


def _fields(mesh_ply: Path, weights: list[Path]) -> Iterator[tuple[str, OccupancyFieldNetwork]]:
    loaded = {path.parent.name: load_network(path)[0] for path in weights}
    fields = {
        name: network
        for name, network in loaded.items()
        if isinstance(network, OccupancyFieldNetwork) and network.surface == "solid"
    }
    yield from (fields or {"fitted 256³ field": _fitted(mesh_ply)}).items()


def _fitted(mesh_ply: Path) -> OccupancyFieldNetwork:
    network = make_network(UNTRAINED)
    network.prepare(mesh_ply)
    network.initialise(0)
    with TemporaryDirectory() as folder:  # values as a file has them
        save_network(Path(folder) / "field", network, {"network": UNTRAINED})
        return load_network(Path(folder) / "field")[0]


def _frame_rows(
    name: str, network, triangles: Triangles, frames: Sequence[ShadowRays], rounds: int
) -> list[Row]:
    """Each frame's rates, their ratios, the answers that differ, and what is held."""
    by_frame = [rates(network, triangles, frame, rounds) for frame in frames]
    result = []
    for number, (frame, rate) in enumerate(zip(frames, by_frame)):
        result += rate_rows(f"{name}, frame {number}, {len(frame.points):,} rays", rate)
    result += median_rows(name, by_frame)
    false_shadow, leak = wrong_shares(network, triangles, frames)
    count = sum(len(frame.points) for frame in frames)
    result += [
        Row(f"{rival}, of {count:,} answers unlike embreex's", "cpu x1", differ, "answers")
        for rival, differ in triangles.unlike(frames).items()
    ]
    return [
        *result,
        Row(f"{name}, false shadow", "cpu x1", false_shadow, "% of pixels"),
        Row(f"{name}, leak", "cpu x1", leak, "% of pixels"),
        _memory_row(name, network, triangles),
    ]


def _memory_row(name: str, network, triangles: Triangles) -> Row:
    """What a field and Embree hold."""
    peer = f"Embree's tree and {triangles.count:,} triangles"
    held = triangles.scene.bytes / 1024
    own = network.resident_bytes() / 1024
    return Row(f"{name}, resident", "cpu x1", own, "KiB", peer=peer, peer_rate=held)


def _equal_error_rows(
    name: str, network, exact: Triangles, frames: Sequence[ShadowRays], rounds: int
) -> list[Row]:
    """Rates beside the smallest decimated mesh whose answers are no more unlike than the field's."""
    error = sum(wrong_shares(network, exact, frames))
    best, share, tried = smallest_within(error, exact, frames)
    result = [
        Row(
            f"{name}: decimated to {count:,} triangles, unlike the whole",
            "cpu x1",
            unlike,
            "% of pixels",
        )
        for count, unlike in tried.items()
    ]
    stage = f"{name}, {error:.3f} %; {best.count:,} triangles, {share:.3f} %"
    rates_of_it, _ = _total_rows(stage, network, best, frames, rounds)
    return [*result, *rates_of_it, _memory_row(stage, network, best)]


def smallest_within(
    error: float, exact: Triangles, frames: Sequence[ShadowRays]
) -> tuple[Triangles, float, dict[int, float]]:
    """The smallest decimated mesh whose answers differ in at most a share of pixels, by bisection.

    Args:
        error: that share, in per cent. exact: the mesh itself.

    Returns:
        It, its share, and the shares by number of triangles of all that were tried.
    """
    best, share, too_few, tried = exact, 0.0, 0, {}
    while best.count - too_few > NEAR * best.count:
        wanted = (too_few + best.count) // 2
        fewer = Triangles(*decimated(best.vertices, best.faces, wanted))
        unlike = [
            np.count_nonzero(fewer.occluded(frame) != exact.occluded(frame)) / frame.pixels
            for frame in frames
        ]
        tried[fewer.count] = 100 * float(np.mean(unlike))
        if tried[fewer.count] > error:
            too_few = wanted
            fewer.scene.close()
            continue
        if best is not exact:
            best.scene.close()
        best, share = fewer, tried[fewer.count]
    return best, share, tried


def _total_rows(
    stage: str, network, triangles: Triangles, frames: Sequence[ShadowRays], rounds: int
) -> tuple[list[Row], float]:
    """Rates over all frames and median ratios; and of these the field's over the packets'."""
    by_frame = [rates(network, triangles, frame, rounds) for frame in frames]
    result = rate_rows(stage, total_rates(frames, by_frame)) + median_rows(stage, by_frame)
    return result, float(np.median([rate[FIELD] / rate[PACKETS] for rate in by_frame]))


def _first_answer_rows(source: Path, frame: ShadowRays, rounds: int) -> list[Row]:
    """Seconds from a mesh's file to a fitted field's answers to a frame, and how they divide.

    The quickest of some rounds after one that compiles the kernels; the process's own time, on
    all its cores, stands beside it.
    """
    with TemporaryDirectory() as folder:
        times = [_first_answer(source, Path(folder), frame) for _ in range(rounds + 1)]
    best = min(times[1:], key=lambda parts: sum(wall for wall, _ in parts.values()))
    best["mesh to first answer"] = tuple(map(sum, zip(*best.values())))
    return [
        Row(f"{part}, {used:.2f} s of processors", "cpu", wall, "s")
        for part, (wall, used) in best.items()
    ]


def _first_answer(source: Path, folder: Path, frame: ShadowRays) -> dict[str, tuple[float, float]]:
    """Of each part, its seconds on the clock and of processors."""
    network = make_network(UNTRAINED)
    mesh_ply = folder / "mesh.ply"
    parts = {
        "preparing the mesh": lambda: prepare_mesh(source, mesh_ply, folder / "json", {}, "mesh"),
        "fitting the field": lambda: network.prepare(mesh_ply),
        "its values": lambda: network.initialise(0),
        "bricks, light's tables and a frame": lambda: frame.field(network),
    }
    found = {}
    for name, work in parts.items():
        started, used = time.perf_counter(), time.process_time()
        work()
        found[name] = time.perf_counter() - started, time.process_time() - used
    return found


def _detail_rows(
    scene: Scene,
    views: Sequence[Viewpoint],
    meshes: Iterator[tuple[np.ndarray, np.ndarray]],
    rounds: int,
) -> list[Row]:
    """One surface with detail in ever more triangles, the first one's field, and where they are even."""
    network, result, counts, ratios = None, [], [], []
    for vertices, faces in meshes:
        frames = _frames(_with_detail(scene, vertices, faces), views)
        triangles = Triangles(vertices, faces)
        if first := network is None:
            network = _fitted_to(vertices, faces)
        error = sum(wrong_shares(network, triangles, frames))
        stage = f"{len(faces):,} triangles with detail, {error:.3f} % of pixels differ"
        rates_of_it, ratio = _total_rows(stage, network, triangles, frames, rounds)
        result += rates_of_it
        if first:
            result += _equal_error_rows("detail", network, triangles, frames, rounds)
        counts.append(len(faces))
        ratios.append(ratio)
        triangles.scene.close()
    even = crossing(np.array(counts), np.array(ratios))
    return [*result, Row(f"{PACKETS}, with detail: {even}", "cpu x1", ratios[-1], "×")]


def _fitted_to(vertices: np.ndarray, faces: np.ndarray) -> OccupancyFieldNetwork:
    with TemporaryDirectory() as folder:
        path = Path(folder) / "mesh.ply"
        trimesh.Trimesh(vertices, faces, process=False).export(path)
        return _fitted(path)


def _with_detail(scene: Scene, vertices: np.ndarray, faces: np.ndarray) -> Scene:
    """The scene with another surface; its frames have points, and are not to be shaded."""
    a, b, c = (vertices[faces[:, k]] for k in range(3))
    normals = np.cross(b - a, c - a)
    normals /= np.maximum(np.linalg.norm(normals, axis=1, keepdims=True), np.float32(1e-30))
    unshaded = np.broadcast_to(np.float32(0), vertices.shape)
    mesh = PreparedMesh(vertices, faces, unshaded, normals)
    return Scene((mesh,), scene.lights, scene.up, scene.ground, Tracer(vertices, faces))


def crossing(counts: np.ndarray, ratios: np.ndarray) -> str:
    """In words, the number of triangles from which on the field is faster."""
    slower = np.flatnonzero(ratios < 1)
    if len(slower) == 0:
        return f"field as fast from fewer than {counts[0]:,} triangles on; ratio at {counts[-1]:,}"
    last = slower[-1]
    if last == len(counts) - 1:
        return f"field not as fast at {counts[-1]:,} triangles; ratio there"
    along = -np.log(ratios[last]) / np.log(ratios[last + 1] / ratios[last])
    even = np.exp(np.interp(along, [0, 1], np.log(counts[last : last + 2])))
    return f"field as fast from {even:,.0f} triangles on; ratio at {counts[-1]:,}"
