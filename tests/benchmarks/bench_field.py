"""Shadow rays through an occupancy field beside Embree's any-hit rays: same rays, one thread.

And against triangles: the field's rate does not depend on them, Embree's falls. Coarser meshes are
decimated, finer ones are subdivided and displaced by less than a tenth of a field's cell.
"""

from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from tempfile import TemporaryDirectory

import numpy as np
import torch
import trimesh
from measurement import Row, median_seconds
from torch import Tensor

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
UNTRAINED |= {"stored": "int8", "start": "distances"}
COARSE = (5_000, 20_000, 80_000)  # triangles
SUBDIVIDED = 2  # times, of four triangles for each
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


def rows(mesh_ply: Path, weights: list[Path], quick: bool) -> list[Row]:
    """Rates of each trained field of a solid, or of untrained distances if there is none."""
    torch.set_num_threads(1)
    scene = open_scene(mesh_ply, **SCENE)
    number = range(1 if quick else 3)
    views = draw_viewpoints(scene, VIEW_SETS, number, WIDTH / HEIGHT, SEED)
    frames = [_asked(render_gbuffer(scene, view, WIDTH, HEIGHT)) for view in views]
    found = []
    for name, network in _fields(mesh_ply, weights):
        found += _frame_rows(name, network, scene.tracer, frames, 3 if quick else 7)
    _, network = next(iter(_fields(mesh_ply, weights)))
    return found + _triangle_rows(network, mesh_ply, frames[:3])


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
            fields["untrained 256³ distances"], _ = load_network(Path(folder) / "field")
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


def _triangle_rows(network, mesh_ply: Path, frames: list[Asked]) -> list[Row]:
    """The field against Embree on meshes of growing numbers of triangles, and where they are even."""
    found, counts, ratios = [], [], []
    for vertices, faces in _meshes(mesh_ply):
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


def _meshes(mesh_ply: Path) -> Iterator[tuple[np.ndarray, np.ndarray]]:
    """Vertices and faces of ever more triangles."""
    mesh = read_prepared(mesh_ply)
    for count in COARSE:
        if count < len(mesh.faces):
            yield decimated(mesh.vertices, mesh.faces, count)
    vertices, faces = mesh.vertices, mesh.faces
    yield vertices, faces
    for _ in range(SUBDIVIDED):
        vertices, faces = trimesh.remesh.subdivide(vertices, faces)
        yield vertices + SHIFT * np.sin(WAVES * np.roll(vertices, 1, axis=1)), faces
