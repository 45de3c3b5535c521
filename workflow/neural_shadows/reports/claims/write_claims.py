"""The texts' conclusions, judged by our data [4, 5.1]."""

from collections.abc import Iterable, Mapping, Sequence
from pathlib import Path
from types import ModuleType

import pandas as pd

from neural_shadows.evaluation.metric_files import read_metrics, read_view_metrics
from neural_shadows.files.whole_files import read_json
from neural_shadows.reports.claims.claim_kinds import kind_of
from neural_shadows.reports.claims.frames import SoftTable, TableSettings, soft_values
from neural_shadows.reports.claims.gates import judge
from neural_shadows.reports.claims.measured import TEXT_SAMPLES, Claim, Measured
from neural_shadows.reports.data import phrases
from neural_shadows.reports.data.inputs import by_folder, read_by_folder
from neural_shadows.reports.data.learned import margins
from neural_shadows.reports.data.phrases import TEXTS
from neural_shadows.reports.data.published import by_cell, read_rows
from neural_shadows.reports.data.quality import values_by_view
from neural_shadows.reports.data.table import Table, write_table
from neural_shadows.reports.data.trained import THESIS_SAMPLES
from neural_shadows.reports.data.verdicts import MEANINGS, VERDICTS
from neural_shadows.running.stage import run_stage
from neural_shadows.settings.records import CurvePoint, Run, SceneInfo
from neural_shadows.training.loss_curve import read_loss

COLUMNS = [
    *("claim", "text", "section", "statement", "kind", "verdict", "reason", "metric", "seeds"),
    *("budget_fraction", "trend_of", "trend", "trend_low", "trend_high", "direction"),
    *("null_verdict", "number_of", "number", "evidence", "scale", "samples", "text_samples"),
]
OF_SETTINGS = ("text", "section", "statement", "kind")


def claims(
    *,
    metrics: list[Path],
    losses: list[Path],
    trainings: list[Path],
    times: list[Path],
    meshes: list[Path],
    soft_metrics: list[Path],
    soft_times: list[Path],
    tables: list[Path],
    screen_trainings: list[Path],
    published_csv: Path,
    claims: Mapping[str, Claim],
    learning_curves: Mapping[str, Sequence[CurvePoint]],
    soft_tables: Mapping[str, TableSettings],
    run: Run,
    scenes: Mapping[str, SceneInfo],
) -> Table:
    """A table of the texts' claims with our verdicts.

    CSV: `number` is of the comparison most against the claim, `number_of` its metric.

    Args:
        metrics, losses, trainings, times, meshes, soft_metrics: folders are named after a
            file's scene, experiment, table or frame set; soft_times, tables: files are named after
            a table.
        claims: by name, see `judge`, with `section` and `statement`.
        learning_curves: the points of each experiment's curve, the budgets growing.

    Raises:
        InputError: a file is missing, or a method is without a value of another's view.
    """
    published = read_rows(published_csv)
    kinds = [*dict.fromkeys(map(kind_of, claims.values()))]
    data = Measured(
        metrics={scene: _by_view(paths, kinds) for scene, paths in by_folder(metrics).items()},
        losses={name: read_loss(path) for name, [path] in by_folder(losses).items()},
        trainings=read_by_folder(trainings),
        times={(path.parent.name, path.stem): read_json(path) for path in times},
        meshes=read_by_folder(meshes),
        scenes=scenes,
        published=published,
        margins=margins(by_cell(published)),
        curves=learning_curves,
        seed=run["seed"],
        soft=_soft(soft_metrics, soft_times, soft_tables),
        tables={path.stem: pd.read_csv(path) for path in tables},
        screen_trainings=read_by_folder(screen_trainings),
    )
    rows = pd.DataFrame(
        {"claim": name} | {key: claim[key] for key in OF_SETTINGS} | judge(claim, data)
        for name, claim in claims.items()
    ).assign(scale=run["scale"])
    rows = rows[COLUMNS].astype({"seeds": "Int64", "samples": "Int64"})  # with gaps
    columns = {
        "claim": rows["statement"],
        "verdict": "**" + rows["verdict"] + "**",
        "why": rows["reason"],
        "section": [phrases.section_of(row) for _, row in rows.iterrows()],
        "evidence": rows["evidence"],
    }
    return Table(
        title="Claims, and the verdicts of this run",
        data=rows,
        columns=columns,
        notes=_notes(data, run, scenes),
        lead=_lead(rows["verdict"], data),
        text_columns=len(columns),
    )


def _by_view(paths: Sequence[Path], kinds: Iterable[ModuleType]) -> pd.DataFrame:
    """A scene's values, a row a view."""
    metrics = read_view_metrics(paths)
    quality = values_by_view(metrics, metrics["method"].unique())
    counts = [kind.counts_by_view(metrics) for kind in kinds if hasattr(kind, "counts_by_view")]
    return pd.concat([quality, *counts], axis=1)


def _soft(
    metrics: Sequence[Path], times: Sequence[Path], tables: Mapping[str, TableSettings]
) -> dict[str, SoftTable]:
    """Measured values of soft shadows by table."""
    timed = read_by_folder(times)
    soft = {}
    for table, about in tables.items():
        of_frames = [path for path in metrics if path.parents[1].name == about["frame_set"]]
        measured = read_metrics(of_frames)
        values = soft_values(measured[measured["scene"].isin(about["scenes"])])
        lights = about["radii"], about["lights"]
        soft[table] = SoftTable(values, about["labels"], timed.get(table), *lights)
    return soft


def _lead(verdicts: pd.Series, data: Measured) -> str:
    """The scale of a run and the meanings of verdicts."""
    rays = [record["samples"] for record in data.trainings.values() if record["training"]]
    counts = verdicts.value_counts()
    pixels = [record["samples"] for record in data.screen_trainings.values()]
    sentences = [phrases.describe_samples(max(rays), THESIS_SAMPLES)] if rays else []
    if pixels:
        theirs = " and ".join(f"{TEXT_SAMPLES[text] / 1e9:.3g} billion" for text in TEXTS)
        sentences.append(
            f"Screen-space networks saw at most {max(pixels):,} pixels each in this run, and {theirs} "
            f"in {' and '.join(TEXTS.values())}."
        )
    scale = " ".join(sentences) or "No network was trained for these claims."
    meanings = [f"- **{name}** ({counts.get(name, 0)}): {MEANINGS[name]}" for name in VERDICTS]
    first = f"{scale} A verdict is limited to these data: the first of the following that applies."
    return "\n".join([first, "", *meanings])


def _notes(data: Measured, run: Run, scenes: Mapping[str, SceneInfo]) -> list[str]:
    notes = [
        "An advantage is counted so that positive is in the claim's favour; of PSNR it is of "
        "pooled PSNR, that of the mean squared error over views. Its 95 % interval is over seeds "
        "(Student's t) and views within their view set (jackknife; the object is fixed) together, of "
        "soft shadows over seeds and scenes (of fewer than five: frames, and these scenes alone; both "
        "Student's t), of losses over seeds "
        "(the last tenth of each curve is one value; of a diverged training, at least the loss of "
        "no shadow), of times over frames (exact, of the median of the frames' ratios of "
        "own milliseconds, without primary visibility and shading), of ratios of tables over seeds "
        "alone (Student's t of their logarithms). Ratios without networks and proportional "
        "columns have no interval: their numbers decide.",
        "Networks are compared at their largest common budget and by the same seeds; a trend is "
        "over the budgets of a learning curve. One seed has no interval over trainings.",
        "Printed: claims on the thesis's own tables have a margin and no test: a difference counts "
        "from twice what it prints for the same configuration trained twice (tables 4.1 and 4.2). "
        "Nothing is corrected across claims.",
    ]
    for scene, mesh in data.meshes.items():
        notes.append(phrases.describe_scene(scene, mesh, scenes[scene]))
    return [*notes, phrases.describe_run(run)]


if "snakemake" in globals():
    run_stage(snakemake, claims, write_table)
