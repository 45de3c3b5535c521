"""A viewer's page from its template."""

import io
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import jinja2
import numpy as np
from markupsafe import Markup
from PIL import Image

from neural_shadows.files.whole_files import write_text
from neural_shadows.reports.page.blocks import data_uri
from neural_shadows.running import progress
from neural_shadows.scenes.cameras import Camera, Viewpoint


def fill_template(
    template: Sequence[Path], page: str, *, poster: Image.Image, **values: Any
) -> str:
    """One HTML file of a template's files.

    Args:
        page: name of its HTML file, whose folder's main.js and style come last.
        poster: shown while the viewer starts. values: of the page.
    """
    (html,) = (path for path in template if path.name == page)
    own_last = sorted(
        template, key=lambda path: (path.parent == html.parent, path.name == "main.js")
    )
    environment = jinja2.Environment(
        loader=jinja2.FileSystemLoader({path.parent for path in template}),
        autoescape=True,
        undefined=jinja2.StrictUndefined,
    )
    return environment.get_template(page).render(
        style=_text(own_last, ".css"),
        script=_text(own_last, ".js"),
        poster=_jpeg(poster),
        **values,
    )


def write_html(html: Path, page: str, most_bytes: int, advice: str) -> None:
    """Write a page; of a large one print a line with advice."""
    if len(page) > most_bytes:
        large = f"{len(page):,} bytes, more than {most_bytes:,}, is slow to open"
        print(f"{html}: {large}. {advice}", file=progress.TERMINAL)
    write_text(html, page)


def shown_view(name: str, camera: Camera | Viewpoint, light: np.ndarray) -> dict[str, Any]:
    """A view by name: its camera, and the light's place or direction."""
    places = {"eye": camera.eye, "target": camera.target, "light": light}
    return {"name": name, "fov": camera.fov, **{k: place.tolist() for k, place in places.items()}}


def shaders(template: Sequence[Path]) -> dict[str, str]:
    """Shaders by name: `field` for field.glsl, `surface_vert` for surface.vert."""
    found = {}
    for path in template:
        if path.suffix in (".vert", ".frag"):
            found[f"{path.stem}_{path.suffix[1:]}"] = path.read_text(encoding="utf-8")
        elif path.suffix == ".glsl":
            found[path.stem] = path.read_text(encoding="utf-8")
    return found


def _text(template: Sequence[Path], suffix: str) -> Markup:
    """Joined files of one suffix."""
    texts = [path.read_text(encoding="utf-8") for path in template if path.suffix == suffix]
    return Markup("\n".join(texts))


def _jpeg(image: Image.Image) -> str:
    """Image as a data URI."""
    file = io.BytesIO()
    image.save(file, "JPEG", quality=80)
    return data_uri("image/jpeg", file.getvalue())
