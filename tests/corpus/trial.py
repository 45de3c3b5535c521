"""One input given to its reader, and what is to be said of it."""

import shutil
import tempfile
from collections import Counter
from pathlib import Path

from broken_files import Broken
from broken_meshes import ERROR, WORKS
from readers import OUT, READERS
from sandbox import Bounds, Outcome, Sandbox
from tabulate import tabulate

BOUNDS = Bounds()


class Trials:
    """Gives inputs to readers, and counts how they ended.

    Args:
        folder: for the files.
    """

    def __init__(self, folder: Path):
        self.counts: Counter[tuple[str, str, str]] = Counter()
        """By reader, kind of input, and end."""
        self._most: dict[Bounds, list[tuple[float, str]]] = {}
        self._folder = folder
        self._sandbox = Sandbox()
        self._whole: dict[str, Path] = {}

    def close(self) -> None:
        """End the readers' process."""
        self._sandbox.close()

    def fault(self, broken: Broken, bounds: Bounds = BOUNDS) -> str | None:
        """Let the input be read; what is wrong with how that ended, if anything."""
        reader = READERS[broken.reader]
        with tempfile.TemporaryDirectory(dir=self._folder) as name:
            folder = Path(name)
            shutil.copytree(self._whole_files(broken.reader), folder, dirs_exist_ok=True)
            path = folder / reader.file
            broken.put(path)
            before = _files(folder)
            outcome = self._sandbox.read(broken.reader, folder, bounds)
            made = _files(folder) - before
        self.counts[broken.reader, broken.kind, outcome.end] += 1
        label = f"{broken.reader}, {broken.kind}, {broken.name}"
        took = [(outcome.cpu_s, label), (outcome.mib, label)]
        self._most[bounds] = [max(pair) for pair in zip(self._most.get(bounds, took), took)]
        made -= {f"{file}.broken" for file in before | {reader.file}}
        problem = _problem(outcome, broken.end, before | {path.name, str(folder)}, made)
        return problem and f"{label}: {problem}"

    def table(self) -> str:
        """How many inputs of each kind ended how, and the same by reader."""
        parts = []
        for place, title in enumerate(("reader", "kind of input")):
            sums: dict[str, Counter[str]] = {}
            for key, count in self.counts.items():
                sums.setdefault(key[place], Counter())[key[2]] += count
            total = sum(sums.values(), Counter())
            ends = [WORKS, ERROR, *sorted(total.keys() - {WORKS, ERROR})]
            rows = [[name, *(found[end] for end in ends)] for name, found in sums.items()]
            rows.append(["together", *(total[end] for end in ends)])
            parts.append(tabulate(rows, [title, *ends], tablefmt="simple"))
        for bounds, (slowest, largest) in self._most.items():
            parts.append(
                f"Of {bounds.cpu_s} s and {bounds.mib} MiB allowed, at most {slowest[0]:.1f} s "
                f"({slowest[1]}) and {largest[0]:.0f} MiB ({largest[1]}) were taken."
            )
        return "\n\n".join(parts)

    def whole(self, reader: str) -> bytes:
        """A whole file of a reader's."""
        return (self._whole_files(reader) / READERS[reader].file).read_bytes()

    def _whole_files(self, reader: str) -> Path:
        if reader not in self._whole:
            self._whole[reader] = Path(tempfile.mkdtemp(dir=self._folder))
            READERS[reader].make(self._whole[reader])
        return self._whole[reader]


def _files(folder: Path) -> set[str]:
    return {str(path.relative_to(folder)) for path in folder.rglob("*") if not path.is_dir()}


def _problem(outcome: Outcome, end: str | None, names: set[str], made: set[str]) -> str | None:
    message = outcome.message
    took = f"{outcome.end}: {message[:300]} ({outcome.cpu_s:.1f} s, {outcome.mib:.0f} MiB)"
    if outcome.end == WORKS:
        made = {name for name in made if not name.startswith(f"{OUT}/")}
    elif outcome.end != ERROR:
        return took
    elif "\n" in message or "\r" in message:
        return f"more than a line: {message!r}"
    # Overlays are merged: a message names the key.
    elif not any(name in message for name in names | {"config: "}):
        return f"does not name the file: {message}"
    elif len(message) > 700:
        return f"{len(message)} characters: {message[:600]}"
    if made:
        return f"left {sorted(made)}"
    if end not in (None, outcome.end):
        return f"{end} expected; {took}"
    return None
