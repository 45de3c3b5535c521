"""What the thesis's claims are tested on."""

from collections.abc import Iterator, Mapping
from typing import Any

from neural_shadows.evaluation.soft_method_names import UNLEARNED
from neural_shadows.layout import soft_methods, tables
from neural_shadows.layout.layout import Layout
from neural_shadows.reports.claims.measured import WITHOUT_ROWS, networks_of_frames


def files(layout: Layout) -> dict[str, Any]:
    """The files of all methods that claims compare, and of all trainings of their networks.

    Methods that are compared in their pictures are so with no shadow, too.
    """
    found = {name: [] for name in ("metrics", "losses", "trainings", "times", "meshes")}
    for claim in layout.settings["claims"].values():
        rows = list(methods(claim))
        scenes = tables.unique(row["scene"] for row in rows)
        match claim["kind"]:
            case "better" | "violations":
                rows = tables.with_curves(layout, rows)
                found["metrics"] += tables.metrics(layout, [*rows, *tables.unshadowed(scenes)])
            case "lower_loss":
                rows = tables.with_curves(layout, rows)
                found["losses"] += tables.networks(layout, rows, "loss.csv")
            case "frame_time":
                found["times"] += [layout.paths.frame_times(claim["table"], s) for s in scenes]
        found["trainings"] += tables.networks(layout, rows, "training.json")
        found["meshes"] += [layout.paths.scene("mesh.json", scene) for scene in scenes]
    found = {name: tables.unique(paths) for name, paths in found.items()}
    tables_of = soft_tables(layout)
    soft = [soft_methods.evaluations(layout, table, "csv") for table in tables_of]
    soft += [_other_seeds(layout, claim) for claim in layout.settings["claims"].values()]
    soft += [_unlearned(layout, claim) for claim in layout.settings["claims"].values()]
    found["soft_metrics"] = tables.unique(path for paths in soft for path in paths)
    found["soft_times"] = [
        path for table in tables_of for path in soft_methods.times(layout, table)
    ]
    found["tables"] = [layout.paths.report(f"{table}.csv") for table in tables_of_numbers(layout)]
    claimed = layout.settings["claims"].values()
    networks = tables.unique(name for claim in claimed for name in networks_of_frames(claim))
    found["screen_trainings"] = [
        layout.paths.screen_network("training.json", name) for name in networks
    ]
    return found | {"published_csv": layout.source("config/published.csv")}


def counts_violations(layout: Layout, method: str) -> bool:
    """Whether a claim is about how often a method's depths break their bounds."""
    for claim in layout.settings["claims"].values():
        if claim["kind"] == "violations":
            rows = tables.with_curves(layout, list(methods(claim)))
            if method in (row["method"] for row in rows):
                return True
    return False


def methods(claim: Mapping[str, Any]) -> Iterator[Mapping[str, Any]]:
    """The methods of a claim, as rows; none of `WITHOUT_ROWS`."""
    if claim["kind"] in WITHOUT_ROWS:
        return
    yield from claim.get("methods", ())
    for pair in claim.get("pairs", ()):
        yield from pair


def _other_seeds(layout: Layout, claim: Mapping[str, Any]) -> list[str]:
    """What was measured of the networks that are those of a claim, trained from other seeds."""
    if not claim["kind"].startswith("soft_"):
        return []
    frame_set = soft_methods.frame_set(layout, claim["table"])
    names = [name for others in claim["again"].values() for name in others]
    return [layout.paths.soft_evaluation("csv", frame_set, name) for name in names]


def _unlearned(layout: Layout, claim: Mapping[str, Any]) -> list[str]:
    """What was measured of that which learns nothing, on the frames of a claim on networks."""
    if not claim["kind"].startswith("soft_") or not claim["networks"]:
        return []
    frame_set = soft_methods.frame_set(layout, claim["table"])
    names = [*UNLEARNED, *claim["bases"].values()]
    return [layout.paths.soft_evaluation("csv", frame_set, name) for name in names]


def soft_tables(layout: Layout) -> list[str]:
    """The tables of methods for soft shadows that claims are about."""
    claims = layout.settings["claims"].values()
    return tables.unique(one["table"] for one in claims if one["kind"].startswith("soft_"))


def tables_of_numbers(layout: Layout) -> list[str]:
    """The tables whose numbers claims compare."""
    claims = layout.settings["claims"].values()
    asked = [one["table"] for one in claims if one["kind"] == "proportional"]
    claims = [one for one in claims if one["kind"] == "ratio"]
    asked += [ratio["table"] for one in claims for ratio in one["ratios"]]
    again = [table for one in claims for others in one["again"].values() for table in others]
    return tables.unique([*asked, *again])


def arguments(layout: Layout) -> dict[str, Any]:
    """What `write_claims` is told beside its files."""
    rows = [row for claim in layout.settings["claims"].values() for row in methods(claim)]
    return {
        "claims": layout.settings["claims"],
        "learning_curves": tables.curves(layout, rows),
        "soft_tables": {
            table: {
                "frame_set": soft_methods.frame_set(layout, table),
                "labels": soft_methods.labels(layout, table),
                "scenes": soft_methods.shown_scenes(layout, table),
                "radii": soft_methods.radii(layout, table),
            }
            for table in soft_tables(layout)
        },
        "run": layout.run(),
        "scenes": layout.scenes(row["scene"] for row in rows),
    }
