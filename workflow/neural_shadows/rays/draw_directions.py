"""Stage: draw the view directions of a ray set [3.4.1]."""

from pathlib import Path

import numpy as np

from neural_shadows.files.whole_files import write_array
from neural_shadows.rays.poisson_disk import sphere_directions
from neural_shadows.rays.streams import DIRECTIONS
from neural_shadows.running.stage import run_stage
from neural_shadows.scenes.lights import arc_directions, axis_vector, draw_light, lowest_elevation
from neural_shadows.settings.records import LightSettings, SamplingSettings


def draw_directions(
    *,
    directions_npy: Path,
    sampling: SamplingSettings,
    seed: int,
    light: LightSettings | None = None,
    up: str = "y",
) -> None:
    """Draw the view directions of a ray set and write `directions.npy`, (D, 3) float32.

    Args:
        sampling: `directions` D and `sampler`: `poisson_quadtree` gives a Poisson-disk pattern,
            the others independent uniform directions.
        light: the domain to draw from, d = −l [4.1.1], on the axis `up`; None for the sphere.
    """
    poisson, count = sampling["sampler"] == "poisson_quadtree", sampling["directions"]
    key = (seed, DIRECTIONS)
    rng, axis = np.random.default_rng(key), axis_vector(up)
    if light is not None and poisson:
        directions = -_poisson_lights(count, light, axis, key)
    elif light is not None:
        directions = -np.stack([draw_light(light, axis, rng) for _ in range(count)])
    elif poisson:
        directions = sphere_directions(count, key)[0]
    else:
        directions = rng.normal(size=(count, 3))
        directions /= np.linalg.norm(directions, axis=1, keepdims=True)
    write_array(directions_npy, directions.astype(np.float32))


def _poisson_lights(count: int, light: dict, up: np.ndarray, key: tuple) -> np.ndarray:
    """A Poisson-disk pattern on a light domain: unit vectors (count, 3)."""
    lowest = lowest_elevation(light)
    if light["domain"] == "single_axis":
        half = np.pi / 2 - lowest
        return arc_directions(light, up, half * _poisson_line(count, np.random.default_rng(key)))
    # A pattern on the whole sphere, as dense, with `count` or a few more in the cap; the lowest
    # of those are left out, which moves the cap's rim by about one distance of the pattern.
    total = round(count * 2 / (1 - np.sin(lowest)))
    while True:
        pattern = sphere_directions(total, key)[0]
        height = pattern @ up
        if np.count_nonzero(height >= np.sin(lowest)) >= count:
            break
        total += max(1, total // 100)
    return pattern[np.sort(np.argsort(-height, kind="stable")[:count])]


def _poisson_line(count: int, rng: np.random.Generator) -> np.ndarray:
    """A maximal Poisson-disk pattern on [−1, 1] in random order: gaps of r to 2r, (count,).

    Dart throwing in one dimension ends in gaps between r and 2r; drawn as such, the count is
    exact. The ends lie half a gap inside.
    """
    gaps = 1 + rng.random(count + 1)
    gaps[[0, -1]] /= 2
    at = np.cumsum(gaps)
    return rng.permutation(2 * at[:-1] / at[-1] - 1)


if "snakemake" in globals():
    run_stage(snakemake, draw_directions)
