"""Whether LPIPS can be computed in this run, decided once for all evaluation jobs."""

import sys
from pathlib import Path

from neural_shadows.errors import InputError
from neural_shadows.files.whole_files import write_json
from neural_shadows.metrics.lpips_distance import Lpips


def find_lpips(out_json: Path, *, net: str, trunk: str | None) -> None:
    """Try LPIPS's pretrained trunk and write `net`, `trunk`, `available` and `reason`.

    A trunk that cannot be downloaded leaves LPIPS out, and the tables say why. A trunk that
    the config names must work.

    Raises:
        InputError: the config's own `trunk` cannot be used.
    """
    reason = None
    try:
        Lpips(net, Path(trunk) if trunk else None)
    except InputError as error:
        if trunk:
            raise
        reason = str(error)
        print(f"LPIPS is left out: {reason}", file=sys.stderr)
    write_json(
        out_json, {"net": net, "trunk": trunk, "available": reason is None, "reason": reason}
    )
