"""Jobs that ended without a word: killed, out of memory, past their time, or crashed."""

import re
import sys
from pathlib import Path

from neural_shadows.running.jobs import RUN_ALONE, last_lines

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
        # All of it: with many inputs a record is longer than what is shown of a log.
        text = path.read_text(encoding="utf-8", errors="replace")
        if not text.startswith(RUN_ALONE) or _RECORD.search(text):
            continue
        alone, said = text.splitlines()[0], last_lines(path)
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
