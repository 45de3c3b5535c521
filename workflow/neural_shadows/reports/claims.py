"""What the thesis concludes from its data, tested on ours [4, 5.1]."""

from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd

from neural_shadows.errors import InputError
from neural_shadows.evaluation.per_view_metrics import read_metrics
from neural_shadows.files.whole_files import read_json
from neural_shadows.metrics.intervals import (
    difference_interval,
    mean_interval,
    median_ratio_interval,
)
from neural_shadows.reports import phrases
from neural_shadows.reports.inputs import by_folder
from neural_shadows.reports.tables.writing import write_twins
from neural_shadows.running.stage import run_stage
from neural_shadows.training.loss_curve import read_loss

SUPPORTED, CONTRADICTED, UNDECIDED = VERDICTS = ("supported", "contradicted", "undecided")
HIGHER_IS_BETTER = ("psnr", "ssim")
THESIS_SAMPLES = 1_000_000 * 65_536  # steps of batches [4.1]
LOSS_SHARE = 0.1  # of a loss curve: its end is what was reached
FEWEST = 10  # views, frames or points of a curve; a bootstrap of fewer is far too narrow

Interval = tuple[float, float, float]
Method = Mapping[str, Any]  # `method`, `scene`, `experiment`


@dataclass(frozen=True)
class Finding:
    """One comparison of a claim: its verdict and the numbers behind it."""

    verdict: str
    evidence: str


@dataclass(frozen=True)
class Data:
    """What claims are tested on.

    `metrics`: by scene, as `read_metrics` gives it; `losses`: by experiment, as `read_loss` gives
    it; `times`: by table and scene, what `measure_frame_times` wrote; `seed`: of the bootstrap.
    """

    metrics: Mapping[str, pd.DataFrame]
    losses: Mapping[str, pd.DataFrame]
    times: Mapping[tuple[str, str], Mapping[str, Any]]
    seed: int


def write_claims(
    *,
    metrics: list[Path],
    losses: list[Path],
    times: list[Path],
    csv: Path,
    md: Path,
    claims: Mapping[str, Mapping[str, Any]],
    run: Mapping[str, Any],
    samples: int,
    scenes: Mapping[str, Mapping[str, Any]],
) -> None:
    """Write the thesis's claims with our verdicts, as CSV and Markdown.

    Args:
        metrics, losses, times: per-view metrics, loss curves and frame times of the methods that
            claims name; their folders say of which scene, experiment and table.
        claims: see `judge`.
        run: `scale`, `seed` (of the bootstrap).
        samples: that a network of this run was trained on, at most.
        scenes: `mesh_name` of each scene.

    Raises:
        InputError: a file is missing or cut short, or holds no data of a claim.
    """
    data = Data(
        {scene: read_metrics(paths) for scene, paths in by_folder(metrics).items()},
        {name: read_loss(path) for name, [path] in by_folder(losses).items()},
        {(path.parent.name, path.stem): read_json(path) for path in times},
        run["seed"],
    )
    found = judge(claims, data)
    columns = {
        "claim": found["statement"].tolist(),
        "verdict": [f"**{verdict}**" for verdict in found["verdict"]],
        "section": found["section"].tolist(),
        "metric": found["metric"].tolist(),
        "evidence": found["evidence"].tolist(),
    }
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


def judge(claims: Mapping[str, Mapping[str, Any]], data: Data) -> pd.DataFrame:
    """Test claims: a row each with `claim, section, statement, verdict, metric, evidence`.

    Args:
        claims: by name: `kind`, `section`, `statement`, and what the kind needs: `pairs` of
            methods, the claimed winner first, or `methods`; a method is a row as `config.rows`
            gives it.

    Raises:
        InputError: data that a claim needs are missing, or not of the same views.
    """
    rows = []
    for name, claim in claims.items():
        metric, findings = KINDS[claim["kind"]](claim, data)
        rows.append(
            {
                "claim": name,
                "section": claim["section"],
                "statement": claim["statement"],
                "verdict": verdict_of_all(finding.verdict for finding in findings),
                "metric": metric,
                "evidence": "; ".join(finding.evidence for finding in findings),
            }
        )
    return pd.DataFrame(rows)


def verdict_of(low: float, high: float, least: float, most: float) -> str:
    """Whether an interval lies wholly between the bounds, wholly outside, or neither.

    A bound itself is neither side: methods that are alike in every view decide nothing.
    """
    if low > least and high < most:
        return SUPPORTED
    if high < least or low > most:
        return CONTRADICTED
    return UNDECIDED


def verdict_of_all(verdicts: Iterable[str]) -> str:
    """A claim's verdict: one comparison against it contradicts it, all are needed to support it."""
    verdicts = set(verdicts)
    if CONTRADICTED in verdicts:
        return CONTRADICTED
    return SUPPORTED if verdicts == {SUPPORTED} else UNDECIDED


def _judged(
    text: str,
    interval: Callable[..., Interval],
    *values: np.ndarray,
    seed: int,
    bounds: tuple[float, float] = (0, np.inf),
    form: str = "+.4g",
) -> Finding:
    """The finding of an interval of some values, or that there are too few of them."""
    count = min(map(len, values))
    if count < FEWEST:
        return Finding(UNDECIDED, f"{text}: {count} values are too few: {UNDECIDED}")
    value, low, high = interval(*values, seed)
    verdict = verdict_of(low, high, *bounds)
    numbers = f"{value:{form}} [{low:{form}}, {high:{form}}]"
    return Finding(verdict, f"{text} {numbers}: {verdict}")


def better(claim: Mapping[str, Any], data: Data) -> tuple[str, list[Finding]]:
    """Pairs (better, worse) by the mean over views of an image metric.

    Methods of one scene are seen from the same views, and compared view by view.
    """
    metric = _available(claim, data)
    instead = "" if metric == claim["metric"] else f"{metric.upper()} for want of LPIPS: "
    sign = 1 if metric in HIGHER_IS_BETTER else -1
    findings = []
    for first, second in claim["pairs"]:
        a, b = _values(data, first, metric), _values(data, second, metric)
        text = (
            f"{'' if findings else instead}{first['method']} {a.mean():.4g}, "
            f"{second['method']} {b.mean():.4g}, advantage"
        )
        if first["scene"] == second["scene"]:
            compared = mean_interval, sign * _gains(a, b)
        else:
            compared = difference_interval, sign * a.to_numpy(), sign * b.to_numpy()
        findings.append(_judged(text, *compared, seed=data.seed))
    return metric, findings


def larger_error(claim: Mapping[str, Any], data: Data) -> tuple[str, list[Finding]]:
    """Of each method, more of one error than of another, view by view."""
    larger, smaller = claim["more"], claim["less"]
    findings = []
    for method in claim["methods"]:
        a, b = _values(data, method, larger), _values(data, method, smaller)
        text = f"{method['method']}: {larger} {a.mean():.4g}, {smaller} {b.mean():.4g}, excess"
        findings.append(_judged(text, mean_interval, _gains(a, b), seed=data.seed))
    return f"{larger} − {smaller}", findings


def lower_loss(claim: Mapping[str, Any], data: Data) -> tuple[str, list[Finding]]:
    """Pairs (lower, higher) by the mean of the last tenth of the training loss."""
    findings = []
    for first, second in claim["pairs"]:
        a, b = (_end_of(data.losses[method["experiment"]]) for method in (first, second))
        text = f"{first['method']} {a.mean():.4g}, {second['method']} {b.mean():.4g}, advantage"
        findings.append(_judged(text, difference_interval, b, a, seed=data.seed))
    return "loss", findings


def frame_time(claim: Mapping[str, Any], data: Data) -> tuple[str, list[Finding]]:
    """Pairs (slower, faster) of a scene by the ratio of their median frame times, within bounds."""
    least = -np.inf if claim["at_least"] is None else claim["at_least"]
    most = np.inf if claim["at_most"] is None else claim["at_most"]
    asked = [
        f"{word} {claim[key]:g}"
        for key, word in (("at_least", "at least"), ("at_most", "at most"))
        if claim[key] is not None
    ]
    findings = []
    for first, second in claim["pairs"]:
        methods = data.times[claim["table"], first["scene"]]["methods"]
        a, b = (np.array(methods[method["method"]]["ms"]) for method in (first, second))
        text = (
            f"{first['method']} {np.median(a):.4g} ms, {second['method']} {np.median(b):.4g} ms, "
            f"ratio ({' and '.join(asked)})"
        )
        findings.append(
            _judged(
                text,
                median_ratio_interval,
                a,
                b,
                seed=data.seed,
                bounds=(least, most),
                form="#.3g",
            )
        )
    return "frame time", findings


KINDS = {
    "better": better,
    "larger_error": larger_error,
    "lower_loss": lower_loss,
    "frame_time": frame_time,
}


def _available(claim: Mapping[str, Any], data: Data) -> str:
    """The claim's metric, or FLIP in the place of LPIPS where its trunk is not available."""
    scenes = {method["scene"] for pair in claim["pairs"] for method in pair}
    given = {name for scene in scenes for name in data.metrics[scene]["metric"].unique()}
    metric = claim["metric"]
    return "flip" if metric == "lpips" and "lpips" not in given else metric


def _values(data: Data, method: Method, metric: str) -> pd.Series:
    """Values of a method by view set and view."""
    metrics = data.metrics[method["scene"]]
    rows = metrics[metrics["method"].eq(method["method"]) & metrics["metric"].eq(metric)]
    if rows.empty:
        raise InputError(
            f"claims: there are no values of {metric} of {method['method']}: delete its metrics "
            "and run again"
        )
    return rows.set_index(["view_set", "view"])["value"].sort_index()


def _gains(a: pd.Series, b: pd.Series) -> np.ndarray:
    """Differences a − b of values of the same views, (views,)."""
    if not a.index.equals(b.index):
        view_set, view = a.index.symmetric_difference(b.index)[0]
        raise InputError(
            f"claims: two methods differ in their views ({view_set} view {view} is missing in one): "
            "delete their metrics and run again"
        )
    return (a - b).to_numpy()


def _end_of(curve: pd.DataFrame) -> np.ndarray:
    return curve["loss"].to_numpy()[-max(1, round(LOSS_SHARE * len(curve))) :]


if "snakemake" in globals():
    run_stage(snakemake, write_claims)
