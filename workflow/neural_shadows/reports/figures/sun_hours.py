"""Hours of sun as colour on meshes seen from above aslant."""

from pathlib import Path
from typing import Any, Literal

import numpy as np
from pydantic import Field

from neural_shadows.files.whole_files import read_json
from neural_shadows.layout.layout import Layout
from neural_shadows.reports.drawing.style import Figure, new_figure, note_below
from neural_shadows.reports.tables import sun_hours
from neural_shadows.sections.table_figures import TableFigure

COLOURS = "inferno"
DARKEST = 0.25  # of a colour where no sky is seen
WIDTH, HIGHEST = 9.0, 8.0  # inches of a picture
MARGIN = 0.02  # around a mesh, in widths of its picture


class Settings(TableFigure):
    """Hours of sun as colour, dimmed by the sky that is seen."""

    tables = (sun_hours.Settings,)
    kind: Literal["sun_hours"] = Field(description="`sun_hours`")


def files(layout: Layout, figure: str) -> dict[str, Any]:
    table = layout.entry("figures", figure)["table"]
    scenes = layout.entry("tables", table)["scenes"]
    return {
        "pictures": [layout.paths.sun_hours("npz", table, scene) for scene in scenes],
        "measured": [layout.paths.sun_hours("json", table, scene) for scene in scenes],
        "meshes": [layout.paths.scene("mesh.json", scene) for scene in scenes],
    }


def draw(pictures: list[Path], measured: list[Path], meshes: list[Path], heading: str) -> Figure:
    """Draw the pictures of `measure_sun_hours`, one below the other, with one scale."""
    from matplotlib import colormaps
    from matplotlib.cm import ScalarMappable
    from matplotlib.colors import Normalize

    records = [read_json(path) for path in measured]
    shown = [_cropped(path) for path in pictures]
    longest = max(np.nanmax(hours, initial=0.0) for hours, _ in shown) or 1.0
    scale = Normalize(0, longest)
    heights = [min(WIDTH * hours.shape[0] / hours.shape[1], HIGHEST) for hours, _ in shown]
    figure = new_figure(heading, WIDTH + 0.9, sum(heights) + 1.2)
    panels = figure.subplots(len(shown), squeeze=False, height_ratios=heights)[:, 0]
    for axes, (hours, sky), path, record in zip(panels, shown, meshes, records):
        name, faces = read_json(path)["name"], record["faces"]
        axes.set_title(f"{name}, {faces:,} triangles", loc="left", fontsize=11)
        axes.imshow(
            shaded(colormaps[COLOURS](scale(hours)), hours, sky), interpolation="antialiased"
        )
        axes.set_axis_off()
    bar = figure.colorbar(ScalarMappable(scale, COLOURS), ax=panels, fraction=0.025, aspect=40)
    bar.set_label("hours of direct sun")
    first = records[0]
    note_below(
        figure,
        f"Day {first['day']} of the year at {first['latitude']:g}° north, without clouds; seen from the "
        "south-west. Darker: less of the sky is seen. All shadow rays go through the meshes' fields.",
    )
    return figure


def shaded(colours: np.ndarray, hours: np.ndarray, sky: np.ndarray) -> np.ndarray:
    """Dim colours (H, W, 4) by the sky seen; white where there is no surface."""
    light = DARKEST + (1 - DARKEST) * np.sqrt(np.clip(sky, 0, 1))
    image = colours[..., :3] * light[..., None]
    image[np.isnan(hours)] = 1
    return image


def _cropped(path: Path) -> tuple[np.ndarray, np.ndarray]:
    """Hours and sky of a picture, without its empty margins."""
    with np.load(path, allow_pickle=False) as arrays:
        hours, sky = arrays["hours"], arrays["sky"]
    margin = int(MARGIN * hours.shape[1])
    seen = ~np.isnan(hours)
    ends = []
    for axis in (0, 1):
        places = np.flatnonzero(seen.any(axis=1 - axis))
        first, last = (places[0], places[-1] + 1) if len(places) else (0, hours.shape[axis])
        ends.append(slice(max(first - margin, 0), last + margin))
    return hours[tuple(ends)], sky[tuple(ends)]
