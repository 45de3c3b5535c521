"""Jobs that ended without a word: killed, out of memory, past their time, or crashed."""

import re
import sys
from pathlib import Path

from neural_shadows.jobs import RUN_ALONE, last_lines

# A job that comes to its end, good or bad, leaves its record, a line of JSON.
_RECORD = re.compile(r"^\{", re.MULTILINE)


def tell_of_killed_jobs(logs: Path, since: float) -> None:
    """Say on stderr how the logs of a run's killed jobs end, and what runs each alone.

    Args:
        logs: the folder that has a folder for each rule.
        since: when the run began, in seconds of `time.time`.
    """
    for path in sorted(logs.glob("*/*.log")):
        if path.stat().st_mtime < since:
            continue
        with path.open(encoding="utf-8", errors="replace") as file:
            alone = file.readline().strip()
        said = last_lines(path)
        if not alone.startswith(RUN_ALONE) or _RECORD.search("\n".join(said)):
            continue
        if said[-1:] == ["KeyboardInterrupt"]:  # they know
            continue
        print(
            f"{path.parent.name}: ended without a word: killed (out of memory, past its time, or "
            f"by somebody), or crashed [log: {path}]",
            *(f"  | {line}" for line in said),
            f"  {alone}",
            sep="\n",
            file=sys.stderr,
        )
