"""Shadow rays through an occupancy field beside Embree's any-hit rays: same rays, one thread.

And against triangles: the field's rate does not depend on them, Embree's falls. Coarser meshes are
decimated, finer ones are subdivided and displaced by less than a tenth of a field's cell. And how
long it takes from a mesh's file to a frame's first answers.
"""

import time
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from tempfile import TemporaryDirectory

import numpy as np
import torch
from measurement import Row, median_seconds
from torch import Tensor

from neural_shadows.meshes.prepare_mesh import prepare_mesh
from neural_shadows.meshes.prepared_mesh import read_prepared
from neural_shadows.networks.kinds import make_network
from neural_shadows.networks.object_space.occupancy_field_network import OccupancyFieldNetwork
from neural_shadows.networks.object_space.shadow_query import on_device
from neural_shadows.networks.object_space.sphere_rays import SphereRays, sphere_rays
from neural_shadows.networks.untrained.decimation import decimated
from neural_shadows.networks.weight_file import load_network, save_network
from neural_shadows.rendering.gbuffer import render_gbuffer
from neural_shadows.rendering.viewpoints import draw_viewpoints
from neural_shadows.scenes.scene import open_scene
from neural_shadows.scenes.tracing import Tracer

SCENE = {"up": "y", "ground": True, "light": {"domain": "sphere", "min_elevation_deg": 20}}
WIDTH, HEIGHT, SEED = 1200, 800, 2026
VIEW_SETS = ("shadow", "surface", "centre")
UNTRAINED = {"encoding": "occupancy_field", "resolution": 256, "surface": "solid"}
UNTRAINED |= {"stored": "coded", "start": "fitted"}
COARSE = (5_000, 20_000, 80_000)  # triangles
SUBDIVIDED = 2  # times, of four triangles for each; once more, and to MOST, where time is not short
MOST = 20_000_000
SHIFT, WAVES = 3e-4, 300.0  # of displaced meshes, in radii and in radians a radius
EMBREE = "Embree's occlusion rays"


@dataclass(frozen=True, eq=False)
class Asked:
    """The rays of a frame, from its points to the light and from the sphere to its points."""

    points: np.ndarray  # (k, 3)
    towards: np.ndarray  # (k, 3), the light for each
    rays: SphereRays
    d: Tensor

    def embree(self, tracer: Tracer) -> np.ndarray:
        """Whether each point is in shadow, (k,) bool."""
        return tracer.occluded(self.points, self.towards)

    def field(self, network: OccupancyFieldNetwork) -> np.ndarray:
        """The same of a field."""
        return ~network.lit(self.rays, self.d, torch.float32)(0.0).numpy()


def rows(source: Path, mesh_ply: Path, weights: list[Path], quick: bool) -> list[Row]:
    """Rates of each field of a solid that is given, or of a fitted one if there is none.

    Args:
        source: the file that the prepared mesh was made of.
    """
    torch.set_num_threads(1)
    scene = open_scene(mesh_ply, **SCENE)
    number = range(1 if quick else 3)
    views = draw_viewpoints(scene, VIEW_SETS, number, WIDTH / HEIGHT, SEED)
    frames = [_asked(render_gbuffer(scene, view, WIDTH, HEIGHT)) for view in views]
    found = []
    for name, network in _fields(mesh_ply, weights):
        found += _frame_rows(name, network, scene.tracer, frames, 3 if quick else 7)
    _, network = next(iter(_fields(mesh_ply, weights)))
    found += _first_answer_rows(source, frames[0], 3)
    return found + _triangle_rows(network, _meshes(mesh_ply, quick), frames[:3])


def _asked(frame) -> Asked:
    points, light = on_device(frame.p, frame.view.light, torch.device("cpu"))
    rays = sphere_rays(points, light)
    points = points[rays.index].numpy()
    return Asked(points, np.tile(light.numpy(), (len(points), 1)), rays, -light)


def _fields(mesh_ply: Path, weights: list[Path]) -> Iterator[tuple[str, OccupancyFieldNetwork]]:
    loaded = {path.parent.name: load_network(path)[0] for path in weights}
    fields = {
        name: network
        for name, network in loaded.items()
        if isinstance(network, OccupancyFieldNetwork) and network.surface == "solid"
    }
    if not fields:
        network = make_network(UNTRAINED)
        network.prepare(mesh_ply)
        network.initialise(0)
        with TemporaryDirectory() as folder:  # values as a file has them
            save_network(Path(folder) / "field", network, {"network": UNTRAINED})
            fields["fitted 256³ field"], _ = load_network(Path(folder) / "field")
    yield from fields.items()


def _frame_rows(name, network, tracer, frames: list[Asked], rounds: int) -> list[Row]:
    """Each frame's rates, the median ratio, the pixels that differ, and what is held."""
    found, ratios, wrong = [], [], []
    for number, frame in enumerate(frames):
        rate = _rates(network, tracer, frame, rounds)
        ratios.append(rate["field"] / rate[EMBREE])
        shadowed, exact = frame.field(network), frame.embree(tracer)
        pixels = WIDTH * HEIGHT
        wrong.append([(shadowed & ~exact).sum() / pixels, (~shadowed & exact).sum() / pixels])
        stage = f"{name}, frame {number}, {len(frame.points):,} rays"
        found.append(
            Row(stage, "cpu x1", rate["field"], "rays/s", peer=EMBREE, peer_rate=rate[EMBREE])
        )
    false_shadow, leak = 100 * np.mean(wrong, axis=0)
    return [
        *found,
        Row(f"{name}, median ratio to Embree", "cpu x1", float(np.median(ratios)), "×"),
        Row(f"{name}, false shadow", "cpu x1", false_shadow, "% of pixels"),
        Row(f"{name}, leak", "cpu x1", leak, "% of pixels"),
        Row(f"{name}, resident", "cpu x1", network.resident_bytes() / 1024, "KiB"),
    ]


def _rates(network, tracer, frame: Asked, rounds: int) -> dict[str, float]:
    works = {"field": lambda: frame.field(network), EMBREE: lambda: frame.embree(tracer)}
    seconds = median_seconds(works, rounds)
    return {name: len(frame.points) / value for name, value in seconds.items()}


def _first_answer_rows(source: Path, frame: Asked, rounds: int) -> list[Row]:
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


def _first_answer(source: Path, folder: Path, frame: Asked) -> dict[str, tuple[float, float]]:
    """Of each part of the way, its seconds on the clock and of processors."""
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


def _triangle_rows(network, meshes, frames: list[Asked]) -> list[Row]:
    """The field against Embree on meshes of growing numbers of triangles, and where they are even."""
    found, counts, ratios = [], [], []
    for vertices, faces in meshes:
        tracer = Tracer(vertices, faces)
        rates = [_rates(network, tracer, frame, 3) for frame in frames]
        sizes = np.array([len(frame.points) for frame in frames])
        rate = {
            name: sizes.sum() / (sizes / [rate[name] for rate in rates]).sum() for name in rates[0]
        }
        counts.append(len(faces))
        ratios.append(rate["field"] / rate[EMBREE])
        differ = [(frame.field(network) != frame.embree(tracer)).sum() for frame in frames]
        share = 100 * np.mean(differ) / (WIDTH * HEIGHT)
        stage = f"field, mesh of {len(faces):,} triangles, {share:.3f} % of pixels differ"
        found.append(
            Row(stage, "cpu x1", rate["field"], "rays/s", peer=EMBREE, peer_rate=rate[EMBREE])
        )
    return [*found, Row(crossing(np.array(counts), np.array(ratios)), "cpu x1", ratios[-1], "×")]


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


def _meshes(mesh_ply: Path, quick: bool) -> Iterator[tuple[np.ndarray, np.ndarray]]:
    """Vertices and faces of ever more triangles."""
    mesh = read_prepared(mesh_ply)
    for count in COARSE:
        if count < len(mesh.faces):
            yield decimated(mesh.vertices, mesh.faces, count)
    yield mesh.vertices, mesh.faces
    corners = mesh.vertices[mesh.faces]
    for _ in range(SUBDIVIDED if quick else SUBDIVIDED + 1):
        corners = _subdivided(corners)
        yield _displaced(corners)
    more = (MOST - len(corners)) // 3
    if not quick and more > 0:
        yield _displaced(np.concatenate([corners[more:], _subdivided(corners[:more])]))


def _subdivided(corners: np.ndarray) -> np.ndarray:
    """Four triangles (4 n, 3, 3) for each of (n, 3, 3)."""
    a, b, c = corners.swapaxes(0, 1)
    ab, bc, ca = (a + b) / 2, (b + c) / 2, (c + a) / 2
    parts = [(a, ab, ca), (ab, b, bc), (ca, bc, c), (ab, bc, ca)]
    return np.concatenate([np.stack(part, axis=1) for part in parts])


def _displaced(corners: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Vertices and faces, each face with vertices of its own; equal ones move alike."""
    vertices = corners.reshape(-1, 3)
    faces = np.arange(len(vertices), dtype=np.int32).reshape(-1, 3)
    return vertices + np.float32(SHIFT) * np.sin(WAVES * np.roll(vertices, 1, axis=1)), faces
