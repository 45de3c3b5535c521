"""The page of a run: claims, frames, tables, figures and facts."""

import re
from collections import Counter
from collections.abc import Mapping, Sequence
from html import unescape
from pathlib import Path
from typing import Any

import jinja2
from markupsafe import Markup
from PIL import Image

from neural_shadows.evaluation.registry import LABELS, NETWORK_LOOK, look_of
from neural_shadows.files.whole_files import write_text
from neural_shadows.reports.data.inputs import read_by_folder
from neural_shadows.reports.data.method_look import look_of_kind
from neural_shadows.reports.data.phrases import describe_mesh
from neural_shadows.reports.data.run_command import run_command
from neural_shadows.reports.page.blocks import lossy_uri, pictures_once
from neural_shadows.reports.page.chapters import chapters as page_chapters
from neural_shadows.reports.page.claim_cards import budget, by_source, counted, read_cards
from neural_shadows.reports.page.figure_blocks import figure_blocks, themed
from neural_shadows.reports.page.findings import findings
from neural_shadows.reports.page.hard_comparison import hard_comparisons
from neural_shadows.reports.page.run_facts import run_facts, run_sentence
from neural_shadows.reports.page.soft_comparison import soft_comparisons
from neural_shadows.reports.page.table_blocks import has_printed, table_block
from neural_shadows.running.stage import run_stage
from neural_shadows.settings.records import Row, Run, SceneInfo

POSTER_QUALITY = 60
SCRIPTS = ("reading.js", "hard_frames.js", "soft_frames.js", "frames.js")


def write_page(
    *,
    html: Path,
    template: list[Path],
    tables: list[Path],
    figures: list[Path],
    viewers: list[Path],
    soft_viewers: Sequence[str],
    claims_json: Path | None,
    references: list[Path],
    visibilities: list[Path],
    metrics: list[Path],
    soft_parts: list[Path],
    soft_answers: list[Path],
    meshes: list[Path],
    trainings: list[Path],
    lpips_json: Path | None,
    titles: Mapping[str, str],
    data: Mapping[str, str],
    chapters: Mapping[str, str],
    questions: Sequence[Mapping[str, str]],
    networks: Sequence[str],
    soft_pictures: Sequence[Mapping[str, Any]],
    folded: Sequence[str],
    missing: Sequence[str],
    rows: Sequence[Row],
    kinds: Mapping[str, str],
    run: Run,
    scenes: Mapping[str, SceneInfo],
    benchmarks: Path,
) -> None:
    """Write the page as one file, which links to the viewers beside it.

    Any of the lists may be empty.

    Args:
        template: `template.html`, `style.css` and `SCRIPTS`, of one folder.
        tables: JSON, with a CSV beside each, as beside `claims_json`.
        figures: `.svg` and `.png` of each, in order; titles: of figures, by name.
        viewers: HTML in the page's folder, with a poster, a PNG, beside the first, which the page
            opens within itself; 2 to 6 MB each. Links lead to all.
        soft_viewers: names of those under an area light.
        references, visibilities, metrics: of all batches of each scene, and of each method.
        soft_parts, soft_answers, soft_pictures: see `soft_comparisons`.
        data: the tables that figures show, by the figures' names.
        chapters: of the tables and figures, by name: a key of `chapters.CHAPTERS`.
        questions: see `findings`.
        networks: labels of screen-space networks.
        folded: names of collapsed figures: contact sheets.
        missing: reports and frames of a whole run that are not made yet.
        rows: `method`, `scene` and `label` of the methods with pictures.
        kinds: of methods (`method_look.kind_of`), by label.
        benchmarks: Snakemake's, a folder for each rule.

    Raises:
        InputError: a file is missing or not whole.
    """
    described = {s: describe_mesh(mesh, scenes[s]) for s, mesh in read_by_folder(meshes).items()}
    scenes = {scene: scenes[scene] for scene in described}
    looks = {label: look_of_kind(kind) for label, kind in kinds.items()}
    claims = table_block(claims_json, looks) if claims_json else None
    claims_csv = claims_json.with_suffix(".csv") if claims_json else None
    cards = read_cards(claims_csv) if claims_csv else []
    soft_looks = {label: look_of(method) for method, label in LABELS.items()}
    soft_looks |= dict.fromkeys(networks, NETWORK_LOOK)
    blocks = [table_block(path, soft_looks | looks) for path in tables]
    by_name = {block.name: block for block in blocks}
    shown = {figure: by_name[table] for figure, table in data.items() if table in by_name}
    drawings = figure_blocks(figures, titles, shown)
    meshes_text = f"{[*scenes.values()][0]['mesh_name']}, " if scenes else ""
    # Notes of several tables are shown once.
    notes = Counter(note for block in [claims, *blocks] if block for note in block.notes)
    facts = run_facts(run, described, trainings, lpips_json, benchmarks)
    comparisons, pictures = pictures_once(
        [
            *hard_comparisons(references, visibilities, metrics, rows, described),
            *soft_comparisons(soft_parts, soft_answers, soft_pictures),
        ]
    )
    folder = template[0].parent
    environment = jinja2.Environment(
        loader=jinja2.FileSystemLoader(folder),
        autoescape=True,
        undefined=jinja2.StrictUndefined,
        trim_blocks=True,
        lstrip_blocks=True,
    )
    environment.filters["themed"] = themed
    scripts = [(folder / name).read_text(encoding="utf-8") for name in SCRIPTS]
    page = environment.get_template("template.html").render(
        title=f"Neural shadows: {meshes_text}{run['scale']} scale",
        reproduction=bool(claims or any(map(has_printed, blocks))),
        style=Markup((folder / "style.css").read_text(encoding="utf-8")),
        script=Markup("\n".join(scripts)),
        sentence=run_sentence(run, scenes, facts),
        facts=facts,
        command=run_command(),
        folded=folded,
        claims=claims,
        findings=findings(questions, cards, figures, titles),
        cards={source: (own, counted(own)) for source, own in by_source(cards).items()},
        verdicts=counted(cards),
        budget=budget(claims_csv) if claims_csv else "",
        viewers=[
            {"file": path.name, "title": _title(path), "soft": path.stem in soft_viewers}
            for path in viewers
        ],
        poster=_poster(viewers[0].with_suffix(".png")) if viewers else None,
        missing=missing,
        comparisons=comparisons,
        pictures=pictures,
        chapters=page_chapters(blocks, drawings, chapters),
        shared_notes=[note for note, count in notes.items() if count > 1],
    )
    write_text(html, page)


def _poster(png: Path) -> str:
    """A viewer's poster as an address within the page."""
    with Image.open(png) as image:
        return lossy_uri(image.convert("RGB"), POSTER_QUALITY)


def _title(html: Path) -> str:
    """Title of a viewer, which stands in its first lines."""
    with html.open(encoding="utf-8") as file:
        (title,) = re.findall("<title>(.*?)</title>", file.read(2000))
    return unescape(title)


if "snakemake" in globals():
    run_stage(snakemake, write_page)
