"""Tables of learning curves, and claims, of what `gpu.py` has done so far.

    python tests/benchmarks/gpu_report.py DIR [--overlay config/lab.yaml]

Reads DIR/results and writes DIR/reports, as the pipeline would: each row whose curve is whole, and
each claim all of whose files are there. Those about maps, times and violations need the pipeline's
own run.
"""

import argparse
import os
from collections.abc import Sequence
from pathlib import Path
from typing import Any

from gpu import ROOT, settings_of

from neural_shadows.files.whole_files import read_json
from neural_shadows.layout import claims, tables
from neural_shadows.layout.layout import Layout
from neural_shadows.reports.claims.write_claims import write_claims
from neural_shadows.reports.tables.learning_curves import write


def main(arguments: Sequence[str] | None = None) -> None:
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("out", type=Path, metavar="DIR", help="what gpu.py was given as --out")
    parser.add_argument("--overlay", type=Path, default=ROOT / "config" / "lab.yaml")
    given = parser.parse_args(arguments)
    settings = settings_of(given.overlay.resolve(), Path("stanford"))
    os.chdir(given.out)  # where the layout's files lie
    for path in reports(settings):
        print(path)


def reports(settings: dict[str, Any]) -> list[str]:
    """Write what can be made of the files below the working directory; gives what was written."""
    views = read_json("settings.json")["views"]
    rendering = settings["rendering"] | {"views_per_set": views, "batch": views}
    settings = settings | {"rendering": rendering}
    layout = Layout(settings, str(ROOT))
    done = {
        name: points
        for name, points in settings["learning_curves"].items()
        if all(
            Path(layout.paths.network("training.json", p["experiment"])).exists() for p in points
        )
    }
    chosen = settings | {"learning_curves": done, "tables": {}, "claims": {}}
    for name, table in settings["tables"].items():
        rows = [row for row in table["rows"] if row["experiment"] in done]
        if table["kind"] == "learning_curves" and rows:
            chosen["tables"][name] = table | {"rows": rows, "figures": []}
    for name, claim in settings["claims"].items():
        found = claims.files(Layout(settings | {"claims": {name: claim}}, str(ROOT)))
        there = all(Path(path).exists() for paths in found.values() for path in _listed(paths))
        if there and claim["kind"] != "violations":
            chosen["claims"][name] = claim
    layout, written = Layout(chosen, str(ROOT)), []
    for name in chosen["tables"]:
        outputs = _outputs(layout, name)
        write(**_given(tables.files(layout, name)), **tables.arguments(layout, name), **outputs)
        written += outputs.values()
    if chosen["claims"]:
        outputs = _outputs(layout, "claims")
        write_claims(**_given(claims.files(layout)), **claims.arguments(layout), **outputs)
        written += outputs.values()
    return [str(path) for path in written]


def _listed(paths: str | Sequence[str]) -> Sequence[str]:
    return [paths] if isinstance(paths, str) else paths


def _given(files: dict[str, Any]) -> dict[str, Any]:
    """A layout's files as a stage takes them."""
    return {
        name: Path(paths) if isinstance(paths, str) else [Path(path) for path in paths]
        for name, paths in files.items()
        if name != "beside"
    }


def _outputs(layout: Layout, name: str) -> dict[str, Path]:
    """The files of a table, or of the claims."""
    return {ending: Path(layout.paths.report(f"{name}.{ending}")) for ending in ("csv", "md")}


if __name__ == "__main__":
    main()
