"""View directions of each sampler, with their spectra (figure 3.3)."""

from typing import Literal

import numpy as np
from numpy.polynomial.legendre import legvander
from pydantic import Field

from neural_shadows.evaluation.look import BLUE, ORANGE
from neural_shadows.rays.streams import DIRECTIONS
from neural_shadows.reports.drawing.style import GRID, Figure, new_figure
from neural_shadows.sections.any_report import AnyFigure

DEGREES = 80  # of the spectra: 1000 Poisson-disk directions have their ring near degree 50


class Settings(AnyFigure):
    """View directions by sampler, and their spectra [figure 3.3]."""

    kind: Literal["view_directions"] = Field(description="`view_directions`")


def draw(title: str, seed: int) -> Figure:
    """Draw each sampler's directions, and below their spectra."""
    from neural_shadows.rays.poisson_disk import sphere_directions
    from neural_shadows.reports.drawing.drawing import SHOWN_DIRECTIONS, draw_hemisphere

    figure = new_figure(title, 11, 9.6)
    uniform = np.random.default_rng((seed, DIRECTIONS)).normal(size=(SHOWN_DIRECTIONS, 3))
    uniform /= np.linalg.norm(uniform, axis=1, keepdims=True)
    poisson = sphere_directions(SHOWN_DIRECTIONS, (seed, DIRECTIONS))[0]
    panels = figure.subplot_mosaic(
        [["Poisson-disk", "uniform"], ["spectrum"] * 2], height_ratios=(3, 2)
    )
    spectrum = panels["spectrum"]
    for label, directions, colour in (
        ("Poisson-disk", poisson, BLUE),
        ("uniform", uniform, ORANGE),
    ):
        heading = f"{label} (a hemisphere of {SHOWN_DIRECTIONS} directions)"
        draw_hemisphere(panels[label], directions, heading)
        power = angular_power_spectrum(directions, DEGREES)
        spectrum.plot(np.arange(1, DEGREES + 1), power, color=colour, marker=".", label=label)
    spectrum.axhline(1, color="grey", linestyle="--", linewidth=1, label="expected of uniform")
    spectrum.set(xlabel="degree of the spherical harmonics", ylabel="power", ylim=(0, None))
    spectrum.set_title("little power at low degrees: neither clusters nor gaps", fontsize=11)
    spectrum.grid(**GRID)
    spectrum.legend()
    return figure


def angular_power_spectrum(directions: np.ndarray, degrees: int) -> np.ndarray:
    """Power of directions by spherical-harmonic degree.

    1 is expected of independent directions. S_l = 4π / (N (2l + 1)) Σ_m |Σ_i Y_lm(x_i)|², by the
    addition theorem 1/N Σ_ij P_l(x_i · x_j). A Poisson-disk pattern has little power at low degrees:
    blue noise.

    Args:
        directions: (N, 3) unit vectors.
        degrees: the largest degree L.

    Returns:
        (L,) S_1 to S_L; S_0 is N for every set.
    """
    x = directions.astype(np.float64)
    # Row by row: all pairs of 1000 directions at 80 degrees would take 320 MB.
    rows = (legvander(x[i + 1 :] @ x[i], degrees).sum(0) for i in range(len(x)))
    return 1 + 2 * sum(rows)[1:] / len(x)
