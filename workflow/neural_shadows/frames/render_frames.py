"""Stage: draw and render one scene's frames of one use."""

from collections.abc import Sequence
from pathlib import Path
from typing import Any
from zlib import crc32

import numpy as np

from neural_shadows.files.arrays import new_array
from neural_shadows.files.whole_files import write_json
from neural_shadows.frames.buffers import CHANNELS
from neural_shadows.frames.draw_sequences import draw_sequence
from neural_shadows.frames.draw_settings import FrameKind, draw_setting
from neural_shadows.frames.draw_twins import twin_of
from neural_shadows.frames.frame_set import UNITS
from neural_shadows.frames.render_frame import render_buffers, render_rays, render_target
from neural_shadows.frames.setting import Setting
from neural_shadows.frames.soft_scene import SoftScene
from neural_shadows.frames.uses import USES, motion_of
from neural_shadows.rendering.light_shape import light_shape
from neural_shadows.running.origin import describe_origin
from neural_shadows.running.progress import progress_bar
from neural_shadows.running.stage import run_stage
from neural_shadows.settings.records import FrameSettings, GeneratedScene

_TWINS = (
    7  # random stream of perturbed frames, as of those that the shipped weights were trained on
)


def render_frames(
    meshes: list[Path],
    frames_json: Path,
    buffers_npy: Path,
    targets_npy: Path,
    valid_npy: Path,
    edges_npy: Path,
    rays_npy: Path,
    *,
    scene: GeneratedScene,
    name: str,
    seed: int,
    frames: FrameSettings,
    use: str,
    first: int,
    last: int,
    samples: int,
    rays: int = 0,
) -> None:
    """Render frames `first` to `last` (exclusive) of a scene, see `FrameSetPart`.

    Cameras and lights depend on the seed, the scene's name, the use and the number alone: scenes of
    one layout have settings of their own, and frame sets that share a scene share its settings.

    Args:
        meshes: prepared, of the inserted objects.
        scene: see `SoftScene`. name: its, in the configuration.
        seed: of the run; the scene's layout has its own.
        frames: of the set, see `FrameSettings`.
        use: one of `USES`.
        samples: see `soft_visibility`.
        rays: of a pixel, for networks that filter them; 0 for none.

    Raises:
        InputError: a mesh cannot be read, or no camera and light can be used.
    """
    opened = SoftScene(scene, meshes)
    size = opened.at_rest.size
    shape = light_shape(frames.get("light"))
    radii = [shape.radius_of(radius, frames["radius_unit"], size) for radius in frames["radii"]]
    streams = streams_of(name, seed)
    shared = {key: frames[key] for key in ("width", "height", "fov", "of", "light_map")}
    kind = FrameKind(**shared, radius=max(radii), shape=shape)
    settings = draw(opened, kind, use, first, last, streams)
    twins = frames["twins"]["count"]
    perturbed = [
        [twin_of(opened, kind, setting, frames["twins"], rng) for _ in range(twins)]
        for number, setting in enumerate(settings, first)
        for rng in [np.random.default_rng((*streams, _TWINS, USES.index(use), number))]
    ]
    versions, image = 1 + twins, (kind.height, kind.width)
    count, title = len(settings), f"frames of {name}, {use}"
    with (
        new_array(buffers_npy, (count, versions, len(CHANNELS), *image), np.float16) as buffers,
        new_array(targets_npy, (count, len(radii), *image), np.float16) as targets,
        new_array(valid_npy, (count, versions, *image), np.bool_) as valid,
        new_array(edges_npy, (count, *image), np.bool_) as edges,
        new_array(rays_npy, (count, len(radii), 2 * (rays > 0), *image), np.float16) as traced,
        progress_bar(count, "frames", title) as bar,
    ):
        for number, setting in enumerate(settings):
            rendered = [
                render_buffers(opened, kind, version, setting.centre)
                for version in (setting, *perturbed[number])
            ]
            buffers[number], valid[number] = map(np.stack, zip(*rendered))
            targets[number], edges[number] = render_target(
                opened,
                kind,
                setting,
                radii=radii,
                samples=samples,
                blur=frames["blur"],
            )
            if rays:
                traced[number] = render_rays(opened, kind, setting, radii=radii, rays=rays)
            bar.update()
    settings_of_all = [
        {"setting": setting.as_json(), "twins": [twin.as_json() for twin in twin_settings]}
        for setting, twin_settings in zip(settings, perturbed)
    ]
    drawn = {"use": use, "first": first, "seed": seed, "samples": samples, "rays": rays}
    about = drawn | _describe(opened, kind, frames, radii) | {"frames": settings_of_all}
    write_json(frames_json, about | describe_origin())


def _describe(
    scene: SoftScene, kind: FrameKind, frames: FrameSettings, radii: Sequence[float]
) -> dict[str, Any]:
    """What all frames of a part share; radii: in metres."""
    return {
        "scene": scene.settings,
        "width": kind.width,
        "height": kind.height,
        "size": scene.at_rest.size,
        "radii": radii,
        "given_radii": frames["radii"],
        "radius_unit": frames["radius_unit"],
        "light_map": kind.light_map,
        "light": kind.shape.model_dump(),
        "blur": frames["blur"],
        "edges": True,
        "channels": CHANNELS,
        "units": UNITS,
    }


def streams_of(name: str, seed: int) -> tuple[int, int]:
    """Key of a scene's random streams, different for each scene.

    Args:
        name: of the scene in the configuration. seed: of the run.
    """
    return seed, crc32(name.encode())


def draw(
    scene: SoftScene, kind: FrameKind, use: str, first: int, last: int, streams: tuple[int, ...]
) -> list[Setting]:
    """Draw the settings of frames `first` to `last` (exclusive); all of a sequence.

    Args:
        streams: see `streams_of`.
    """
    stream = USES.index(use)
    if motion := motion_of(use):
        return draw_sequence(scene, kind, motion, last, np.random.default_rng((*streams, stream)))
    return [
        draw_setting(scene, kind, np.random.default_rng((*streams, stream, number)))
        for number in range(first, last)
    ]


if "snakemake" in globals():
    run_stage(snakemake, render_frames)
