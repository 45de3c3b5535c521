"""Each shipped claim on data for and against it."""

import functools
import re
from itertools import product
from pathlib import Path

import numpy as np
import pandas as pd
import pytest
from checkout import ROOT
from claim_samples import loss_curve, measured, points, scene, views
from shipped import shipped

from neural_shadows.config.reading import read_config
from neural_shadows.config.resolved import resolved
from neural_shadows.layout import frame_methods
from neural_shadows.layout.layout import Layout
from neural_shadows.reports.claims.claim_kinds import kind_of, methods
from neural_shadows.reports.claims.gates import judge
from neural_shadows.reports.data.trained import THESIS_SAMPLES
from neural_shadows.reports.tables.screen_temporal import ENDINGS

# Folders of the run in which each table is once.
PARTS = ("spanhoff_2026", "extensions", "soft_shadows", "datta_2022", "hu_2025")


@functools.cache
def of_the_thesis(kind):
    """The thesis's claims of a kind; of others see whether they find their numbers."""
    shipped_claims = resolved(read_config(shipped()))["claims"].items()
    return {n: x for n, x in shipped_claims if x["text"] == "thesis" and x["kind"] == kind}


def data_of(claim, contrary):
    """Networks of the thesis's samples, with errors that double from a claim's winners on, or halve."""
    rank = dict.fromkeys((row["method"] for row in methods(claim)), 0)
    for _ in rank:
        for better, worse in claim["rows"]:
            rank[worse["method"]] = max(rank[worse["method"]], rank[better["method"]] + 1)
    rng, curves, losses, scenes = np.random.default_rng(3), {}, {}, {}
    for row in methods(claim):
        method = row["method"]
        level = 0.02 * 2.0 ** (max(rank.values()) - rank[method] if contrary else rank[method])
        if row["trained"]:
            curves[method] = points(method, [THESIS_SAMPLES], 3)
        runs = [point["experiment"] for point in curves.get(method, ())] or [method]
        errors = {run: level * np.exp(rng.normal(0, 0.003)) for run in runs}
        losses |= {run: loss_curve(error) for run, error in errors.items()}
        scenes.setdefault(row["scene"], {}).update({run: quality(e) for run, e in errors.items()})
    scenes = {name: scene(means, null=quality(0.9)) for name, means in scenes.items()}
    return measured(scenes, curves, losses=losses)


def quality(error):
    """Metrics of an error, spread by 1 % over views."""
    spread = error * (1 + 0.1 * (views(0.0, spread=0.0)))
    return {"lpips": spread, "psnr": -10 * np.log10(spread), "ssim": 1 - spread}


@pytest.mark.parametrize("name", of_the_thesis("better"))
@pytest.mark.parametrize(("contrary", "verdict"), [(False, "supported"), (True, "contradicted")])
def test_a_claim_has_the_verdict_that_its_data_carry(name, contrary, verdict):
    claim = of_the_thesis("better")[name]
    outcome = judge(claim, data_of(claim, contrary))
    assert outcome["verdict"] == verdict, outcome["reason"]


def test_the_thesis_s_tables_carry_its_text_but_on_widths():
    verdict_of = {
        name: judge(claim, measured())["verdict"]
        for name, claim in of_the_thesis("printed").items()
    }
    assert {name: verdict for name, verdict in verdict_of.items() if verdict != "supported"} == {
        "printed_wider_is_worse_on_the_landscape": "contradicted",
    }
    assert len(verdict_of) == 5


@functools.cache
def with_all_seeds():
    """A configuration with all seeds of screen-space networks."""
    return read_config(shipped("nsm_seeds", "kpnsm_seeds", "nsm_scenes"))


@functools.cache
def of_all_seeds():
    """Its layout."""
    return Layout(resolved(with_all_seeds()))


def test_statements_stand_alone():
    """A reader of the page meets each by itself."""
    of_another = re.compile(r"(?:It|Its|So|They|Their|Both its)\b|.*\bthat level\b")
    claims = of_all_seeds().settings["claims"].items()
    assert [name for name, claim in claims if of_another.match(claim["statement"])] == []


def on_tables():
    on_frames = of_all_seeds().settings["claims"].items()
    return {name: claim for name, claim in on_frames if claim["kind"] in ("ratio", "proportional")}


def labels_of(table):
    shown = dict.fromkeys(with_all_seeds().tables[table].methods_shown())
    return [frame_methods.label(of_all_seeds(), method) for method in shown]


def with_taa(labels):
    return [f"{label}{taa}" for label in labels for taa in ENDINGS.values()]


def numbers_of(name):
    """A table by its settings or by a reference."""
    layout = of_all_seeds()
    table = layout.entry("tables", name)
    reference = ROOT / "reports" / "reference"
    paths = (reference / part / f"{name}.csv" for part in PARTS)
    path = next(filter(Path.exists, paths), reference)
    match table["kind"]:
        case "screen_steps":
            return pd.DataFrame({"row": [*table["steps"]]}).assign(
                **dict.fromkeys(("runtime", "size", "error", "error_off_edges"), 1.0)
            )
        case "screen_temporal":
            columns = dict.fromkeys(pd.read_csv(path), 1.0)
            return pd.DataFrame(columns | {"null": np.nan, "label": with_taa(labels_of(name))})
        case "screen_errors" if path == reference:
            frames = layout.entry("frame_sets", table["frame_set"])
            lights = [*range(len(frames["radii"])), "all"]
            rows = product(labels_of(name), frames["scenes"], lights)
            return pd.DataFrame(rows, columns=["label", "frames", "light"]).assign(
                mse=1.0, mse_off_edges=1.0
            )
    return pd.read_csv(path)


@pytest.mark.parametrize("name", on_tables())
def test_a_claim_finds_each_of_its_rows_and_columns(name):
    claim = on_tables()[name] | {"needs": {}, "again": {}}
    names = {of_table["table"] for of_table in claim.get("ratios", [claim])}
    tables = {table: numbers_of(table).assign(of_printed_size=True) for table in names}
    comparisons = kind_of(claim).comparisons(claim, measured(tables=tables))
    assert [each.text for each in comparisons if not each.number] == []


def names_in(table):
    """Possible names of a table's rows, by the configuration."""
    layout = of_all_seeds()
    settings = layout.entry("tables", table)
    scenes = layout.entry("frame_sets", settings["frame_set"])["scenes"]
    return {
        *(*settings.get("steps", ()), *settings.get("columns", ()), *with_taa(labels_of(table))),
        *(scene.replace("plate_", "penumbra_") for scene in scenes),
    }


@pytest.mark.parametrize(
    "name", [name for name, claim in on_tables().items() if claim.get("again")]
)
def test_a_claim_finds_its_rows_in_tables_of_other_seeds(name):
    claim = on_tables()[name]
    for ratio in claim["ratios"]:
        over = ratio["to"] if isinstance(ratio["to"], list) else [ratio["to"]]
        rows = [row for row in (ratio["of"], *over) if isinstance(row, dict)]
        keys = ("row", "column", "label")
        named = {row[key] for row in rows for key in keys if key in row}
        for table in (ratio["table"], *claim["again"][ratio["table"]]):
            assert named <= names_in(table)
