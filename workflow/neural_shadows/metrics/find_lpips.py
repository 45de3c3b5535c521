"""The stage that finds out whether LPIPS can be computed in this run, for all evaluation jobs."""

import socket
import sys
from pathlib import Path

from neural_shadows.files.whole_files import write_json
from neural_shadows.metrics.lpips_distance import make_lpips
from neural_shadows.networks.pretrained_trunk import MODELS, Net
from neural_shadows.running.stage import run_stage


def find_lpips(trunk: Path | None, lpips_json: Path, *, net: Net) -> None:
    """Try LPIPS's pretrained trunk and write `net`, `trunk`, `available` and `reason`.

    A trunk that cannot be downloaded leaves LPIPS out, and the tables say why. One that the
    config names must work.

    Raises:
        InputError: the config's own `trunk` cannot be used.
    """
    reason = None
    socket.setdefaulttimeout(60)  # torch.hub would wait for an answer for ever
    try:
        make_lpips(net, trunk)
    except (OSError, RuntimeError) as error:
        # Reports show it, and the cache's folder is in somebody's home.
        why = getattr(error, "reason", None) or getattr(error, "strerror", None) or error
        reason = (
            f"torchvision's weights of {MODELS[net]} cannot be downloaded ({why}); set the config "
            f"key metrics.lpips.trunk to a local copy"
        )
        print(f"LPIPS is left out: {reason}", file=sys.stderr)
    found = {"net": net, "trunk": str(trunk) if trunk else None}
    write_json(lpips_json, {**found, "available": reason is None, "reason": reason})


if "snakemake" in globals():
    run_stage(snakemake, find_lpips)
