"""Frame time, quality and size of networks over their width [4.4.1, table 4.6]."""

from collections.abc import Sequence
from pathlib import Path
from typing import Literal

from pydantic import Field

from neural_shadows.evaluation.null_predictors import NO_SHADOW
from neural_shadows.files.whole_files import read_json
from neural_shadows.reports.data import phrases, quality_cells, timing
from neural_shadows.reports.data.inputs import read_by_folder
from neural_shadows.reports.data.learned import margins
from neural_shadows.reports.data.published import add_printed, read_published
from neural_shadows.reports.data.quality import scenes_quality
from neural_shadows.reports.data.table import Table, intervals, numbers, with_ends
from neural_shadows.sections.rows import TableByScene
from neural_shadows.settings.records import Row, Run

PRINTED = ("frame_ms", "lpips", "size_kib")  # columns of the thesis's table, in its order


class Settings(TableByScene):
    """Speed, quality and size of methods [4.4.1]."""

    null_rows = (NO_SHADOW,)
    timed = True

    kind: Literal["frame_times"] = Field(description="`frame_times`")


def table(
    times: list[Path],
    metrics: list[Path],
    weights: list[Path],
    meshes: list[Path],
    lpips_json: Path,
    published_csv: Path,
    title: str,
    published: str | None,
    rows: Sequence[Row],
    run: Run,
) -> Table:
    """Tabulate frame times, in the order of `rows`.

    CSV: `method, scene`, `FRAME_MS`, `OWN_MS`, `repeats, device, lpips, lpips_low, lpips_high,
    learned, size_kib, resident_kib`, the columns of `add_printed` of `PRINTED`,
    and the context.
    """
    timed = {record["scene"]: record for record in map(read_json, times)}
    chance = margins(read_published(published_csv))
    scored = scenes_quality(metrics, rows, chance, {}, run["seed"])
    table = timing.timing_table(timed, rows, weights).merge(
        scored, on=["scene", "method"], how="left"
    )
    sizes = {f"{name}_kib": table[f"{name}_bytes"] / 1024 for name in ("stored", "resident")}
    table = table.assign(**sizes).rename(columns={"stored_kib": "size_kib"})
    times_ms = [*timing.FRAME_MS, *timing.OWN_MS]
    first = ["method", "scene", *times_ms, "repeats", "device", *with_ends("lpips"), "learned"]
    table = table[[*first, "size_kib", "resident_kib"]]
    described, lpips = read_by_folder(meshes), read_json(lpips_json)
    table = add_printed(table, rows, PRINTED, published, published_csv, described)
    network = lpips["net"] if lpips["available"] else None
    table = table.assign(lpips_net=network)

    columns = {
        "scene": table["scene"],
        "method": quality_cells.method_column(table),
        "own ms ↓": intervals(table, timing.OWN_MS, 1),
        "frame ms ↓": intervals(table, timing.FRAME_MS, 1),
        "thesis ms": numbers(table["thesis_frame_ms"], "{:.1f}", printed_of="frame ms ↓"),
        "LPIPS ↓": quality_cells.quality_column(table, "lpips"),
        "thesis LPIPS": numbers(table["thesis_lpips"], "{:.4f}", printed_of="LPIPS ↓"),
        "size KiB": numbers(table["size_kib"], "{:.0f}"),
        "thesis KiB": numbers(table["thesis_size_kib"], "{:.0f}", printed_of="size KiB"),
    }
    ran = timing.devices(timed)
    if len(ran) > 1:
        columns["device"] = table["device"]
        title = f"{title}: not comparable, on {' and '.join(ran)}"
    notes = [
        *phrases.describe_devices(ran),
        "Median [quartiles]. own: the method's evaluation alone. frame: whole frames, primary "
        "visibility and shading included. LPIPS: mean over views [95 % bootstrap interval].",
    ]
    if published:
        notes.append("*thesis*: its printed number; its times are of another machine.")
        notes += [
            f"*thesis*: sizes only for {scene}; it did not measure the mesh {mesh['name']}."
            for scene, mesh in described.items()
            if not mesh["thesis_mesh"]
        ]
    else:
        columns = {name: cells for name, cells in columns.items() if not name.startswith("thesis")}
    notes += [
        *quality_cells.describe_learned(table),
        *map(phrases.describe_times, timed.values()),
        "A shadow map is rendered whole in each frame; its size is 4 N² bytes. Ray tracing "
        "traces a shadow ray from each pixel facing the light.",
        phrases.describe_lpips(lpips, beside_flip=False),
    ]
    title = phrases.titled(title, published)
    return Table(table, columns, notes, title, text_columns=2)
