"""Each shipped claim on data for and against it."""

import functools
from itertools import product

import numpy as np
import pandas as pd
import pytest
from checkout import ROOT
from claim_samples import loss_curve, measured, points, scene, views, violated
from shipped import shipped

from neural_shadows.config.reading import read_config
from neural_shadows.config.resolved import resolved
from neural_shadows.layout import soft_methods
from neural_shadows.layout.layout import Layout
from neural_shadows.reports.claims.claim_kinds import compared, kind_of, methods
from neural_shadows.reports.claims.gates import judge
from neural_shadows.reports.data.trained import THESIS_SAMPLES

BUDGETS = np.array([1 / 27, 1 / 9, 1 / 3, 1])  # of the largest
REFERENCE = ROOT / "reports" / "reference"
FALL = 0.1  # exponent of all networks' errors


@functools.cache
def claims():
    """The thesis's claims.

    Of those of other texts see the kinds in test_claims_soft and _ratio, and below whether they find
    their numbers.
    """
    shipped_claims = resolved(read_config(shipped()))["claims"]
    return {name: claim for name, claim in shipped_claims.items() if claim["text"] == "thesis"}


def ranks(claim):
    """Ranks by method, 0 of claimed winners."""
    rank = {row["method"]: 0 for row in methods(claim)}
    for _ in rank:
        for better, worse in compared(claim):
            rank[worse["method"]] = max(rank[worse["method"]], rank[better["method"]] + 1)
    return rank


def errors_of(claim, share, contrary):
    """Learning curves, and errors that double from rank to rank."""
    order = ranks(claim)
    last_rank, rng = max(order.values()), np.random.default_rng(3)
    curves, errors = {}, {}
    for row in methods(claim):
        method = row["method"]
        level = 0.02 * 2.0 ** (last_rank - order[method] if contrary else order[method])
        if not row["trained"]:
            errors[method] = level
            continue
        samples = [int(part * share * THESIS_SAMPLES) for part in BUDGETS]
        curves[method] = points(method, samples, 3)
        for point in curves[method]:
            fall = (point["samples"] / samples[-1]) ** -FALL
            errors[point["experiment"]] = level * fall * np.exp(rng.normal(0, 0.003))
    return curves, errors


def data_of(claim, share, contrary):
    """Values for a claim, or contrary ones, by samples."""
    match claim["kind"]:
        case "printed":
            return measured()
        case "frame_time":
            return measured(times=times_of(claim, contrary))
        case "violations":
            curves = {
                row["method"]: points(row["method"], [share * THESIS_SAMPLES], 3)
                for row in methods(claim)
            }
            errors = dict.fromkeys(runs_of(curves), 0.1)
            counts = violated(10, 30) if contrary else violated(40, 15)
            return measured(scenes_of(claim, curves, errors, counts), curves)
    curves, errors = errors_of(claim, share, contrary)
    if claim["kind"] == "lower_loss":
        losses = {run: loss_curve(error) for run, error in errors.items()}
        return measured(curves=curves, losses=losses)
    return measured(scenes_of(claim, curves, errors), curves)


def runs_of(curves):
    return [point["experiment"] for curve in curves.values() for point in curve]


def scenes_of(claim, curves, errors, counts=()):
    """Metrics by scene of all runs of a claim's methods."""
    scenes = {}
    for row in methods(claim):
        runs = [point["experiment"] for point in curves.get(row["method"], ())] or [row["method"]]
        means = {run: quality(errors[run]) | dict(counts) for run in runs}
        scenes[row["scene"]] = scenes.get(row["scene"], {}) | means
    return {name: scene(means, null=quality(0.9)) for name, means in scenes.items()}


def times_of(claim, contrary):
    """Own times a factor of three from a claim's bound."""
    far = 3.0 if (claim["at_least"] is None) == contrary else 1 / 3
    own = {}
    for first, second in claim["pairs"]:
        times = own.setdefault(first["scene"], {})
        times.setdefault(second["method"], 100.0)
        bound = claim["at_least"] or claim["at_most"]
        times[first["method"]] = times[second["method"]] * far * bound
    return {
        ("table_4_6", name): {
            "methods": {
                method: {"own_ms": [ms] * 15, "ms": [ms] * 15, "device": "cuda"}
                for method, ms in times.items()
            }
        }
        for name, times in own.items()
    }


def quality(error):
    """Metrics of an error, spread by 1 % over views."""
    spread = error * (1 + 0.1 * (views(0.0, spread=0.0)))
    return {"lpips": spread, "psnr": -10 * np.log10(spread), "ssim": 1 - spread}


def expected(claim, share, contrary):
    """The verdict of a claim."""
    if claim["kind"] == "printed":
        # The text on widths is contrary to its own table.
        return "contradicted" if "width" in claim["statement"] else "supported"
    if claim["kind"] == "frame_time":
        return "contradicted" if contrary else "supported"
    if contrary:
        return "undecided (scale)" if share < 1 / 30 else "contradicted"
    if share > 1 / 30 or not claim["needs"]["budget"]:
        return "supported"
    network_wins = claim["kind"] != "better" or any(row["trained"] for row, _ in claim["pairs"])
    return "undecided (scale)" if network_wins else "vacuous"


@pytest.mark.parametrize("name", claims())
@pytest.mark.parametrize(
    ("share", "contrary"), [(0.0003, False), (0.05, False), (1, False), (0.02, True), (0.05, True)]
)
def test_a_claim_has_the_verdict_that_its_data_carry(name, share, contrary):
    claim = claims()[name]
    outcome = judge(claim, data_of(claim, share, contrary))
    assert outcome["verdict"] == expected(claim, share, contrary), outcome["reason"]
    # At a twentieth what needs all samples is decided by an extrapolation, and by that alone.
    carried = share == 0.05 and claim.get("needs", {}).get("budget") is not None
    assert ("extrapolated" in outcome["reason"]) == carried


@functools.cache
def with_all_seeds():
    """A configuration with all seeds of screen-space networks."""
    return read_config(shipped("nsm_seeds", "kpnsm_seeds", "nsm_scenes"))


@functools.cache
def of_all_seeds():
    """Its layout."""
    return Layout(resolved(with_all_seeds()))


def on_tables():
    on_frames = of_all_seeds().settings["claims"].items()
    return {name: claim for name, claim in on_frames if claim["kind"] in ("ratio", "proportional")}


def labels_of(table):
    shown = dict.fromkeys(with_all_seeds().tables[table].methods_shown())
    return [soft_methods.label(of_all_seeds(), method) for method in shown]


def with_taa(labels):
    return [f"{label}{taa}" for label in labels for taa in ("", " + TAA")]


def numbers_of(name):
    """A table by its settings or by a reference."""
    layout = of_all_seeds()
    table = layout.entry("tables", name)
    paths = [path for where in ("*", "earlier/*") for path in REFERENCE.glob(f"{where}/{name}.csv")]
    match table["kind"]:
        case "screen_steps":
            return pd.DataFrame({"row": [*table["steps"]]}).assign(
                **dict.fromkeys(("runtime", "size", "error", "error_off_edges"), 1.0)
            )
        case "screen_temporal":
            columns = dict.fromkeys(pd.read_csv(paths[0]), 1.0)
            return pd.DataFrame(columns | {"label": with_taa(labels_of(name))})
        case "screen_errors" if not paths:
            frames = layout.entry("frame_sets", table["frame_set"])
            lights = [*range(len(frames["radii"])), "all"]
            rows = product(labels_of(name), frames["scenes"], lights)
            return pd.DataFrame(rows, columns=["label", "frames", "light"]).assign(
                mse=1.0, mse_off_edges=1.0
            )
    table = pd.read_csv(paths[0])
    for column in ("mse", "error"):  # of references that are older than these columns
        if column in table:
            table = table.assign(**{f"{column}_off_edges": table[column]})
    if name == "nsm_penumbrae":
        table = table.assign(wide_ratio=table["measured_wide"] / table["modelled_wide"])
    return table


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
