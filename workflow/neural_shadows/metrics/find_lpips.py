"""Stage: LPIPS's availability in a run, for all evaluation jobs."""

import socket
import sys
from pathlib import Path

from neural_shadows.files.whole_files import write_json
from neural_shadows.metrics.kinds.lpips import make_lpips
from neural_shadows.networks.pretrained_trunk import MODELS, Net
from neural_shadows.running.stage import run_stage


def find_lpips(trunk: Path | None, lpips_json: Path, *, net: Net) -> None:
    """Try LPIPS's pretrained backbone and write its availability.

    Keys: `net`, `trunk`, `available` and `reason`. A backbone that cannot be downloaded leaves
    LPIPS out, with a reason in the tables. A configured one must work.

    Raises:
        InputError: the config's own `trunk` cannot be used.
    """
    reason = None
    socket.setdefaulttimeout(60)  # torch.hub has no timeout of its own
    try:
        make_lpips(net, trunk)
    except (OSError, RuntimeError) as error:
        # Without the path of the cache in a home directory: reports show the reason.
        cause = getattr(error, "reason", None) or getattr(error, "strerror", None) or error
        reason = (
            f"torchvision's weights of {MODELS[net]} cannot be downloaded ({cause}). Set the config "
            f"key metrics.lpips.trunk to a local copy."
        )
        print(f"LPIPS is left out: {reason}", file=sys.stderr)
    settings = {"net": net, "trunk": str(trunk) if trunk else None}
    write_json(lpips_json, {**settings, "available": reason is None, "reason": reason})


if "snakemake" in globals():
    run_stage(snakemake, find_lpips)
