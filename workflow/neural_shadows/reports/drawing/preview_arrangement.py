"""A picture of a scene in metres: a plan and three views."""

from itertools import cycle
from pathlib import Path

import numpy as np
from matplotlib.axes import Axes
from matplotlib.colors import to_rgb
from matplotlib.patches import Patch, Rectangle

from neural_shadows.evaluation.look import BLUE, COLOURS, GREEN, ORANGE, PINK
from neural_shadows.frames.draw_settings import FrameKind, draw_setting, preview
from neural_shadows.frames.setting import Setting
from neural_shadows.frames.soft_scene import SoftScene
from neural_shadows.rendering.shading import AMBIENT, BACKGROUND
from neural_shadows.rendering.soft_shadows import OFFSET, PLACES
from neural_shadows.rendering.surface import Surface, see_surface
from neural_shadows.reports.drawing.style import new_figure, note_below, write_figure
from neural_shadows.running import progress
from neural_shadows.running.stage import run_stage
from neural_shadows.scenes.arrangement import UP
from neural_shadows.scenes.scene import Scene
from neural_shadows.settings.records import GeneratedScene

WIDTH, HEIGHT, FOV = 480, 300, 55  # of a view
PLAN = 520  # pixels along the plan's longer side
VIEWS, DRAWS = 3, 12  # views with most of the inserted objects, of so many
PLACE = PLACES[::4]  # two places in a pixel: smooth enough for a picture
RADIUS = 0.05  # metres, of the light that a view has to be clear of
CAMERAS, LIGHTS = BLUE, ORANGE
GREY = (0.85, 0.85, 0.85)
INSERTED = (GREEN, PINK, *COLOURS[4:6])


def draw(
    meshes: list[Path],
    png: Path,
    svg: Path,
    *,
    name: str,
    scene: GeneratedScene,
    seed: int,
    advice: str,
) -> None:
    """Draw a plan of a scene with its regions, and views from them.

    Inserted objects are in colour. The views have cameras and lights drawn as those of frames are.

    Args:
        meshes: see `SoftScene`. seed: of the views. advice: what to do next.

    Raises:
        InputError: see `SoftScene`; or no camera and light can be drawn.
    """
    opened = SoftScene(scene, meshes)
    arrangement, at_rest = opened.arrangement, opened.at_rest
    own = len(arrangement.objects)
    inserted = dict(zip(scene["inserted"], cycle(INSERTED)))
    colours = np.array([GREY] * own + [to_rgb(colour) for colour in inserted.values()])
    sizes = [np.ptp(mesh.vertices, axis=0) for mesh in at_rest.objects[own:]]
    title = f"{name}: {scene['generate']}, {len(at_rest.joined.faces):,} triangles, "
    figure = new_figure(title + _metres(np.ptp(at_rest.joined.vertices, axis=0)), 12.8, 8.6)
    plan, *views = figure.subplots(2, 2).ravel()
    _draw_plan(plan, opened, colours)
    for axes, setting in zip(views, _settings(opened, np.random.default_rng(seed))):
        _draw_view(axes, at_rest, setting, colours)
    patches = [Patch(color=colour, label=label) for label, colour in inserted.items()]
    patches += [
        Patch(fill=False, edgecolor=LIGHTS, label="region of lights"),
        Patch(fill=False, edgecolor=CAMERAS, label="region of cameras"),
    ]
    figure.legend(handles=patches, loc="outside upper right", ncols=len(patches))
    objects = [f"{label} {_metres(size)}" for label, size in zip(inserted, sizes)]
    free = arrangement.spots[len(objects) :]
    spots = ", ".join(f"{spot.height:g} m" for spot in free) or "none"
    notes = [
        f"Inserted: {', '.join(objects) or 'nothing'} (width × height × depth). Free spots: {spots}.",
        advice,
    ]
    note_below(figure, "\n".join(notes))
    print(*notes, sep="\n", file=progress.TERMINAL)
    write_figure(figure, png, svg)


def _metres(size: np.ndarray) -> str:
    return " × ".join(f"{side:.2g}" for side in size) + " m"


def _settings(scene: SoftScene, rng: np.random.Generator) -> list[Setting]:
    """Draw views, those with most of the inserted objects first."""
    kind = FrameKind(WIDTH, HEIGHT, FOV, None, {"kind": "cube", "resolution": 64}, RADIUS)
    settings = [draw_setting(scene, kind, rng) for _ in range(DRAWS)]
    own = len(scene.arrangement.objects)

    def inserted(setting: Setting) -> int:
        faces = preview(scene.at_rest, kind, setting).face
        return int((scene.at_rest.owner[faces] >= own).sum())

    return sorted(settings, key=inserted, reverse=True)[:VIEWS]


def _draw_view(axes: Axes, scene: Scene, setting: Setting, colours: np.ndarray) -> None:
    surfaces = [see_surface(scene, setting.camera, WIDTH, HEIGHT, place) for place in PLACE]
    axes.imshow(np.mean([_shaded(scene, s, setting.centre, colours) for s in surfaces], axis=0))
    away = np.linalg.norm(setting.camera.target - setting.camera.eye)
    place = ", ".join(f"{x:.1f}" for x in setting.centre)
    axes.set_title(f"light at ({place}) m, target {away:.1f} m away", fontsize=10)
    axes.set(xticks=[], yticks=[])


def _shaded(scene: Scene, surface: Surface, centre: np.ndarray, colours: np.ndarray) -> np.ndarray:
    """Lambert picture with hard shadows, (height, width, 3)."""
    to_light = centre.astype(np.float32) - surface.p
    start = surface.p + np.float32(OFFSET * scene.size) * surface.n_g
    lit = ~scene.tracer.blocked(start, to_light)
    lit &= np.einsum("ij,ij->i", surface.n_g, to_light) > 0
    cosines = np.einsum("ij,ij->i", surface.n, to_light) / np.linalg.norm(to_light, axis=1)
    light = AMBIENT + (1 - AMBIENT) * np.clip(cosines, 0, 1) * lit
    return surface.image(light[:, None] * colours[scene.owner[surface.face]], BACKGROUND)


def _draw_plan(axes: Axes, scene: SoftScene, colours: np.ndarray) -> None:
    """The scene from above without what is above the lights, and its regions."""
    arrangement, opened = scene.arrangement, scene.at_rest
    low, high = opened.joined.vertices.min(0), opened.joined.vertices.max(0)
    height = (
        float(min(high[1], max(arrangement.lights.high[1], arrangement.cameras.high[1]))) + 0.01
    )
    step = max(high[0] - low[0], high[2] - low[2]) / PLAN
    x, z = np.meshgrid(np.arange(low[0], high[0], step), np.arange(low[2], high[2], step))
    start = np.stack([x, np.full_like(x, height), z], axis=-1, dtype=np.float32).reshape(-1, 3)
    down = np.broadcast_to(-UP.astype(np.float32), start.shape)
    t, face = opened.tracer.first_hit(start, np.ascontiguousarray(down))
    hit = face >= 0
    rise = np.clip(1 - t[hit] / (height - low[1]), 0, 1)  # the higher the lighter
    level = np.abs(opened.joined.face_normals[face[hit], 1])
    image = np.ones((len(start), 3))
    light = (0.7 + 0.3 * rise) * (0.4 + 0.6 * level)
    image[hit] = light[:, None] * colours[opened.owner[face[hit]]] / GREY[0]
    extent = (low[0], high[0], high[2], low[2])
    axes.imshow(np.clip(image, 0, 1).reshape(*x.shape, 3), extent=extent)
    for region, colour in ((arrangement.cameras, CAMERAS), (arrangement.lights, LIGHTS)):
        sides = (region.high - region.low)[[0, 2]]
        axes.add_patch(Rectangle(region.low[[0, 2]], *sides, fill=False, edgecolor=colour))
    axes.autoscale()
    span = f"{arrangement.lights.low[1]:.1f} to {arrangement.lights.high[1]:.1f} m high"
    axes.set_title(f"plan below {height:.1f} m, in metres; lights {span}", fontsize=10)


if "snakemake" in globals():
    run_stage(snakemake, draw)
