"""The stage that times a frame by each way of shadowing it, on one machine [4.4.1]."""

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

from neural_shadows.running.stage import run_stage


def measure_frame_times(
    mesh_ply: Path,
    weights: list[Path],
    times_json: Path,
    *,
    methods: Sequence[str],
    scene: Mapping[str, Any],
    frames: Mapping[str, Any],
    frame_times: Mapping[str, int],
    device: str = "auto",
    precision: str = "auto",
) -> None:
    """Time frames of a scene by each method: rays, whole shadow maps, networks [4.4.1].

    The frames are the first of the scene's evaluation viewpoints. CPU work has one thread,
    whatever the method, so that times compare; networks run on a GPU where there is one.

    Args:
        weights: of the networks, in the folder of their experiment each.
        times_json: named for the scene.
        methods: keys, `ray_traced`, `shadow_map_N` and of networks. A depth bias, one addition,
            is left out.
        scene: `up`, `ground` and `light`, see `open_scene`.
        frames: `view_sets` and `seed` of the evaluation's frames; they have another size.
        frame_times: `width`, `height` (pixels) and `repeats`, timed frames of each method.

    Raises:
        InputError: an input file cannot be read, or a setting does not fit the scene.
    """


if "snakemake" in globals():
    run_stage(snakemake, measure_frame_times)
