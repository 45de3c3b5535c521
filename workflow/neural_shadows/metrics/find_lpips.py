"""Whether LPIPS can be computed in this run, decided once for all evaluation jobs."""

import sys
from pathlib import Path

from neural_shadows.errors import InputError
from neural_shadows.files.whole_files import write_json
from neural_shadows.metrics.lpips_distance import Lpips


def find_lpips(trunk: Path | None, lpips_json: Path, *, net: str) -> None:
    """Try LPIPS's pretrained trunk and write `net`, `trunk`, `available` and `reason`.

    A trunk that cannot be downloaded leaves LPIPS out, and the tables say why. A trunk that
    the config names must work.

    Raises:
        InputError: the config's own `trunk` cannot be used.
    """
    reason = None
    try:
        Lpips(net, trunk)
    except InputError as error:
        if trunk:
            raise
        reason = str(error)
        print(f"LPIPS is left out: {reason}", file=sys.stderr)
    write_json(
        lpips_json, {"net": net, "trunk": str(trunk) if trunk else None, "available": reason is None, "reason": reason}
    )
