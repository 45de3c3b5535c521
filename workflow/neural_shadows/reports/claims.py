"""What the thesis concludes from its data, tested on ours [4, 5.1]."""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd

from neural_shadows.evaluation.per_view_metrics import read_metrics
from neural_shadows.files.whole_files import read_json
from neural_shadows.metrics import intervals
from neural_shadows.reports import phrases
from neural_shadows.reports.inputs import by_folder
from neural_shadows.reports.tables.quality import values_by_view
from neural_shadows.reports.tables.writing import write_twins
from neural_shadows.running.stage import run_stage
from neural_shadows.training.loss_curve import read_loss

SUPPORTED, CONTRADICTED, UNDECIDED = VERDICTS = ("supported", "contradicted", "undecided")
HIGHER_IS_BETTER = ("psnr", "ssim")
THESIS_SAMPLES = 1_000_000 * 65_536  # steps of batches [4.1]
LOSS_SHARE = 0.1  # of a loss curve: its end is what was reached
COLUMNS = ["claim", "section", "statement", "verdict", "metric", "evidence"]
FEWEST = 10  # views, frames or points of a curve; a bootstrap of fewer is far too narrow

Claim = Mapping[str, Any]


@dataclass(frozen=True)
class Data:
    """What claims are tested on."""

    metrics: Mapping[str, pd.DataFrame]  # of `values_by_view`, by scene
    losses: Mapping[str, pd.DataFrame]  # of `read_loss`, by experiment
    times: Mapping[tuple[str, str], Mapping[str, Any]]  # by table and scene
    seed: int  # of the bootstrap


@dataclass(frozen=True)
class Comparison:
    """One comparison of a claim: it holds if the interval of the values lies within the bounds."""

    text: str
    interval: Callable[..., tuple[float, float, float]]
    values: Sequence[np.ndarray]
    bounds: tuple[float, float] = (0, np.inf)
    form: str = "+.4g"

    def judged(self, seed: int) -> tuple[str, str]:
        """The verdict, and the numbers behind it."""
        count = min(map(len, self.values))
        if count < FEWEST:
            return UNDECIDED, f"{self.text}: {count} values are too few: {UNDECIDED}"
        value, low, high = self.interval(*self.values, seed)
        verdict = verdict_of(low, high, *self.bounds)
        numbers = f"{value:{self.form}} [{low:{self.form}}, {high:{self.form}}]"
        return verdict, f"{self.text} {numbers}: {verdict}"


def write_claims(
    *,
    metrics: list[Path],
    losses: list[Path],
    times: list[Path],
    csv: Path,
    md: Path,
    claims: Mapping[str, Claim],
    run: Mapping[str, Any],
    samples: int,
    scenes: Mapping[str, Mapping[str, Any]],
) -> None:
    """Write the thesis's claims with our verdicts, as CSV and Markdown.

    Args:
        metrics, losses, times: per-view metrics, loss curves and frame times of the methods that
            claims name; their folders say of which scene, experiment and table.
        samples: that a network of this run was trained on, at most.

    Raises:
        InputError: a file is missing, or a method lacks a value of a view that others have.
    """
    measured = {scene: read_metrics(paths) for scene, paths in by_folder(metrics).items()}
    data = Data(
        {name: values_by_view(part, part["method"].unique()) for name, part in measured.items()},
        {name: read_loss(path) for name, [path] in by_folder(losses).items()},
        {(path.parent.name, path.stem): read_json(path) for path in times},
        run["seed"],
    )
    found = judge(claims, data)
    columns = {"claim": found["statement"], "verdict": "**" + found["verdict"] + "**"}
    columns |= {name: found[name] for name in ("section", "metric", "evidence")}
    counts = found["verdict"].value_counts()
    meshes = ", ".join(f"{scene} {settings['mesh_name']}" for scene, settings in scenes.items())
    notes = [
        ", ".join(f"{counts.get(verdict, 0)} {verdict}" for verdict in VERDICTS)
        + f" of {len(found)}.",
        f"The networks saw at most {samples:,} training samples. The thesis's saw "
        f"{THESIS_SAMPLES:,}, {THESIS_SAMPLES / samples:,.0f} times as many: what is contradicted "
        "or undecided here was claimed at that scale (config/thesis.yaml).",
        "Supported: the 95 % bootstrap interval lies wholly on the claim's side, in each of its "
        "comparisons; contradicted: wholly on the other side in one of them; undecided: neither.",
        "An advantage is counted so that positive is in the claim's favour. Intervals are over "
        "views (the same ones for all methods of a scene), over the last tenth of the loss curve, "
        "or over timed frames. Neighbouring points of a loss curve are not independent, so that its "
        "intervals are too narrow; and none covers how trainings differ: each network was trained "
        "once, from one seed.",
        f"Meshes: {meshes}; seed {run['seed']}.",
        phrases.describe_run(run),
    ]
    found = found.assign(scale=run["scale"], samples=samples, thesis_samples=THESIS_SAMPLES)
    title = "What the thesis claims, tested on this run"
    write_twins(found, columns, csv, md, title=title, notes=notes, text_columns=len(columns))


def judge(claims: Mapping[str, Claim], data: Data) -> pd.DataFrame:
    """Test claims: a row of `COLUMNS` each.

    One comparison against a claim contradicts it, all are needed to support it.
    `claims` by name have `kind`, `section`, `statement` and what the kind needs: `pairs` of
    methods, the claimed winner first, or `methods`; a method is a row as `config.rows` gives it.
    """
    rows = []
    for name, claim in claims.items():
        metric, comparisons = KINDS[claim["kind"]](claim, data)
        verdicts, evidence = zip(*(comparison.judged(data.seed) for comparison in comparisons))
        verdict = max(verdicts, key=(SUPPORTED, UNDECIDED, CONTRADICTED).index)
        said = (name, claim["section"], claim["statement"])
        rows.append((*said, verdict, metric, "; ".join(evidence)))
    return pd.DataFrame(rows, columns=COLUMNS)


def verdict_of(low: float, high: float, least: float, most: float) -> str:
    """Whether an interval lies wholly between the bounds, wholly outside, or neither.

    A bound itself is neither side: methods that are alike in every view decide nothing.
    """
    if low > least and high < most:
        return SUPPORTED
    return CONTRADICTED if high < least or low > most else UNDECIDED


def better(claim: Claim, data: Data) -> tuple[str, list[Comparison]]:
    """Pairs (better, worse) by the mean over views of an image metric.

    Methods of one scene are seen from the same views, and compared view by view.
    """
    metric, note, comparisons = claim["metric"], "", []
    first = claim["pairs"][0][0]
    if (first["method"], metric) not in data.metrics[first["scene"]]:
        metric, note = "flip", "FLIP, as LPIPS is not available: "
    sign = 1 if metric in HIGHER_IS_BETTER else -1
    for pair in claim["pairs"]:
        a, b = (data.metrics[row["scene"]][row["method"], metric] for row in pair)
        interval, values = intervals.difference_interval, [sign * a.to_numpy(), sign * b.to_numpy()]
        if pair[0]["scene"] == pair[1]["scene"]:
            interval, values = intervals.mean_interval, [sign * (a - b).to_numpy()]
        comparisons.append(Comparison(note + _means(pair, a, b), interval, values))
        note = ""  # said once a claim
    return metric, comparisons


def larger_error(claim: Claim, data: Data) -> tuple[str, list[Comparison]]:
    """Of each method, more of one error than of another, view by view."""
    larger, smaller = claim["more"], claim["less"]
    comparisons = []
    for method in claim["methods"]:
        values = data.metrics[method["scene"]][method["method"]]
        a, b = values[larger], values[smaller]
        text = f"{method['method']}: {larger} {a.mean():.4g}, {smaller} {b.mean():.4g}, excess"
        comparisons.append(Comparison(text, intervals.mean_interval, [(a - b).to_numpy()]))
    return f"{larger} − {smaller}", comparisons


def lower_loss(claim: Claim, data: Data) -> tuple[str, list[Comparison]]:
    """Pairs (lower, higher) by the mean of the last tenth of the training loss."""
    comparisons = []
    for pair in claim["pairs"]:
        curves = [data.losses[method["experiment"]]["loss"] for method in pair]
        a, b = (curve.to_numpy()[-max(1, round(LOSS_SHARE * len(curve))) :] for curve in curves)
        comparisons.append(Comparison(_means(pair, a, b), intervals.difference_interval, [b, a]))
    return "loss", comparisons


def frame_time(claim: Claim, data: Data) -> tuple[str, list[Comparison]]:
    """Pairs (slower, faster) of a scene by the ratio of their median frame times, within bounds."""
    asked = {key: claim[key] for key in ("at_least", "at_most") if claim[key] is not None}
    bounds = asked.get("at_least", -np.inf), asked.get("at_most", np.inf)
    limits = " and ".join(f"{key.replace('_', ' ')} {limit:g}" for key, limit in asked.items())
    comparisons = []
    for pair in claim["pairs"]:
        methods = data.times[claim["table"], pair[0]["scene"]]["methods"]
        series = [np.array(methods[method["method"]]["ms"]) for method in pair]
        medians = [f"{m['method']} {np.median(ms):.4g} ms" for m, ms in zip(pair, series)]
        text = f"{', '.join(medians)}, ratio ({limits})"
        interval = intervals.median_ratio_interval
        comparisons.append(Comparison(text, interval, series, bounds, "#.3g"))
    return "frame time", comparisons


def _means(pair: Sequence[Mapping[str, Any]], *values: np.ndarray | pd.Series) -> str:
    means = [f"{method['method']} {some.mean():.4g}" for method, some in zip(pair, values)]
    return f"{', '.join(means)}, advantage"


KINDS = {kind.__name__: kind for kind in (better, larger_error, lower_loss, frame_time)}


if "snakemake" in globals():
    run_stage(snakemake, write_claims)
