"""The stage that finds the depth bias with which a network errs least, on views no table shows.

Shadow maps have one for the same reason: a depth that is a little short puts lit points in the
shadow of the very surface they lie on.
"""

from pathlib import Path

from neural_shadows.running.stage import run_stage


def find_depth_bias(
    references: Path,
    weights: Path,
    found_json: Path,
    *,
    device: str = "auto",
    precision: str = "auto",
) -> None:
    """Write the bias of `BIASES` with the least shadow error over a batch, and all errors.

    Args:
        references: what `render_references` wrote of views that no evaluation uses.

    Raises:
        InputError: an input file cannot be read.
    """


if "snakemake" in globals():
    run_stage(snakemake, find_depth_bias)
