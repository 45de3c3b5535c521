"""Many copies of few objects on a plain, under a sun and round a lamp: by fields and by triangles."""

from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import NamedTuple

import numpy as np
from matplotlib.figure import Figure

from neural_shadows.errors import InputError
from neural_shadows.files.whole_files import read_json
from neural_shadows.meshes.prepared_mesh import read_prepared
from neural_shadows.networks.object_space.field_instances import FieldInstances
from neural_shadows.networks.object_space.untrained_field import untrained_field
from neural_shadows.rendering.gbuffer import SHADING_OFFSET, pixel_directions
from neural_shadows.rendering.shading import AMBIENT, BACKGROUND
from neural_shadows.reports.figures.style import Section, new_figure, note_below, write_figure
from neural_shadows.reports.frame_errors import error_legend, with_errors
from neural_shadows.running.stage import run_stage
from neural_shadows.scenes.arrangement import UP
from neural_shadows.scenes.cameras import Camera
from neural_shadows.scenes.forest import scattered
from neural_shadows.scenes.mesh_instances import MeshInstances

WIDTH, HEIGHT = 900, 600
SUN = np.array([0.62, 0.62, 0.48])  # towards it, not of unit length
LAMP = 1.0  # height of the lamp, in the middle of the scene
FAR = 400.0  # where the plain ends
NOTE = (
    "An object's field is asked in each place where a copy of it stands; nothing else is held of it. "
    "Exact shadows by Embree, one tree an object."
)


class Seen(NamedTuple):
    """The m points of a picture that anything is seen at."""

    pixel: np.ndarray  # (m,) int64
    p: np.ndarray  # (m, 3) float32, a little off the surface
    n_g: np.ndarray  # (m, 3) float32, on the camera's side


class Shadows(NamedTuple):
    """One light's picture, exact and by fields, grey (HEIGHT, WIDTH) float32."""

    title: str
    exact: np.ndarray
    by_fields: np.ndarray
    false_shadow: float  # shares of all points that face the light
    leak: float


def draw(
    meshes: list[Path],
    reports: list[Path],
    png: Path,
    svg: Path,
    *,
    title: str,
    ups: Sequence[str],
    instances: int,
    resolution: int,
    seed: int,
    run: Section,
) -> None:
    """Draw a forest by fields that were not trained, and where they are wrong.

    Args:
        meshes, reports: of the objects, prepared. ups: the axis of each that points up.
        instances: copies. resolution: cells of a field along an axis.

    Raises:
        InputError: an object is an open sheet, or a file is not whole.
    """
    for path, report in zip(meshes, map(read_json, reports)):
        if report["sheet"]:
            raise InputError(
                f"mesh {path}: open and thin, without an inside; leave it out of the forest's `scenes`"
            )
    objects = [read_prepared(path) for path in meshes]
    vertices = [mesh.vertices for mesh in objects]
    placed = scattered(vertices, ups, instances, np.random.default_rng(seed))
    exact = MeshInstances(objects, *placed)
    fields = FieldInstances([untrained_field(path, resolution) for path in meshes], *placed)
    far, near = cameras(placed[1])
    found = [
        shadows("Under the sun", exact, fields, far, None),
        shadows("Under the sun, nearer", exact, fields, near, None),
        shadows("Round a lamp", exact, fields, near, np.array([0.0, LAMP, 0.0])),
    ]
    triangles = sum(len(objects[kind].faces) for kind in placed[0])
    heading = (
        f"{title}: {instances:,} copies of {len(objects)} objects, {triangles / 1e6:,.1f} million "
        f"triangles; {fields.bytes / 2**20:.1f} MiB of fields ({run['scale']} scale)"
    )
    write_figure(forest_figure(found, heading), png, svg)


def cameras(placements: np.ndarray) -> Iterator[Camera]:
    """One that sees all copies (n, 4, 4), and one among them."""
    side = np.abs(placements[:, [0, 2], 3]).max()
    yield Camera(np.array([0.75 * side, 0.3 * side, side]), np.zeros(3), UP, 42.0)
    yield Camera(np.array([5.0, 4.0, 6.0]), np.array([0.0, 0.5, 0.0]), UP, 50.0)


def shadows(
    title: str,
    exact: MeshInstances,
    fields: FieldInstances,
    camera: Camera,
    lamp: np.ndarray | None,
) -> Shadows:
    """A camera's picture lit by a lamp at a place, or without one by the sun."""
    seen = see(exact, camera)
    if lamp is None:
        ways = np.tile((SUN / np.linalg.norm(SUN)).astype(np.float32), (len(seen.p), 1))
        asked = exact.occluded, fields.occluded
    else:
        ways = lamp.astype(np.float32) - seen.p
        asked = exact.blocked, fields.blocked
    cosine = np.einsum("ij,ij->i", seen.n_g, ways) / np.linalg.norm(ways, axis=1)
    facing = np.flatnonzero(cosine > 0)
    true, told = (ask(seen.p[facing], ways[facing]) for ask in asked)
    pictures = []
    for dark in (true, told):
        image = np.full(WIDTH * HEIGHT, BACKGROUND, np.float32)
        image[seen.pixel] = AMBIENT
        image[seen.pixel[facing]] += (1 - AMBIENT) * cosine[facing] * ~dark
        pictures.append(image.reshape(HEIGHT, WIDTH))
    return Shadows(title, *pictures, np.mean(told & ~true), np.mean(true & ~told))


def see(exact: MeshInstances, camera: Camera) -> Seen:
    """What a camera sees of the copies and of the plain at y = 0 under them."""
    directions = pixel_directions(camera, WIDTH, HEIGHT)
    origins = np.tile(camera.eye.astype(np.float32), (len(directions), 1))
    t, n_g = exact.first_hit(origins, directions)
    down = np.where(directions[:, 1] < 0, -directions[:, 1], np.float32(1e-30))
    to_plain = np.float32(camera.eye[1]) / down
    plain = (to_plain < t) & (to_plain < FAR)
    t, n_g[plain] = np.where(plain, to_plain, t), (0, 1, 0)
    pixel = np.flatnonzero(np.isfinite(t))
    n_g, d = n_g[pixel], directions[pixel]
    n_g *= -np.sign(np.einsum("ij,ij->i", n_g, d))[:, None]
    p = origins[pixel] + t[pixel, None] * d + np.float32(SHADING_OFFSET) * n_g
    return Seen(pixel, p, n_g)


def forest_figure(found: Sequence[Shadows], title: str) -> Figure:
    """A row for each picture: exact, by fields, and the errors."""
    width = 15.0
    figure = new_figure(title, width, 0.9 + len(found) * (width / 3 * HEIGHT / WIDTH + 0.3))
    figure.legend(handles=error_legend(), loc="outside upper right", ncols=2)
    note_below(figure, NOTE)
    for row, one in zip(figure.subplots(len(found), 3, squeeze=False), found):
        wrong = f"{one.false_shadow:.2%} false shadow, {one.leak:.2%} light leak"
        panels = (
            (f"{one.title}: exact", one.exact, {"cmap": "gray", "vmin": 0, "vmax": 1}),
            ("by fields", one.by_fields, {"cmap": "gray", "vmin": 0, "vmax": 1}),
            (wrong, with_errors(one.by_fields, one.exact, 3), {}),
        )
        for axes, (name, image, look) in zip(row, panels):
            axes.imshow(image, **look)
            axes.set_title(name, fontsize=10)
            axes.set_axis_off()
    return figure


if "snakemake" in globals():
    run_stage(snakemake, draw)
