"""The stages that turn per-view metrics and frames into a table and its pictures."""

import datetime
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np

from neural_shadows.depth_bias_file import biases_by_method
from neural_shadows.first_frames import read_first_frames
from neural_shadows.published import read_published
from neural_shadows.records import read_lpips_choice, read_mesh_report, read_training
from neural_shadows.strips import picture_strip, write_strip
from neural_shadows.tables import comparison_table, read_metrics, write_table

REFERENCES = {
    "exact": "an exact shadow ray per pixel",
    "shadow_map": "a 32768² shadow map, as in the thesis",
}


def describe_mesh(report: Mapping[str, Any], procedural: bool) -> str:
    """One phrase on a prepared mesh: name, size, whether it is closed."""
    name = report["name"]
    kind = " (the pipeline's procedural stand-in, not the thesis's mesh)" if procedural else ""
    closed = "watertight" if report["watertight"] else "open"
    return f"{name}{kind}, {report['faces']:,} triangles, {closed}"


def describe_training(record: Mapping[str, Any]) -> str:
    """One sentence on how a network was trained, and on what machine."""
    training, machine = record["training"], record["machine"]
    device = machine["gpu"] if training["device"] == "cuda" else f"{machine['cpu']} CPU"
    return (
        f"{record['name']}: {record['parameters']:,} parameters, {training['steps']:,} steps of "
        f"{training['batch_size']:,} samples ({training['schedule']} learning rate "
        f"{training['learning_rate']:g}, {training['precision']}) in {record['seconds']:.0f} s on "
        f"{device}, {record['threads']} threads"
    )


def write_table_report(
    metrics: Sequence[Path],
    mesh_json: Path,
    training_jsons: Sequence[Path],
    bias_jsons: Sequence[Path],
    lpips_json: Path,
    published_csv: Path,
    csv_path: Path,
    md_path: Path,
    *,
    title: str,
    number: str | None,
    rows: Sequence[Mapping[str, str | None]],
    scale: str,
    width: int,
    height: int,
    reference: str,
    procedural: bool,
    seed: int,
) -> None:
    """Write a comparison table as CSV and Markdown, with what a reader must know below it.

    Args:
        bias_jsons: depth biases that were found for methods of the table.
        number: the thesis's number of the table, "4.3"; None for one that is not in it.
        rows: see `comparison_table`.
        width, height: of the frames, in pixels.
        reference: `exact` or `shadow_map`.
        procedural: whether the pipeline made the mesh itself.

    Raises:
        InputError: metrics are missing, cut short or not finite.
    """
    mesh, lpips = read_mesh_report(mesh_json), read_lpips_choice(lpips_json)
    records = [read_training(path) for path in training_jsons]
    frame = comparison_table(
        read_metrics(metrics),
        rows,
        number,
        read_published(published_csv),
        {
            "mesh": mesh["name"],
            "scale": scale,
            "width": width,
            "height": height,
            "lpips_net": lpips["net"] if lpips["available"] else None,
            "seed": seed,
        },
        seed,
    )
    notes = [
        f"Scale: {scale}; frames of {width} × {height}; seed {seed}; "
        f"made on {datetime.date.today().isoformat()}.",
        f"Mesh: {describe_mesh(mesh, procedural)}.",
        f"Reference: {REFERENCES[reference]}.",
        *(f"Network {describe_training(record)}." for record in records),
    ]
    biases = biases_by_method(bias_jsons)
    notes += [
        f"{row['label']}: with a depth bias of {biases[row['method']]:g} sphere radii, its best on "
        "held-out views; the thesis's network has none, and maps their slope-scaled one."
        for row in rows
        if row["method"] in biases
    ]
    if lpips["available"]:
        notes.append(
            f"LPIPS's network is `{lpips['net']}`; the thesis does not say which it used, and "
            "values of different networks do not compare."
        )
    else:
        notes.append(
            f"LPIPS is missing, the rows are sorted by FLIP: {lpips['reason']}. After that, "
            "`--forcerun find_lpips` looks again."
        )
    if number:
        title += f" (table {number} of the thesis)"
    write_table(frame, csv_path, md_path, title=title, notes=notes)


def write_picture_strip(
    pictures: Sequence[Path],
    metrics: Sequence[Path],
    mesh_json: Path,
    png: Path,
    svg: Path,
    *,
    title: str,
    rows: Sequence[Mapping[str, str | None]],
    scale: str,
) -> None:
    """Draw the first frame of each view set by every method, whole and as a crop.

    Args:
        pictures: frames as `evaluate` wrote them, one file for each evaluation and view set.
        metrics: the metrics of the same batches, in the same order.
    """
    labels = {row["method"]: row["label"] for row in rows} | {"reference": "Reference"}
    frames = read_first_frames(pictures, metrics)
    shown = [
        {key: image.astype(np.float32) / 255 for key, image in frame.images.items()}
        for frame in frames
    ]
    mesh = read_mesh_report(mesh_json)["name"]
    figure = picture_strip(
        shown,
        labels,
        [frame.caption for frame in frames],
        title=f"{title} ({mesh}, {scale} scale)",
        scores=[frame.scores for frame in frames],
    )
    write_strip(figure, png, svg)
