"""Modelled over measured widths of penumbrae [Datta et al., 3.6]."""

from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any, ClassVar, Literal

import numpy as np
from pydantic import Field

from neural_shadows.evaluation.look import COLOURS
from neural_shadows.layout.layout import Layout
from neural_shadows.layout.soft_methods import all_generators, all_meshes, first_tests
from neural_shadows.reports.drawing import figure_inputs
from neural_shadows.reports.drawing.style import GRID, new_figure, write_figure
from neural_shadows.running.stage import run_stage
from neural_shadows.sections.any_report import AnyFigure, Chapter
from neural_shadows.sections.own_frames import OwnFrames
from neural_shadows.sections.sections import Sections
from neural_shadows.settings.base import name_in
from neural_shadows.settings.records import Run

if TYPE_CHECKING:
    from matplotlib.figure import Figure

SHOWN = 4000  # points a radius


class Settings(AnyFigure):
    """Widths of penumbrae by the model, over measured widths."""

    chapter: ClassVar[Chapter] = "soft"

    kind: Literal["penumbra_model"] = Field(description="`penumbra_model`")
    frame_set: name_in("frame_sets") = Field(description="a name in `frame_sets`")

    def check(self, config: Sections, key: str) -> None:
        if isinstance(config.frame_sets[self.frame_set], OwnFrames):
            raise ValueError(
                f"{key}.frame_set: {self.frame_set!r} is of a user's own frames, which have "
                "no scene. Choose another frame set"
            )


def files(layout: Layout, figure: str) -> dict[str, Any]:
    frame_set = layout.entry("figures", figure)["frame_set"]
    return {"parts": first_tests(layout, frame_set), "meshes": all_meshes(layout, frame_set)}


params = figure_inputs.run


def generators(layout: Layout, figure: str) -> list[str]:
    return all_generators(layout, layout.entry("figures", figure)["frame_set"])


def draw(
    parts: list[Path], meshes: list[Path], png: Path, svg: Path, *, title: str, run: Run
) -> None:
    """Draw modelled over measured widths of penumbra pixels.

    Args:
        parts: of test frames; the first of each is used. meshes: see `measured_frames`.

    Raises:
        InputError: a file is missing or not whole.
    """
    from neural_shadows.evaluation.measured_frames import measured_frames
    from neural_shadows.evaluation.measured_penumbrae import widths

    frames = [frame for frame in measured_frames(parts, meshes) if frame.number == 0]
    radii = frames[0].part.radii
    pairs_by_radius = {
        radius: np.concatenate([widths(frame, k) for frame in frames], axis=1)
        for k, radius in enumerate(radii)
        if radius > 0
    }
    title = f"{title} ({run['scale']} scale)"
    figure = model_figure(pairs_by_radius, title=title, seed=run["seed"])
    write_figure(figure, png, svg)


def model_figure(pairs_by_radius: dict[float, np.ndarray], *, title: str, seed: int) -> "Figure":
    """Draw a cloud of points for each radius.

    Args:
        pairs_by_radius: measured and modelled widths (2, n), pixels.
    """
    from neural_shadows.evaluation.measured_penumbrae import NARROWEST

    figure = new_figure(title, 6.5, 6.2)
    axes = figure.subplots()
    rng = np.random.default_rng(seed)
    for (radius, pairs), colour in zip(pairs_by_radius.items(), COLOURS):
        if not pairs.size:
            continue
        shown = pairs[:, rng.permutation(pairs.shape[1])[:SHOWN]]
        largest = np.percentile(pairs[1], 95)
        label = (
            f"{radius:.3g} m: model ≥ measured in {100 * np.mean(pairs[1] >= pairs[0]):.0f} % of "
            f"pixels, ratio {np.median(pairs[1] / pairs[0]):.2g}, 95 % of widths ≤ {largest:.0f} px"
        )
        axes.plot(*shown, ".", color=colour, markersize=1.5, alpha=0.5, rasterized=True)
        axes.plot([], [], "o", color=colour, label=label)
    ends = _ends(pairs_by_radius.values())
    axes.plot(ends, ends, color="#777777", linewidth=0.8, label="equal")
    axes.set(xscale="log", yscale="log", xlim=ends, ylim=ends, aspect="equal")
    axes.set(xlabel="measured width, pixels", ylabel="width by the model, pixels")
    axes.grid(**GRID)
    if not any(pairs.size for pairs in pairs_by_radius.values()):
        none = f"No penumbra of these frames\nis {NARROWEST:g} pixels wide."
        axes.text(0.05, 0.9, none, transform=axes.transAxes, va="top")
    figure.legend(loc="outside lower left", fontsize=8)
    return figure


def _ends(widths: Sequence[np.ndarray]) -> tuple[float, float]:
    values = np.concatenate([pairs.ravel() for pairs in widths] or [np.ones(1)])
    return (1.0, float(max(values.max(initial=10.0), 10.0)))


if "snakemake" in globals():
    run_stage(snakemake, draw)
