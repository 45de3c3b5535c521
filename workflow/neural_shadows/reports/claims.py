"""What the thesis concludes from its data, tested on ours [4, 5.1]."""

import datetime
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd

from neural_shadows.errors import InputError
from neural_shadows.evaluation.frame_times import read_frame_times
from neural_shadows.evaluation.per_view_metrics import read_metrics
from neural_shadows.metrics.intervals import (
    difference_interval,
    mean_interval,
    median_ratio_interval,
)
from neural_shadows.reports.tables.writing import write_twins
from neural_shadows.training.loss_curve import read_loss

SUPPORTED, CONTRADICTED, UNDECIDED = "supported", "contradicted", "undecided"
HIGHER_IS_BETTER = ("psnr", "ssim")
THESIS_SAMPLES = 1_000_000 * 65_536  # steps of batches [4.1]
LOSS_SHARE = 0.1  # of a loss curve: its end is what was reached
FEWEST = 10  # views, frames or points of a curve; a bootstrap of fewer is far too narrow

Interval = tuple[float, float, float]


@dataclass(frozen=True)
class Finding:
    """One comparison of a claim: its verdict and the numbers behind it."""

    verdict: str
    evidence: str


@dataclass(frozen=True)
class Data:
    """What claims are tested on.

    `metrics`: by evaluation, as `read_metrics` gives it; `scenes`: of each evaluation;
    `losses`: by experiment, as `read_loss` gives it; `times`: by table, as
    `read_frame_times` gives it; `seed`: of the bootstrap.
    """

    metrics: Mapping[str, pd.DataFrame]
    scenes: Mapping[str, str]
    losses: Mapping[str, pd.DataFrame]
    times: Mapping[str, Mapping[str, Mapping[str, Any]]]
    seed: int


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
    count: int,
    interval: Callable[[], Interval],
    least: float = 0,
    most: float = np.inf,
    form: str = "+.4g",
) -> Finding:
    """The finding of an interval, or that there are too few values for one."""
    if count < FEWEST:
        return Finding(UNDECIDED, f"{text}: {count} values are too few: {UNDECIDED}")
    value, low, high = interval()
    verdict = verdict_of(low, high, least, most)
    numbers = f"{value:{form}} [{low:{form}}, {high:{form}}]"
    return Finding(verdict, f"{text} {numbers}: {verdict}")


def _values(data: Data, evaluations: Sequence[str], method: str, metric: str):
    """Values by view of a method, and the scene they are of."""
    for evaluation in evaluations:
        metrics = data.metrics[evaluation]
        rows = metrics[metrics["method"].eq(method) & metrics["metric"].eq(metric)]
        if len(rows):
            values = rows.set_index(["view_set", "view"])["value"].sort_index()
            return values, data.scenes[evaluation]
    raise InputError(
        f"claims: there are no values of {metric} of {method} in the evaluations "
        f"{', '.join(evaluations)}: delete their metrics and run again"
    )


def _gains(a: pd.Series, b: pd.Series, what: str) -> np.ndarray:
    """Differences a − b of values of the same views, (views,)."""
    if not a.index.equals(b.index):
        view_set, view = a.index.symmetric_difference(b.index)[0]
        raise InputError(
            f"claims: {what} differ in their views ({view_set} view {view} is missing in one): "
            "delete the metrics of their evaluations and run again"
        )
    return (a - b).to_numpy()


def _available(data: Data, evaluations: Sequence[str], metric: str) -> str:
    """The metric, or FLIP in the place of LPIPS where its trunk could not be had."""
    given = {name for key in evaluations for name in data.metrics[key]["metric"].unique()}
    return "flip" if metric == "lpips" and "lpips" not in given else metric


def better(claim: Mapping[str, Any], data: Data) -> tuple[str, list[Finding]]:
    """Pairs (better, worse) by the mean over views of an image metric.

    Methods of one scene are seen from the same views, and compared view by view.
    """
    metric = _available(data, claim["evaluations"], claim["metric"])
    instead = "" if metric == claim["metric"] else f"{metric.upper()} for want of LPIPS: "
    sign = 1 if metric in HIGHER_IS_BETTER else -1
    findings = []
    for first, second in claim["pairs"]:
        a, scene = _values(data, claim["evaluations"], first, metric)
        b, other = _values(data, claim["evaluations"], second, metric)
        said = "" if findings else instead  # once a claim
        text = f"{said}{first} {a.mean():.4g}, {second} {b.mean():.4g}, advantage"
        if scene == other:
            gain = sign * _gains(a, b, f"{metric} of {first} and of {second}")
            interval = lambda gain=gain: mean_interval(gain, data.seed)  # noqa: E731
        else:
            a, b = sign * a.to_numpy(), sign * b.to_numpy()
            interval = lambda a=a, b=b: difference_interval(a, b, data.seed)  # noqa: E731
        findings.append(_judged(text, min(len(a), len(b)), interval))
    return metric, findings


def more(claim: Mapping[str, Any], data: Data) -> tuple[str, list[Finding]]:
    """Of each method, more of one metric than of another, view by view."""
    findings = []
    for method in claim["methods"]:
        a, _ = _values(data, claim["evaluations"], method, claim["more"])
        b, _ = _values(data, claim["evaluations"], method, claim["less"])
        text = f"{method}: {claim['more']} {a.mean():.4g}, {claim['less']} {b.mean():.4g}, excess"
        gain = _gains(a, b, f"{claim['more']} and {claim['less']} of {method}")
        findings.append(_judged(text, len(gain), lambda gain=gain: mean_interval(gain, data.seed)))
    return f"{claim['more']} − {claim['less']}", findings


def lower_loss(claim: Mapping[str, Any], data: Data) -> tuple[str, list[Finding]]:
    """Pairs (lower, higher) by the mean of the last tenth of the training loss."""
    findings = []
    for first, second in claim["pairs"]:
        a, b = (_end_of(data.losses[name]) for name in (first, second))
        text = f"{first} {a.mean():.4g}, {second} {b.mean():.4g}, advantage"
        findings.append(
            _judged(
                text,
                min(len(a), len(b)),
                lambda a=a, b=b: difference_interval(b, a, data.seed),
            )
        )
    return "loss", findings


def _end_of(curve: pd.DataFrame) -> np.ndarray:
    return curve["loss"].to_numpy()[-max(1, round(LOSS_SHARE * len(curve))) :]


def frame_time(claim: Mapping[str, Any], data: Data) -> tuple[str, list[Finding]]:
    """Pairs (slower, faster) by the ratio of their median frame times, within bounds."""
    least = -np.inf if claim["at_least"] is None else claim["at_least"]
    most = np.inf if claim["at_most"] is None else claim["at_most"]
    asked = [
        *([f"at least {claim['at_least']:g}"] if claim["at_least"] is not None else []),
        *([f"at most {claim['at_most']:g}"] if claim["at_most"] is not None else []),
    ]
    findings = []
    for first, second in claim["pairs"]:
        a, b = _times_of(data.times[claim["table"]], first, second)
        text = (
            f"{first} {np.median(a):.4g} ms, {second} {np.median(b):.4g} ms, "
            f"ratio ({' and '.join(asked)})"
        )
        findings.append(
            _judged(
                text,
                len(a),
                lambda a=a, b=b: median_ratio_interval(a, b, data.seed),
                least,
                most,
                "#.3g",
            )
        )
    return "frame time", findings


def _times_of(times: Mapping[str, Mapping[str, Any]], first: str, second: str):
    """Frame times of two methods in the scene that has both."""
    for scene in times.values():
        if first in scene["methods"] and second in scene["methods"]:
            return tuple(np.array(scene["methods"][name]["ms"]) for name in (first, second))
    raise InputError(
        f"claims: no scene has frame times of both {first} and {second}; name methods of one scene"
    )


KINDS = {"better": better, "more": more, "lower_loss": lower_loss, "frame_time": frame_time}


def judge(claims: Mapping[str, Mapping[str, Any]], data: Data) -> pd.DataFrame:
    """Test claims: a row each with `claim, section, statement, verdict, metric, evidence`.

    Args:
        claims: by name, as in the config: `kind`, `section`, `statement`, and what the kind needs.

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


def write_claims(
    csv_path: Path,
    md_path: Path,
    *,
    claims: Mapping[str, Mapping[str, Any]],
    metrics: Mapping[str, Sequence[Path]],
    scenes: Mapping[str, str],
    losses: Mapping[str, Path],
    frame_times: Mapping[str, Sequence[Path]],
    scale: str,
    samples: int,
    seed: int,
) -> None:
    """Write the thesis's claims with our verdicts, as CSV and Markdown.

    Args:
        metrics: files of per-view metrics by evaluation; `scenes`: the scene of each.
        losses: loss curves by experiment; `frame_times`: files by table.
        samples: that a network of this run was trained on, at most.

    Raises:
        InputError: a file is missing or cut short, or holds no data of a claim.
    """
    data = Data(
        {name: read_metrics(paths) for name, paths in metrics.items()},
        scenes,
        {name: read_loss(path) for name, path in losses.items()},
        {table: read_frame_times(paths) for table, paths in frame_times.items()},
        seed,
    )
    frame = judge(claims, data).assign(scale=scale, samples=samples, thesis_samples=THESIS_SAMPLES)
    columns = {
        "claim": frame["statement"].tolist(),
        "verdict": [f"**{verdict}**" for verdict in frame["verdict"]],
        "section": frame["section"].tolist(),
        "metric": frame["metric"].tolist(),
        "evidence": frame["evidence"].tolist(),
    }
    counts = frame["verdict"].value_counts()
    notes = [
        ", ".join(
            f"{counts.get(verdict, 0)} {verdict}"
            for verdict in (SUPPORTED, CONTRADICTED, UNDECIDED)
        )
        + f" of {len(frame)}.",
        "Supported: the 95 % bootstrap interval lies wholly on the claim's side, in each of its "
        "comparisons; contradicted: wholly on the other side in one of them; undecided: neither.",
        "An advantage is counted so that positive is in the claim's favour. Intervals are over "
        "views (the same ones for all methods of a scene), over the last tenth of the loss curve, "
        "or over timed frames. Neighbouring points of a loss curve are not independent, so that its "
        "intervals are too narrow; and none covers how trainings differ: each network was trained "
        "once, from one seed.",
        f"Scale: {scale}, at most {samples:,} training samples a network. The thesis trained on "
        f"{THESIS_SAMPLES:,}, {THESIS_SAMPLES / samples:,.0f} times as many: what is contradicted "
        "or undecided here was claimed at that scale. Configuration: config/thesis.yaml.",
        f"Seed {seed}; made on {datetime.date.today().isoformat()}.",
    ]
    title = "What the thesis claims, tested on this run"
    write_twins(
        frame, columns, csv_path, md_path, title=title, notes=notes, text_columns=len(columns)
    )
