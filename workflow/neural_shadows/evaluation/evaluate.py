"""The stage that measures one method against the reference on a batch of viewpoints [4.1]."""

from collections.abc import Mapping
from pathlib import Path
from typing import Any

from neural_shadows.running.stage import run_stage


def evaluate(
    references: Path,
    mesh_ply: Path,
    weights: Path | None,
    depth_bias_json: Path | None,
    lpips_json: Path,
    metrics_csv: Path,
    pictures_npz: Path,
    *,
    method: str,
    scene: Mapping[str, Any],
    bias: float | str | None = None,
    device: str = "auto",
    precision: str = "auto",
    threads: int = 1,
) -> None:
    """Shade the batch's frames by one method, and measure them.

    Writes tidy metrics (a row per view and metric) and, for people to look at, the picture of
    each view set's first frame, see `FirstFrames`.

    Args:
        references: what `render_references` wrote.
        weights: of a network; None for `shadow_map_N`.
        depth_bias_json: what `find_depth_bias` wrote, where `bias` is `held_out`.
        lpips_json: what `find_lpips` wrote.
        method: the method's key, `shadow_map_N` or the name that a network goes by.
        scene: `up`, `ground` and `light`, see `open_scene`.
        bias: of a network's depth test, in sphere radii, or `held_out`.

    Raises:
        InputError: an input file cannot be read.
    """


if "snakemake" in globals():
    run_stage(snakemake, evaluate)
