"""Frame time, quality and size of networks over their width [4.4.1, table 4.6]."""

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

from neural_shadows.files.whole_files import read_json
from neural_shadows.reports import phrases
from neural_shadows.reports.inputs import read_meshes
from neural_shadows.reports.learned import margins
from neural_shadows.reports.published import add_printed, read_published
from neural_shadows.reports.tables import quality_cells, timing
from neural_shadows.reports.tables.quality import scenes_quality, with_ends
from neural_shadows.reports.tables.writing import interval_cells, number_cells, write_twins
from neural_shadows.running.stage import run_stage

PRINTED = ("frame_ms", "lpips", "size_kib")  # what the thesis prints, in its order


def write(
    *,
    times: list[Path],
    metrics: list[Path],
    weights: list[Path],
    meshes: list[Path],
    lpips_json: Path,
    published_csv: Path,
    csv: Path,
    md: Path,
    title: str,
    published: str | None,
    rows: Sequence[Mapping[str, Any]],
    run: Mapping[str, Any],
) -> None:
    """Write a table of frame times, in the order of `rows`.

    CSV: `method, scene`, `FRAME_MS`, `OWN_MS`, `repeats, device, lpips, lpips_low, lpips_high,
    learned, size_kib, resident_kib`, the columns of `add_printed` of the three that the thesis
    prints, and the context.
    """
    timed = {one["scene"]: one for one in map(read_json, times)}
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
    described, lpips = read_meshes(meshes), read_json(lpips_json)
    table = add_printed(table, rows, PRINTED, published, published_csv, described)
    network = lpips["net"] if lpips["available"] else None
    table = table.assign(lpips_net=network, scale=run["scale"])

    columns = {
        "scene": table["scene"],
        "method": quality_cells.method_cells(table),
        "own ms ↓": interval_cells(table, timing.OWN_MS, 1),
        "frame ms ↓": interval_cells(table, timing.FRAME_MS, 1),
        "thesis ms": number_cells(table["thesis_frame_ms"], "{:.1f}"),
        "LPIPS ↓": quality_cells.quality_cells(table, "lpips"),
        "thesis LPIPS": number_cells(table["thesis_lpips"], "{:.4f}"),
        "size KiB": number_cells(table["size_kib"], "{:.0f}"),
        "thesis KiB": number_cells(table["thesis_size_kib"], "{:.0f}"),
    }
    ran = timing.devices(timed)
    if len(ran) > 1:
        columns["device"] = table["device"]
        title = f"{title}: not comparable, on {' and '.join(ran)}"
    notes = [
        *phrases.describe_devices(ran),
        "Median [quartiles]; own: the method's answer alone; frame: whole frames, primary "
        "visibility and shading included. LPIPS: mean over views [95 % bootstrap interval].",
    ]
    if published:
        notes.append("*thesis*: the number that it prints, its times from another machine.")
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
        "A shadow map is rendered whole in each frame and its size is 4 N² bytes; ray tracing "
        "sends a shadow ray from each pixel that faces the light.",
        phrases.describe_lpips(lpips),
        phrases.describe_run(run),
    ]
    write_twins(
        table, columns, csv, md, title=phrases.titled(title, published), notes=notes, text_columns=2
    )


if "snakemake" in globals():
    run_stage(snakemake, write)
