"""Suns of three sizes: one walk of a cone through an object's field, beside rays by Embree.

Frames of an object over the ground, on one thread. Of each method the mean squared error against
many rays, and its time of a pixel; and how many rays have the same error or take the same time, sent
to Embree by embreex and in packets of eight from C: of a pixel's 8 rays they are one packet.
How far the field is pushed out is chosen on other frames.
"""

from collections.abc import Sequence
from functools import partial
from pathlib import Path

import numpy as np
import pandas as pd
from embree_rays import INCOHERENT, PACKETS, EmbreeTriangles, best_of_forms, check_compiled
from measurement import Row, median_seconds

from neural_shadows.evaluation.soft_method_names import CONE_WALKS
from neural_shadows.evaluation.soft_methods.object_field import ObjectField, fitted_field
from neural_shadows.evaluation.soft_methods.ray_traced import Blocked, ray_traced
from neural_shadows.evaluation.soft_methods.registry import soft_method
from neural_shadows.frames.soft_frame import SoftFrame
from neural_shadows.meshes.prepared_mesh import PreparedMesh, read_prepared, with_normals
from neural_shadows.networks.object_space.field_cones import above_plane, dim_by_field, split_disc
from neural_shadows.rendering.surface import see_surface
from neural_shadows.rendering.viewpoints import draw_viewpoints
from neural_shadows.scenes.cameras import VIEW_SETS, Camera
from neural_shadows.scenes.scene import make_scene
from neural_shadows.scenes.tracing import NEARLY_ALL, EmbreeSingly, Tracer

DEGREES = (1.0, 2.5, 5.0)  # the sun's angular radius
RAYS = (1, 2, 4, 8, 16, 32)
FAR, GROUND = 100.0, 20.0  # in radii of the object's sphere: the light's distance, half a side
RAY_FORMS = {"rt": "embreex", "packets": PACKETS}
SEED, OTHER = 2026, 77
LIGHT = {"domain": "sphere", "min_elevation_deg": 20}
CELL = 2 / 256


def rows(mesh_ply: Path, quick: bool) -> list[Row]:
    """Prints the whole table; of each cone two rows beside either form of rays.

    One's ratio is of the rays of the same error; the other is how many rays take the same time.
    """
    check_compiled()
    table = errors_and_times(read_prepared(mesh_ply), quick)
    print(table.to_string(index=False, float_format="{:,.4g}".format))
    result = []
    for cone in table[table.method.str.startswith("cone")].itertuples():
        stage = f"sun of {cone.degrees:g} degrees: {cone.method}, squared error {cone.mse:.2g}"
        for rays in RAY_FORMS:
            ns, of_time = (
                getattr(cone, f"{key}_{rays}") for key in ("ns_of_error", "rays_of_time")
            )
            peer = f"{RAY_FORMS[rays]}, {cone.rays_of_error:.3g} a pixel of the same error"
            rate = {"peer": peer, "peer_rate": 1e9 / ns}
            result.append(Row(stage, "cpu x1", 1e9 / cone.ns, "pixels/s", **rate))
            stage_of_time = f"{stage}, {RAY_FORMS[rays]} in equal time"
            result.append(Row(stage_of_time, "cpu x1", of_time, "rays a pixel"))
    return result


def errors_and_times(mesh: PreparedMesh, quick: bool) -> pd.DataFrame:
    """By degrees and method: `mse`, `ns` of a pixel, and the columns of `_beside_rays`."""
    size, count, rounds = ((120, 80), 1, 9) if quick else ((600, 400), 2, 3)
    field = fitted_field(mesh, CELL)
    tracer = Tracer(mesh.vertices, mesh.faces)
    embree = EmbreeTriangles(mesh.vertices, mesh.faces)
    packets = partial(embree.packets, end=NEARLY_ALL)
    singly = partial(EmbreeSingly(mesh.vertices, mesh.faces).occluded, end=NEARLY_ALL)
    forms = {"rt_{}": singly, "packets_{}": packets}
    forms["packets_{}" + INCOHERENT] = partial(packets, coherent=False)
    frames, others = (_frames(mesh, seed, count, size) for seed in (SEED, OTHER))
    found = []
    for degrees in DEGREES:
        radius = FAR * np.tan(np.radians(degrees))
        exact, exact_of_others = (
            [_many_rays(one, radius, tracer) for one in of] for of in (frames, others)
        )
        push = min(
            soft_method("cone_1").constants["push"],
            key=lambda push: _error(
                [cone(one, radius, field, 1, push) for one in others], exact_of_others
            ),
        )
        works = {"hard": partial(_all, _rays, frames, 0.0, tracer.blocked, 1)}
        works |= {
            form.format(n): partial(_all, _rays, frames, radius, blocked, n)
            for n in RAYS
            for form, blocked in forms.items()
        }
        works |= {
            f"cone_{n}": partial(_all, cone, frames, radius, field, n, push) for n in CONE_WALKS
        }
        seconds = best_of_forms(median_seconds(works, rounds, "thread_time"))
        pixels = sum(len(one.starts) for one in frames)
        found.append(
            pd.DataFrame(
                {
                    "degrees": degrees,
                    "method": list(seconds),
                    "mse": [_error(works[name](), exact) for name in seconds],
                    "ns": [1e9 * value / pixels for value in seconds.values()],
                    "push": push,
                }
            ).pipe(_beside_rays)
        )
    embree.close()
    return pd.concat(found, ignore_index=True)


def cone(
    frame: SoftFrame, radius: float, field: ObjectField, walks: int, push: float
) -> np.ndarray:
    """How much of the light each point sees past one object, (n,) float32; see `cone_traced`."""
    ways, size = frame.centre.astype(np.float32) - frame.starts, np.float32(radius)
    visible = above_plane(frame.surface.n_g, ways, size)
    around = field.centre, field.radius, field.cone_field
    told = split_disc(walks), np.float32(push)
    dim_by_field(frame.starts, frame.surface.n_g, ways, size, *around, *told, visible)
    return visible


def _rays(frame: SoftFrame, radius: float, blocked: Blocked, samples: int) -> np.ndarray:
    return ray_traced(frame, radius, samples=samples, blocked=blocked)


def _all(answer, frames: Sequence[SoftFrame], *told) -> list[np.ndarray]:
    return [answer(frame, *told) for frame in frames]


def _many_rays(frame: SoftFrame, radius: float, tracer: Tracer) -> np.ndarray:
    """Other rays than those that are measured: what a sequence's fourth frame would send."""
    later = SoftFrame(frame.scene, frame.surface, frame.centre, frame.light_map, number=3)
    return _rays(later, radius, tracer.blocked, 256)


def _error(found: Sequence[np.ndarray], exact: Sequence[np.ndarray]) -> float:
    return float(np.mean(np.square(np.concatenate(found) - np.concatenate(exact))))


def _beside_rays(table: pd.DataFrame) -> pd.DataFrame:
    """How many rays have each row's error, `rays_of_error`; and of either form of rays their time,
    `ns_of_error_…`, and how many take the row's time, `rays_of_time_…`: on logarithms, between the
    numbers that were measured.
    """
    count = np.log(RAYS)
    error = np.log(table.mse[table.method.str.startswith("rt_")])
    same = np.interp(-np.log(table.mse), -error, count)
    columns = {"rays_of_error": np.exp(same)}
    for form in RAY_FORMS:
        ns = np.log(table.ns[table.method.str.startswith(f"{form}_")])
        columns[f"ns_of_error_{form}"] = np.exp(np.interp(same, count, ns))
        columns[f"rays_of_time_{form}"] = np.exp(np.interp(np.log(table.ns), ns, count))
    return table.assign(**columns)


def _frames(mesh: PreparedMesh, seed: int, count: int, size: tuple[int, int]) -> list[SoftFrame]:
    """Of each kind of viewpoint as many; the object stands on a square of ground."""
    up = np.array([0.0, 1.0, 0.0])
    alone = make_scene(mesh, up=up, ground=True, light=LIGHT)
    corners = GROUND * np.array([[-1, 0, -1], [-1, 0, 1], [1, 0, 1], [1, 0, -1]])
    corners[:, 1] = alone.ground
    ground = with_normals(corners.astype(np.float32), np.array([[0, 1, 2], [0, 2, 3]], np.int32))
    scene = make_scene(mesh, ground, up=up, ground=False, light=None)
    found = []
    for view in draw_viewpoints(alone, VIEW_SETS, range(count), size[0] / size[1], seed):
        camera = Camera(view.eye, view.target, view.up, view.fov)
        surface = see_surface(scene, camera, *size)
        found.append(SoftFrame(alone, surface, FAR * view.light, None))
    return found
