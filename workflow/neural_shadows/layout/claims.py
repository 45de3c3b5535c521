"""What the thesis's claims are tested on."""

from collections.abc import Iterator, Mapping
from typing import Any

from neural_shadows.layout import tables
from neural_shadows.layout.layout import Layout


def files(layout: Layout) -> dict[str, list[str]]:
    """The files of all methods that claims compare: metrics, losses or frame times."""
    found = {"metrics": [], "losses": [], "times": []}
    for claim in layout.settings["claims"].values():
        rows = list(methods(claim))
        match claim["kind"]:
            case "better" | "larger_error":
                found["metrics"] += tables.metrics(layout, rows)
            case "lower_loss":
                found["losses"] += tables.networks(layout, rows, "loss.csv")
            case "frame_time":
                scenes = [row["scene"] for row in rows]
                found["times"] += [layout.paths.frame_times(claim["table"], s) for s in scenes]
    return {name: tables.unique(paths) for name, paths in found.items()}


def methods(claim: Mapping[str, Any]) -> Iterator[Mapping[str, Any]]:
    """The methods of a claim, as rows."""
    yield from claim.get("methods", ())
    for pair in claim.get("pairs", ()):
        yield from pair


def arguments(layout: Layout) -> dict[str, Any]:
    """What `write_claims` is told beside its files."""
    rows = [row for claim in layout.settings["claims"].values() for row in methods(claim)]
    names = tables.experiments_of(rows)
    trainings = [layout.entry("experiments", name)["training"] for name in names]
    return {
        "claims": layout.settings["claims"],
        "run": layout.run(),
        "samples": max((t["steps"] * t["batch_size"] for t in trainings), default=0),
        "scenes": layout.scenes(row["scene"] for row in rows),
    }
