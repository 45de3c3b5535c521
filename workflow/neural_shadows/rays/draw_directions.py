"""Stage: draw the view directions of a ray set [3.4.1]."""

from collections.abc import Mapping
from pathlib import Path
from typing import Any

from neural_shadows.files.whole_files import write_array
from neural_shadows.rays.directions import view_directions
from neural_shadows.running.stage import run_stage


def draw_directions(
    *,
    directions_npy: Path,
    sampling: Mapping[str, Any],
    seed: int,
    light: Mapping[str, Any] | None = None,
    up: str = "y",
) -> None:
    """Draw the view directions of a ray set and write `directions.npy`, (D, 3) float32.

    Args:
        sampling: its `sampler` and its number of `directions` are used.
        light: the light domain to draw from, d = −l, where a network is to be trained for that
            light alone [4.1.1]; None for the whole sphere.
        up: the axis that `light` stands on.

    Raises:
        InputError: an unknown sampler, or a wrong light domain.
    """
    directions = view_directions(
        sampling["sampler"], sampling["directions"], seed, light=light, up=up
    )
    write_array(directions_npy, directions)


if "snakemake" in globals():
    run_stage(snakemake, draw_directions)
