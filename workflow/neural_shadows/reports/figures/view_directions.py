"""View directions of each sampler, with their spectra (figure 3.4)."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from neural_shadows.reports.figures.direction_spectrum import angular_power_spectrum
from neural_shadows.reports.figures.drawing import (
    BLUE,
    ORANGE,
    SHOWN_DIRECTIONS,
    _drawn,
    _hemisphere,
)

if TYPE_CHECKING:
    from matplotlib.figure import Figure

DEGREES = 80  # of the spectra: 1000 Poisson-disk directions have their ring near degree 50


def _view_directions(figure: Figure, seed: int) -> None:
    samplers = {"poisson_quadtree": "Poisson-disk", "uniform": "uniform"}
    grid = figure.add_gridspec(2, 2, height_ratios=(3, 2))
    spectrum = figure.add_subplot(grid[1, :])
    for column, (sampler, label) in enumerate(samplers.items()):
        directions = _drawn(sampler, seed)
        axes = figure.add_subplot(grid[0, column])
        _hemisphere(axes, directions, f"{label} (a hemisphere of {SHOWN_DIRECTIONS} directions)")
        power = angular_power_spectrum(directions, DEGREES)
        colour = (BLUE, ORANGE)[column]
        spectrum.plot(np.arange(1, DEGREES + 1), power, color=colour, marker=".", label=label)
    spectrum.axhline(1, color="grey", linestyle="--", linewidth=1, label="expected of uniform")
    spectrum.set_ylim(bottom=0)
    spectrum.set_xlabel("degree of the spherical harmonics")
    spectrum.set_ylabel("power")
    spectrum.grid(linewidth=0.4, alpha=0.4)
    spectrum.legend()
