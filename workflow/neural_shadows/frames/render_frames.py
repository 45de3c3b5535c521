"""The stage that draws and renders a part of a frame set: one scene's frames of one use."""

from collections.abc import Mapping
from concurrent.futures import ThreadPoolExecutor
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
from neural_shadows.frames.render_frame import render_buffers, render_target
from neural_shadows.frames.setting import Setting
from neural_shadows.frames.soft_scene import SoftScene
from neural_shadows.frames.uses import SEQUENCES, USES
from neural_shadows.running.origin import describe_origin
from neural_shadows.running.progress import progress_bar
from neural_shadows.running.stage import run_stage

_TWINS = len(USES)  # of the twins, another


def render_frames(
    meshes: list[Path],
    frames_json: Path,
    buffers_npy: Path,
    targets_npy: Path,
    valid_npy: Path,
    edges_npy: Path,
    *,
    scene: Mapping[str, Any],
    name: str,
    seed: int,
    frames: Mapping[str, Any],
    use: str,
    first: int,
    last: int,
    samples: int,
    twins: int = 0,
    threads: int = 1,
) -> None:
    """Render frames `first` to `last` (exclusive) of a scene, see `FrameSetPart`.

    Its camera and light depend on the seed, its scene's name, its use and its number alone: scenes of
    one layout have settings of their own, and frame sets that share a scene share its settings.

    Args:
        meshes: prepared, of the objects that are inserted.
        scene: see `SoftScene`. name: its, in the configuration.
        seed: of the run; the scene's layout has its own.
        frames: `width`, `height`, `fov`, `of`, `light_map`, `radii` and `radius_unit`, `blur`, and
            `twins`, the amplitudes of `twin_of`.
        use: `train`, `validation`, `test`, or what moves in a sequence.
        samples: see `soft_visibility`.
        twins: of each frame.

    Raises:
        InputError: a mesh cannot be read, or there is no camera and light that can be used.
    """
    opened = SoftScene(scene, meshes)
    size = opened.at_rest.size
    unit = {"metres": 1.0, "scene_sizes": size}[frames["radius_unit"]]
    radii = [unit * radius for radius in frames["radii"]]
    streams = streams_of(name, seed)
    shared = {key: frames[key] for key in ("width", "height", "fov", "of", "light_map")}
    kind = FrameKind(**shared, radius=max(radii))
    settings = draw(opened, kind, use, first, last, streams)
    changed = [
        [twin_of(opened, kind, one, frames["twins"], rng) for _ in range(twins)]
        for number, one in enumerate(settings, first)
        for rng in [np.random.default_rng((*streams, _TWINS, USES.index(use), number))]
    ]
    versions, image = 1 + twins, (kind.height, kind.width)
    count, title = len(settings), f"frames of {name}, {use}"
    with (
        new_array(buffers_npy, (count, versions, len(CHANNELS), *image), np.float16) as buffers,
        new_array(targets_npy, (count, len(radii), *image), np.float16) as targets,
        new_array(valid_npy, (count, versions, *image), np.bool_) as valid,
        new_array(edges_npy, (count, *image), np.bool_) as edges,
        ThreadPoolExecutor(threads) as pool,
        progress_bar(count, "frames", title) as bar,
    ):
        for number, setting in enumerate(settings):
            found = pool.map(
                lambda one, aimed_from=setting.centre: render_buffers(
                    opened, kind, one, aimed_from
                ),
                [setting, *changed[number]],
            )
            buffers[number], valid[number] = map(np.stack, zip(*found))
            targets[number], edges[number] = render_target(
                opened,
                kind,
                setting,
                radii=radii,
                samples=samples,
                blur=frames["blur"],
                pool=pool,
            )
            bar.update()
    described = [
        {"setting": one.as_json(), "twins": [twin.as_json() for twin in its]}
        for one, its in zip(settings, changed)
    ]
    about = {"use": use, "first": first, "seed": seed, "scene": opened.settings}
    about |= {"width": kind.width, "height": kind.height, "size": size, "radii": radii}
    about |= {"given_radii": frames["radii"], "radius_unit": frames["radius_unit"]}
    about |= {"samples": samples, "blur": frames["blur"], "edges": True}
    about |= {
        "light_map": kind.light_map,
        "channels": CHANNELS,
        "units": UNITS,
        "frames": described,
        **describe_origin(),
    }
    write_json(frames_json, about)


def streams_of(name: str, seed: int) -> tuple[int, int]:
    """What a scene's random streams begin with: no two scenes of a run have the same.

    Args:
        name: of the scene in the configuration. seed: of the run.
    """
    return seed, crc32(name.encode())


def draw(
    scene: SoftScene, kind: FrameKind, use: str, first: int, last: int, streams: tuple[int, ...]
) -> list[Setting]:
    """The settings of frames `first` to `last` (exclusive), of a sequence all.

    Args:
        streams: see `streams_of`.
    """
    stream = USES.index(use)
    if use in SEQUENCES:
        return draw_sequence(scene, kind, use, last, np.random.default_rng((*streams, stream)))
    return [
        draw_setting(scene, kind, np.random.default_rng((*streams, stream, number)))
        for number in range(first, last)
    ]


if "snakemake" in globals():
    run_stage(snakemake, render_frames)
