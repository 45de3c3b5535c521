"""Coded fields: exact round trips, and size of smooth fields."""

import lzma

import numpy as np
import pytest
import torch
import trimesh
from shapes import box, bumpy_sphere

from neural_shadows.representations.distance_bricks.brick_layout import BrickLayout, lay_out
from neural_shadows.representations.distance_bricks.coded_field import (
    LEVELS_PER_CELL,
    MOST,
    coded,
    decoded,
    levels_of,
)
from neural_shadows.representations.voxels.occupancy import surface_cells

BRICKS = 8
HALF = 2 * BRICKS  # cells in a radius


def laid_out(shape: trimesh.Trimesh) -> BrickLayout:
    return lay_out(surface_cells(shape.vertices, shape.faces, BRICKS), True)


def of_crossed_cells(layout: BrickLayout, inside: np.ndarray) -> np.ndarray:
    """Vertices of a cell with both signs, one cell after the other."""
    sides = dict(zip(map(tuple, layout.vertices.tolist()), inside.tolist()))
    crossed_vertices = set()
    for x, y, z in 4 * np.argwhere(layout.grid >= 0):
        for i, j, k in np.ndindex(4, 4, 4):
            corners = [(x + i + a, y + j + b, z + k + c) for a, b, c in np.ndindex(2, 2, 2)]
            if len({sides[corner] for corner in corners}) == 2:
                crossed_vertices.update(corners)
    return np.array([vertex in crossed_vertices for vertex in map(tuple, layout.vertices.tolist())])


@pytest.mark.parametrize("spread", [0.0, 0.4, 5.0])
def test_levels_come_back(spread):
    """Of a smooth field, of a noisy one, and of noise alone, whose cells are nearly all crossed."""
    layout = laid_out(bumpy_sphere(3))
    noise = np.random.default_rng(0).normal(scale=spread, size=layout.count)
    levels = levels_of(HALF * (0.85 - np.linalg.norm(layout.vertices / HALF - 1, axis=1)) + noise)
    tensors = coded(layout, levels)
    again, crossed_vertices = decoded(tensors, BRICKS, True)
    assert np.array_equal(again.grid, layout.grid)
    near = of_crossed_cells(layout, levels >= 0)
    assert 0.1 < near.mean()
    assert np.array_equal(
        crossed_vertices, np.where(near, levels, np.where(levels < 0, -MOST, MOST - 1))
    )
    repeated = coded(again, crossed_vertices)
    assert all(torch.equal(repeated[name], tensors[name]) for name in tensors)


def test_a_level_is_a_sixteenth_of_a_cell():
    assert levels_of(np.array([0.0, -1e-9, 1 / 16, 9, -9])).tolist() == [0, -1, 1, 27, -28]
    assert MOST / LEVELS_PER_CELL > 3**0.5  # a cell's diagonal


def test_a_plane_takes_hardly_a_byte():
    """All is as expected but at the bricks' ends; of noise nothing is, and nothing is saved."""
    layout = laid_out(box(1.02, 1.02, 1.02))
    depth = HALF * (0.51 - np.abs(layout.vertices / HALF - 1).max(axis=1))
    smooth = coded(layout, levels_of(depth))
    noise = np.random.default_rng(0).integers(-MOST, MOST, layout.count).astype(np.int8)
    rough = coded(layout, noise)
    assert sum(map(len, smooth.values())) < 0.05 * layout.count
    assert len(rough["levels"]) > 0.6 * layout.count


@pytest.mark.parametrize("name", ["bricks", "signs", "levels"])
def test_other_tensors_are_refused(name):
    layout = laid_out(bumpy_sphere(3))
    tensors = coded(layout, levels_of(np.linspace(-2, 2, layout.count)))
    other = tensors["bricks" if name == "levels" else "levels"]
    for wrong in (tensors[name][:-8], other):
        with pytest.raises((ValueError, lzma.LZMAError)):
            decoded(tensors | {name: wrong}, BRICKS, True)
