"""The width that Neural Shadow Mapping's model gives penumbrae, beside what they measure (3.6)."""

from collections.abc import Sequence
from pathlib import Path

import numpy as np
from matplotlib.figure import Figure
from scipy.ndimage import gaussian_filter, map_coordinates, maximum_filter, minimum_filter

from neural_shadows.evaluation.measured_frames import MeasuredFrame, measured_frames
from neural_shadows.frames.penumbra_widths import model_widths
from neural_shadows.reports.figures.style import COLOURS, GRID, Section, new_figure, write_figure
from neural_shadows.running.stage import run_stage

MIDDLE = (0.35, 0.65)  # visibilities of a penumbra's middle, from which its ends are looked for …
ENDS = (0.1, 0.9)  # … which are here; 0.8 of the width lies between them
FARTHEST = 256  # pixels to an end
SMOOTH = 1.5  # pixels of the slope's Gaussian
SHOWN = 4000  # points a radius
NARROWEST = 5.0  # measured pixels: of what is narrower the pixels' own width is a part


def draw(
    parts: list[Path], meshes: list[Path], png: Path, svg: Path, *, title: str, run: Section
) -> None:
    """Draw each penumbra pixel's width by the model over its measured width, for each radius.

    Args:
        parts: of test frames; the first of each is used. meshes: see `measured_frames`.

    Raises:
        InputError: a file is missing or not whole.
    """
    frames = [one for one in measured_frames(parts, meshes) if one.number == 0]
    radii = frames[0].part.radii
    found = {
        radius: np.concatenate([widths(one, k) for one in frames], axis=1)
        for k, radius in enumerate(radii)
        if radius > 0
    }
    figure = model_figure(found, title=f"{title} ({run['scale']} scale)", seed=run["seed"])
    write_figure(figure, png, svg)


def widths(measured: MeasuredFrame, k: int) -> np.ndarray:
    """Measured width and the model's, in pixels, of a frame's pixels in a penumbra's middle: (2, n).

    Measured is the way along the slope on which visibility goes from 10 to 90 %, times 1.25. Left out
    are penumbrae that end at another surface or the frame's side before, as where several overlap,
    and narrow ones.
    """
    frame, target = measured.frame, measured.target[k]
    surface = frame.surface
    depth = surface.depth_image()
    near = maximum_filter(depth, 5) - minimum_filter(depth, 5) < 0.03 * depth
    near &= measured.valid
    middle = (target > MIDDLE[0]) & (target < MIDDLE[1]) & near
    chosen = np.flatnonzero(middle.ravel()[surface.pixel])
    places = np.divmod(surface.pixel[chosen], surface.width)
    across = measured_widths(target, near, np.array(places))
    chosen, across = chosen[across >= NARROWEST], across[across >= NARROWEST]
    radius, focal = measured.part.radii[k], surface.camera.focal(surface.height)
    pixels = model_widths(frame.scene, surface, frame.centre, radius, focal, chosen)
    return np.stack([across, pixels])


def measured_widths(target: np.ndarray, near: np.ndarray, places: np.ndarray) -> np.ndarray:
    """The width of the penumbra through each place, (n,) pixels; NaN where it has no end.

    Args:
        target: visibility (H, W). near: (H, W) bool, what lies on one surface. places: rows and
            columns, (2, n).
    """
    slope = np.stack([gaussian_filter(target, SMOOTH, order) for order in ((1, 0), (0, 1))])
    way = slope[:, places[0], places[1]]
    way = way / np.maximum(np.linalg.norm(way, axis=0), 1e-9)
    return 1.25 * sum(
        _way_to_end(target, near, places, sign * way, end) for sign, end in zip((-1, 1), ENDS)
    )


def _way_to_end(target, near, places, way, end: float) -> np.ndarray:
    """How far along each way (2, n) visibility reaches an end, (n,) pixels; NaN if it does not."""
    found = np.full(places.shape[1], np.nan)
    alive = np.ones(places.shape[1], bool)
    for step in range(1, FARTHEST):
        place = places[:, alive] + step * way[:, alive]
        pixel = np.rint(place).astype(int)
        inside = ((pixel >= 0) & (pixel < np.array(target.shape)[:, None])).all(0)
        inside[inside] = near[tuple(pixel[:, inside])]
        value = map_coordinates(target, place, order=1, mode="nearest")
        there = inside & ((value - end) * (end - 0.5) >= 0)
        index = np.flatnonzero(alive)
        found[index[there]] = step - 0.5  # somewhere in it
        alive[index[there | ~inside]] = False
    return found


def model_figure(found: dict[float, np.ndarray], *, title: str, seed: int) -> Figure:
    """A panel with a cloud of points for each radius, and the share that the model does not exceed."""
    figure = new_figure(title, 6.5, 6.2)
    axes = figure.subplots()
    rng = np.random.default_rng(seed)
    for (radius, pairs), colour in zip(found.items(), COLOURS):
        pairs = pairs[:, (pairs > 0).all(0)]
        if not pairs.size:
            continue
        some = pairs[:, rng.permutation(pairs.shape[1])[:SHOWN]]
        wide = np.percentile(pairs[1], 95)
        label = (
            f"{radius:.3g} m: model ≥ measured in {100 * np.mean(pairs[1] >= pairs[0]):.0f} % of "
            f"pixels, ratio {np.median(pairs[1] / pairs[0]):.2g}, 95 % of its widths ≤ {wide:.0f} px"
        )
        axes.plot(*some, ".", color=colour, markersize=1.5, alpha=0.5, rasterized=True)
        axes.plot([], [], "o", color=colour, label=label)
    ends = _ends(found.values())
    axes.plot(ends, ends, color="#777777", linewidth=0.8, label="equal")
    axes.set(xscale="log", yscale="log", xlim=ends, ylim=ends, aspect="equal")
    axes.set(xlabel="measured width, pixels", ylabel="width by the model, pixels")
    axes.grid(**GRID)
    if not any(pairs.size for pairs in found.values()):
        none = f"No penumbra of these frames\nis {NARROWEST:g} pixels wide."
        axes.text(0.05, 0.9, none, transform=axes.transAxes, va="top")
    figure.legend(loc="outside lower left", fontsize=8)
    return figure


def _ends(found: Sequence[np.ndarray]) -> tuple[float, float]:
    values = np.concatenate([pairs[pairs > 0] for pairs in found] or [np.ones(1)])
    return (1.0, float(max(values.max(initial=10.0), 10.0)))


if "snakemake" in globals():
    run_stage(snakemake, draw)
