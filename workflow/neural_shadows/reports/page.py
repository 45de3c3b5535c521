"""The one page that shows a run: facts, claims, tables, figures, and frames to compare."""

from collections import Counter
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

import jinja2
from markupsafe import Markup

from neural_shadows.files.whole_files import write_text
from neural_shadows.reports.frame_comparison import frame_comparisons
from neural_shadows.reports.inputs import read_meshes
from neural_shadows.reports.page_blocks import figure_blocks, table_block
from neural_shadows.reports.phrases import describe_mesh
from neural_shadows.reports.run_facts import run_facts
from neural_shadows.running.stage import run_stage


def write_page(
    *,
    html: Path,
    template: list[Path],
    tables: list[Path],
    figures: list[Path],
    claims_md: Path | None,
    references: list[Path],
    visibilities: list[Path],
    metrics: list[Path],
    meshes: list[Path],
    trainings: list[Path],
    lpips_json: Path | None,
    titles: Mapping[str, str],
    beyond: Sequence[str],
    rows: Sequence[Mapping[str, Any]],
    run: Mapping[str, Any],
    scenes: Mapping[str, Mapping[str, Any]],
    benchmarks: Path,
) -> None:
    """Write the page of what is there, any of the lists may be empty, as one self-contained file.

    Args:
        template: `template.html`, `style.css` and `script.js` of one folder.
        figures: `.svg` and `.png` of each, in order; titles: of figures, by name.
        references, visibilities, metrics: of all batches of each scene, and of each method.
        beyond: names of the tables and figures that are not the thesis's.
        rows: `method`, `scene` and `label` of the methods that have pictures.
        benchmarks: Snakemake's, a folder for each rule.

    Raises:
        InputError: a file is missing or not whole.
    """
    described = {s: describe_mesh(mesh, scenes[s]) for s, mesh in read_meshes(meshes).items()}
    claims = table_block(claims_md) if claims_md else None
    blocks = [table_block(path) for path in tables]
    drawings = figure_blocks(figures, titles)
    # Notes that several tables have are shown once, before all tables.
    notes = Counter(note for block in [claims, *blocks] if block for note in block.notes)
    folder = template[0].parent
    environment = jinja2.Environment(
        loader=jinja2.FileSystemLoader(folder), autoescape=True, undefined=jinja2.StrictUndefined
    )
    page = environment.get_template("template.html").render(
        title=f"Neural Shadow Ray Queries: {run['scale']} scale",
        style=Markup((folder / "style.css").read_text(encoding="utf-8")),
        script=Markup((folder / "script.js").read_text(encoding="utf-8")),
        facts=run_facts(run, described, trainings, lpips_json, benchmarks),
        claims=claims,
        comparisons=frame_comparisons(references, visibilities, metrics, rows, described),
        tables=[block for block in blocks if block.name not in beyond],
        figures=[block for block in drawings if block.name not in beyond],
        beyond=[block for block in blocks + drawings if block.name in beyond],
        shared_notes=[note for note, count in notes.items() if count > 1],
    )
    write_text(html, page)


if "snakemake" in globals():
    run_stage(snakemake, write_page)
