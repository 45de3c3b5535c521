"""Stage for interactive pages of scenes under a movable area light."""

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np
from PIL import Image

from neural_shadows.errors import InputError
from neural_shadows.evaluation.memory import network_bytes
from neural_shadows.files.whole_files import whole_file
from neural_shadows.frames.draw_settings import FrameKind, draw_setting
from neural_shadows.frames.setting import Setting
from neural_shadows.frames.soft_scene import SoftScene
from neural_shadows.networks.screen_space.screen_networks import load_screen_network
from neural_shadows.rendering.light_shape import SPHERE, light_shape
from neural_shadows.rendering.soft_shadows import soft_visibility
from neural_shadows.rendering.surface import see_surface
from neural_shadows.reports.data.phrases import describe_run
from neural_shadows.running.stage import run_stage
from neural_shadows.scenes.scene import Scene
from neural_shadows.settings.records import FrameSettings, GeneratedScene, Run
from neural_shadows.viewer.screen_arrays import screen_arrays
from neural_shadows.viewer.soft_scene_arrays import shown_fields, shown_scene
from neural_shadows.viewer.template import fill_template, shaders, shown_view, write_html

MOST_BYTES = 6 << 20
POSTER = (960, 480)  # pixels
_VIEWS = 4


def write_soft_viewer(
    *,
    html: Path,
    png: Path,
    template: list[Path],
    meshes: list[Path],
    weights: list[Path],
    labels: Sequence[str],
    name: str,
    scene: GeneratedScene,
    frames: FrameSettings,
    triangles: int,
    resolution: int,
    seed: int,
    run: Run,
) -> None:
    """Write a scene's viewer as one file, and its poster.

    Args:
        template: the files of `workflow/report/soft_viewer`, and those that it shares.
        meshes: see `SoftScene`. weights: of the networks; labels: their names.
        name: of the scene. scene: see `SoftScene`.
        frames: of the frame set: `fov`, `radii` and `radius_unit`.
        triangles: shown at most. resolution: texels along a side of the light's map.
        seed: of the views.

    Raises:
        InputError: a mesh or weights cannot be read, or a network has no shaders.
    """
    opened = SoftScene(scene, meshes)
    size = opened.at_rest.size
    radius = SPHERE.radius_of(max(frames["radii"]), frames["radius_unit"], size)
    settings = _views(opened, frames["fov"], radius, seed)
    image = poster(opened.at_rest, settings[0], radius / 2)
    with whole_file(png) as part:
        image.save(part, "PNG")
    data, shown, whole = shown_scene(opened, triangles)
    networks = [_network(path, label, size) for path, label in zip(weights, labels, strict=True)]
    title = f"Soft shadows: {name}"
    decimated = f", decimated from {whole:,}" if shown < whole else ""
    page = fill_template(
        template,
        "soft_viewer.html",
        title=title,
        poster=image,
        about=f"A scene of {shown:,} triangles{decimated}, {size:.1f} m long. {describe_run(run)}",
        data={
            "name": name,
            "scene": data,
            "fields": shown_fields(opened.at_rest),
            "radius": radius,
            "resolution": resolution,
            "views": [
                shown_view(f"View {number}", setting.camera, setting.centre)
                for number, setting in enumerate(settings, 1)
            ],
            "networks": networks,
            "shaders": shaders(template),
        },
    )
    write_html(html, page, MOST_BYTES, "Show fewer `triangles` or `networks`")


def poster(scene: Scene, setting: Setting, radius: float) -> Image.Image:
    """Still of a view with its exact soft shadow, in grey."""
    width, height = POSTER
    surface = see_surface(scene, setting.camera, width, height)
    (visibility,) = soft_visibility(
        scene, setting.camera, width, height, centre=setting.centre, radii=[radius], samples=4
    )
    to_light = setting.centre.astype(np.float32) - surface.p
    cosines = np.einsum("ij,ij->i", surface.n, to_light) / np.linalg.norm(to_light, axis=1)
    lit = np.clip(cosines, 0, 1) * visibility.ravel()[surface.pixel]
    ambient = 0.25 + 0.1 * surface.n[:, 1]
    picture = surface.image(np.float32(ambient + 0.65 * lit), 0.9)
    return Image.fromarray(np.round(255 * np.clip(picture, 0, 1)).astype(np.uint8))


def _views(scene: SoftScene, fov: float, radius: float, seed: int) -> list[Setting]:
    width, height = POSTER
    kind = FrameKind(width, height, fov, None, {"kind": "cube", "resolution": 64}, radius)
    rng = np.random.default_rng(seed)
    return [draw_setting(scene, kind, rng) for _ in range(_VIEWS)]


def _network(weights: Path, label: str, size: float) -> Mapping[str, Any]:
    """A network's arrays, name, bytes, and largest radius in metres."""
    network, header = load_screen_network(weights)
    shape = light_shape(header.get("light"))
    if shape.shape != SPHERE.shape:
        raise InputError(f"{weights}: trained on a {shape.shape}. The viewer's light is a sphere.")
    return {
        "key": weights.parent.name,
        "name": label,
        "stored": network_bytes(weights),
        "largest": shape.radius_of(max(header["radii"]), header["radius_unit"], size),
        **screen_arrays(network, header),
    }


if "snakemake" in globals():
    run_stage(snakemake, write_soft_viewer)
