"""The one page that shows a run: facts, claims, tables, figures, and frames to compare."""

import base64
import io
import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import jinja2
import numpy as np
from markdown_it import MarkdownIt
from markdown_it.token import Token
from markupsafe import Markup
from PIL import Image

from neural_shadows.errors import InputError
from neural_shadows.evaluation.first_frames import FirstFrame, read_first_frames
from neural_shadows.evaluation.method_names import is_shadow_map, resolution_of
from neural_shadows.files.broken import broken
from neural_shadows.files.whole_files import write_text
from neural_shadows.meshes.mesh_report import read_mesh_report
from neural_shadows.metrics.flip import Flip
from neural_shadows.metrics.lpips_choice import read_lpips_choice
from neural_shadows.reports.phrases import describe_mesh
from neural_shadows.reports.run_facts import run_facts
from neural_shadows.training.record import read_training

LARGEST_SVG = 300_000  # bytes; a larger one is shown as pixels
MAP_LEVELS = 64  # of a FLIP map: steps of 0.016, and files a third as large as of 256
SCORES = {"lpips": "LPIPS {:.4f}", "psnr": "PSNR {:.2f} dB", "flip": "FLIP {:.4f}"}
VERDICTS = ("supported", "contradicted", "undecided")


@dataclass(frozen=True)
class Block:
    """A part of the page with a heading: `key` is its anchor, `html` its content."""

    key: str
    title: str
    html: Markup


def method_name(method: str) -> str:
    """What a method is called where no table gives it a label."""
    if method == "reference":
        return "Reference"
    if is_shadow_map(method):
        return f"{resolution_of(method)}² shadow map"
    return f"network {method}"


def table_block(path: Path) -> Block:
    """A Markdown twin as HTML; the thesis's columns and verdicts get classes of their own.

    Raises:
        InputError: the file is missing, or holds no table under a heading.
    """
    try:
        text = path.read_text(encoding="utf-8")
    except (OSError, ValueError) as error:
        raise InputError(f"{path}: cannot be read ({error}); run the table") from error
    markdown = MarkdownIt("commonmark", {"html": False}).enable("table")
    tokens = markdown.parse(text)
    if [token.type for token in tokens[:1]] != ["heading_open"] or not any(
        token.type == "table_open" for token in tokens
    ):
        raise InputError(f"{path}: holds no table under a heading: delete it and run again")
    _mark_cells(tokens)
    html = markdown.renderer.render(tokens[3:], markdown.options, {})
    title = tokens[1].content
    # It scrolls: Chromium lets the keyboard reach it by itself, Safari needs the tabindex.
    box = Markup('<div class="scroll" role="region" tabindex="0" aria-label="{}">').format(title)
    html = html.replace("<table>", f"{box}<table>").replace("</table>", "</table></div>")
    return Block(path.stem, title, Markup(html))


def _mark_cells(tokens: Sequence[Token]) -> None:
    """Set the classes of table cells by what their column or they say."""
    thesis: set[int] = set()
    column = 0
    for token, inside in zip(tokens, tokens[1:]):
        if token.type == "tr_open":
            column = 0
        elif token.type in ("th_open", "td_open"):
            if token.type == "th_open" and inside.content.startswith("thesis"):
                thesis.add(column)
            verdict = inside.content.strip("*")
            if column in thesis:
                token.attrSet("class", "thesis")
            elif token.type == "td_open" and verdict in VERDICTS:
                token.attrSet("class", verdict)
            column += 1


def figure_block(title: str, svg: Path, png: Path) -> Block:
    """A figure as an image: the SVG if it is small, or else the PNG as WebP, half its size.

    The number of a figure of the thesis comes from its name: `figure_4_3` is figure 4.3.

    Raises:
        InputError: a file is missing; or the PNG is not whole, and moved aside.
    """
    try:
        if svg.stat().st_size <= LARGEST_SVG:
            source = _data_uri("svg+xml", svg.read_bytes())
        else:
            source = _webp_of(png)
    except OSError as error:
        raise InputError(
            f"{error.filename}: cannot be read ({error.strerror}); run the figure"
        ) from error
    html = Markup('<img alt="{}" src="{}">').format(title, source)
    if number := re.fullmatch(r"figure_(\d)_(\d+)", svg.stem):
        title = f"Figure {number[1]}.{number[2]}: {title}"
    return Block(svg.stem, title, html)


def _webp_of(png: Path) -> str:
    content = io.BytesIO(png.read_bytes())
    try:
        with Image.open(content, formats=["PNG"]) as image:
            return _webp(image)
    except (OSError, ValueError, SyntaxError, Image.DecompressionBombError) as error:
        # What Pillow says of a file in memory names the memory.
        raise broken(png, f"not a whole picture ({type(error).__name__})") from error


def _data_uri(kind: str, content: bytes) -> str:
    return f"data:image/{kind};base64,{base64.b64encode(content).decode()}"


def _webp(image: Image.Image) -> str:
    file = io.BytesIO()
    # Effort, not loss: 100 takes 1.3 s for a frame of 600 × 400 and 75 0.25 s, for 3 % more bytes.
    image.save(file, "WEBP", lossless=True, quality=75, method=6)
    return _data_uri("webp", file.getvalue())


def map_picture(error: np.ndarray) -> Image.Image:
    """A FLIP map (H, W) in [0, 1] in the colours of magma, black for none."""
    from matplotlib import colormaps

    level = np.round(np.clip(error, 0, 1) * (MAP_LEVELS - 1)) / (MAP_LEVELS - 1)
    return Image.fromarray((255 * colormaps["magma"](level)[..., :3]).round().astype(np.uint8))


def comparison(scene: str, title: str, frames: Sequence[FirstFrame]) -> dict[str, Any]:
    """A scene's frames and FLIP maps as plain data for the page's script.

    The maps show each method against the reference.
    """
    methods = list(frames[0].images)
    methods.sort(key=lambda method: method != "reference")
    views = []
    for frame in frames:
        reference = frame.images["reference"].astype(np.float32) / 255
        height, width = reference.shape
        flip = Flip(reference)
        pictures = {}
        for method, image in frame.images.items():
            scores = frame.scores.get(method, {})
            error = flip.error_map(image.astype(np.float32) / 255)
            pictures[method] = {
                "frame": _webp(Image.fromarray(image)),
                "map": _webp(map_picture(error)),
                "scores": ", ".join(
                    text.format(scores[name]) for name, text in SCORES.items() if name in scores
                ),
            }
        views.append(
            {"caption": frame.caption, "width": width, "height": height, "pictures": pictures}
        )
    networks = [name for name in methods if name != "reference" and not is_shadow_map(name)]
    return {
        "scene": scene,
        "title": title,
        "methods": [{"key": method, "name": method_name(method)} for method in methods],
        "left": (networks or methods[1:] or methods)[0],
        "right": "reference",
        "views": views,
    }


def render_page(
    templates: Path,
    *,
    title: str,
    facts: Sequence[tuple[str, str]],
    claims: Block | None,
    comparisons: Sequence[Mapping[str, Any]],
    tables: Sequence[Block],
    figures: Sequence[Block],
    beyond: Sequence[Block],
) -> str:
    """The page as one self-contained HTML text: no other file and no network is asked for.

    Args:
        templates: the folder of `template.html`, `style.css` and `script.js`.
        beyond: tables and figures of what is not the thesis's.
    """
    environment = jinja2.Environment(
        loader=jinja2.FileSystemLoader(templates),
        autoescape=True,
        undefined=jinja2.StrictUndefined,
        trim_blocks=True,
        lstrip_blocks=True,
    )
    return environment.get_template("template.html").render(
        title=title,
        style=Markup((templates / "style.css").read_text(encoding="utf-8")),
        script=Markup((templates / "script.js").read_text(encoding="utf-8")),
        facts=facts,
        claims=claims,
        comparisons=comparisons,
        tables=tables,
        figures=figures,
        beyond=beyond,
    )


def write_html_report(
    html: Path,
    templates: Path,
    *,
    scale: str,
    seed: int,
    frames: str,
    tables: Sequence[Path],
    figures: Mapping[str, str],
    beyond: Sequence[str],
    claims: Path | None,
    pictures: Mapping[str, Sequence[Path]],
    metrics: Mapping[str, Sequence[Path]],
    meshes: Mapping[str, Path],
    procedural: Mapping[str, bool],
    trainings: Sequence[Path],
    lpips_json: Path,
    benchmarks: Path,
    folder: Path,
) -> None:
    """Write the report of a run.

    Args:
        frames: what is rendered, as a phrase.
        tables: Markdown twins, in order; `claims`: that of the claims.
        figures: titles by path without ending; `.svg` and `.png` of each are there.
        beyond: names of the tables and figures that are not the thesis's.
        pictures, metrics: by scene, the first batches of its evaluations.
        meshes: descriptions by scene; `procedural`: whether the pipeline made the mesh.
        trainings: records of all trainings.
        benchmarks: Snakemake's, a folder for each rule; `folder`: the checkout.

    Raises:
        InputError: a file is missing or not whole.
    """
    described = {
        scene: describe_mesh(read_mesh_report(path), procedural[scene])
        for scene, path in meshes.items()
    }
    facts = run_facts(
        scale=scale,
        seed=seed,
        frames=frames,
        meshes=described,
        records=[read_training(path) for path in trainings],
        lpips=read_lpips_choice(lpips_json),
        benchmarks=benchmarks,
        folder=folder,
    )
    table_blocks = [table_block(path) for path in tables]
    figure_blocks = [
        figure_block(title, Path(f"{name}.svg"), Path(f"{name}.png"))
        for name, title in figures.items()
    ]
    page = render_page(
        templates,
        title=f"Neural Shadow Ray Queries: {scale} scale",
        facts=facts,
        claims=table_block(claims) if claims else None,
        comparisons=[
            comparison(
                scene,
                f"{scene}: {described[scene]}",
                read_first_frames(pictures[scene], metrics[scene]),
            )
            for scene in pictures
        ],
        tables=[block for block in table_blocks if block.key not in beyond],
        figures=[block for block in figure_blocks if block.key not in beyond],
        beyond=[block for block in table_blocks + figure_blocks if block.key in beyond],
    )
    write_text(html, page)
