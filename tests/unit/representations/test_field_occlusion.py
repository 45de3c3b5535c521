"""Occlusion by a field, in Numba and in C, against numpy, Embree and marched rays."""

import ctypes
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
import trimesh
from shapes import bumpy_sphere, hills

from neural_shadows import ShadowField
from neural_shadows.representations.distance_bricks import compiled_occlusion, field_occlusion
from neural_shadows.representations.distance_bricks.brick_layout import lay_out
from neural_shadows.representations.distance_bricks.field_bricks import field_bricks
from neural_shadows.representations.distance_bricks.field_marching import (
    NO_CELLS,
    SOLID,
    mark_blocked,
)
from neural_shadows.representations.distance_bricks.field_occlusion import (
    mark_occluded,
    occluded,
    occluded_from,
)
from neural_shadows.representations.distance_bricks.light_tables import (
    directional_tables,
    merging,
    most_bytes,
    point_tables,
)
from neural_shadows.running.compiled_c import FLAGS, compiled_c

AXES = ([0, 0, 1], [0, -1, 0], [1, 0, 0], [1, 1e-7, 0], [0, 1, -1], [-1, -1, -1])
SOURCE = Path(field_occlusion.__file__).with_suffix(".c")
in_c = pytest.mark.skipif(compiled_c(SOURCE) is None, reason="no C compiler: apt-get install gcc")


@pytest.fixture(params=["numba", pytest.param("c", marks=in_c)])
def either(request, monkeypatch):
    """The query in Numba, and in C."""
    if request.param == "numba":
        monkeypatch.setattr(field_occlusion, "compiled_occlusion", lambda: None)


def shell(size: int, radii) -> tuple[np.ndarray, np.ndarray]:
    """The grid (B, B, B) of bricks around an ellipsoid, and random values (bricks, 125).

    They are smooth along an axis of each brick, differ at the border of two, and are odd: a cell's
    word holds them as they are.
    """
    centre = (np.stack(np.meshgrid(*[np.arange(size) + 0.5] * 3, indexing="ij"), -1)) * 2 / size
    away = np.linalg.norm((centre - 1) / radii, axis=-1)
    layout = lay_out(np.abs(away - 1) < 2 * np.sqrt(3) / size, solid=True)
    rng = np.random.default_rng(size)
    values = rng.normal(-0.8, 1, (len(layout.table), 25, 1)) + rng.normal(0, 0.3, 5)
    values = 2 * np.round(3 * values).clip(-8, 7) + 1
    return layout.grid, values.astype(np.int8).reshape(-1, 125)


def every_sample(points, lights, grid, values, level, cells=NO_CELLS, density=2):
    """The definition, at every plane of each ray: whether anything is between point and light.

    Args:
        lights: (n, 3), positions; far away for a directional light.
    """
    half = 2 * len(grid)  # cells
    result = np.zeros(len(points), bool)
    for ray, (point, light) in enumerate(zip(points.astype(np.float64), lights)):
        start, end = (point + 1) * half, (light + 1) * half
        m = np.abs(end - start).argmax()
        planes = (np.arange(2 * density * half) + 0.5) / density
        share = (planes - start[m]) / (end[m] - start[m])
        share = share[(share > 0) & (share <= 1)]
        share = np.sort(np.append(share, 0))[::-1]  # from the light to the point
        position = start + share[:, None] * (end - start)
        states = state_at(position, grid, values, level, cells)
        if len(cells):
            result[ray] = ((states[1:] + states[:-1]) == 1).any()
        else:
            result[ray] = (states == 1).any()
    return result


def state_at(position, grid, values, level, cells):
    """0 outside, 1 inside, and of a sheet 2 where it has no sides: at positions (n, 3) in cells."""
    within = ((position >= 0) & (position < 4 * len(grid))).all(1)
    cell = np.where(within[:, None], position, 0).astype(int)
    brick, cell = cell // 4, cell % 4
    row = grid[tuple(brick.T)]
    part = np.where(within[:, None], position, 0) % 1
    sums, inside = np.zeros(len(row)), np.zeros(len(row), int)
    for corner in np.ndindex(2, 2, 2):
        weight = np.prod(np.where(corner, part, 1 - part), axis=1)
        corners = values[np.maximum(row, 0), ((cell + corner) * [25, 5, 1]).sum(1)]
        sums += weight * corners
        inside += corners > level
    state = np.where((row == SOLID) | ((row >= 0) & (sums > level)), 1, 0)
    if len(cells):
        bit = (cell * [16, 4, 1]).sum(1).astype(np.uint64)
        touched = cells[np.maximum(row, 0)] >> bit & np.uint64(1) != 0
        state = np.where((row >= 0) & (touched | (inside % 8 == 0)), state, 2)
    return np.where(within, state, 2 if len(cells) else 0)


def far(points, to_light):
    """Positions (n, 3) so far away that all rays are parallel."""
    return points + 1e6 * np.asarray(to_light, np.float64)


def around(count: int, seed: int = 0, reach: float = 1.2) -> np.ndarray:
    points = np.random.default_rng(seed).uniform(-reach, reach, (count, 3))
    return points.astype(np.float32)


def unit(d) -> np.ndarray:
    return np.array(d) / np.linalg.norm(d)


SHELLS = pytest.mark.parametrize(
    ("size", "radii"),
    [
        (8, [0.6, 0.6, 0.6]),
        (13, [0.9, 0.5, 0.3]),  # its box reaches out of the sphere
        (72, [0.3, 0.95, 0.2]),  # more slabs than a word has bits
    ],
)


@SHELLS
@pytest.mark.parametrize(
    ("level", "corner_bits", "density"), [(0.0, 4, 2), (-4.0, 4, 4), (-4.0, 8, 2), (0.0, 8, 4)]
)
def test_equals_a_test_of_every_sample(either, size, radii, level, corner_bits, density):
    grid, values = shell(size, np.array(radii))
    bricks = field_bricks(grid, values, level, corner_bits, density=density)
    points, differ = around(60), []
    points[::2] *= np.float32(radii)
    for d in (*np.random.default_rng(1).normal(size=(4, 3)), *AXES):
        result = occluded(points, unit(d), bricks)
        expected = every_sample(points, far(points, unit(d)), grid, values, level, density=density)
        differ.append(result != expected)
        assert 0.05 < expected.mean() < 0.95
    # Of a sample on a brick's border, where these values jump, rounding decides.
    assert np.concatenate(differ).mean() < 0.005


@SHELLS
def test_a_point_light_equals_a_test_of_every_sample(either, size, radii):
    """Beside the box, above it, in its middle, and far away."""
    grid, values = shell(size, np.array(radii))
    bricks = field_bricks(grid, values, 0.0, 8)
    points, differ = around(80), []
    for light in ([0.9, 0.8, 0.7], [0.1, 1.4, -0.2], [0.01, 0.02, 0.03], [-50, 20, 40]):
        result = occluded_from(points, light, bricks)
        expected = every_sample(points, np.tile(light, (80, 1)), grid, values, 0.0)
        differ.append(result != expected)
        assert 0.05 < expected.mean()
    assert np.concatenate(differ).mean() < 0.005


def test_a_sheet_equals_a_test_of_every_sample(either):
    """With cells that it may not cross."""
    field = ShadowField.fit(torn_hills())
    bricks = field._field_bricks
    given = field.grid, field.bricks.astype(float), 0.0, field.cells
    points, differ = around(300), []
    for d in ([1, 0.4, 0.3], [0, 1, 0], [-0.5, 0.5, 0.5]):
        result = occluded(points, unit(d), bricks)
        differ.append(result != every_sample(points, far(points, unit(d)), *given))
        result = occluded_from(points, d, bricks)
        differ.append(result != every_sample(points, np.tile(d, (300, 1)), *given))
        assert 0.05 < result.mean() < 0.95
    assert np.concatenate(differ).mean() < 0.005


def torn_hills() -> trimesh.Trimesh:
    """An open sheet with rough borders round a hole."""
    shape = hills()
    shape.update_faces(np.hypot(*shape.triangles_center[:, [0, 2]].T) > 0.2)
    return shape


def answers(mark, points, tables, bricks, bias=0.0):
    occlusion = np.zeros(len(points), bool)
    for light in tables:
        mark(points, light, bricks, np.float32(bias), occlusion)
    return occlusion


@in_c
@pytest.mark.parametrize("corner_bits", [4, 8])
@pytest.mark.parametrize("shape", [bumpy_sphere(5), torn_hills()])
def test_half_a_million_rays_in_c_and_in_numba(shape, corner_bits):
    """Bit for bit: on both sides numbers are rounded at the same places."""
    field = ShadowField.fit(shape)
    bricks = field_bricks(field.grid, field.bricks, 0.0, corner_bits, field.cells)
    if corner_bits == 4:  # and rows as of a large field
        bricks = bricks._replace(rows=bricks.rows.astype(np.uint32))
    points = around(62_500)
    lights = [[directional_tables(bricks, unit(d))] for d in ([1, 0.4, 0.3], [-0.2, -0.9, 0.3])]
    lights += [point_tables(bricks, p) for p in ([0.9, 0.8, 0.7], [0.2, 1.0, 0.1])]
    for tables in lights:
        for bias in (0.0, -3.3):
            both = (compiled_occlusion.compiled_occlusion(), mark_occluded)
            ours, numbas = (answers(mark, points, tables, bricks, bias) for mark in both)
            assert (ours != numbas).sum() == 0 and 0.05 < ours.mean() < 0.95


@pytest.mark.parametrize("shape", [bumpy_sphere(4), torn_hills()])
def test_blocks_of_cells_change_no_answer(either, shape):
    """Tables of fewer, larger tiles for few rays: only more samples are looked up."""
    bricks, points = ShadowField.fit(shape, 128)._field_bricks, around(50_000)
    mark = field_occlusion.compiled_occlusion() or mark_occluded
    d, lamp = unit([0.5, 0.7, -0.3]), [0.5, 1.1, 0.2]
    single = answers(mark, points, [directional_tables(bricks, d)], bricks)
    of_lamp = answers(mark, points, point_tables(bricks, lamp), bricks)
    for merged in (1, 2):
        tables = directional_tables(bricks, d, merged)
        assert tables.bytes < 0.5 * directional_tables(bricks, d, merged - 1).bytes
        assert (answers(mark, points, [tables], bricks) != single).sum() <= 1
        tables = point_tables(bricks, lamp, merged)
        assert (answers(mark, points, tables, bricks) != of_lamp).sum() <= 1
    assert [merging(rays, bricks) for rays in (10, 10**9)] == [2, 0]


@in_c
@pytest.mark.parametrize("options", [["-march=x86-64", "-O2"], ["-mno-avx2", "-O1"]])
def test_c_without_vector_instructions(tmp_path, options):
    """Of another machine's answers too: `-march=native` is replaced."""
    flags = [flag for flag in FLAGS if flag != "-march=native"]
    library = tmp_path / "plain.so"
    command = ["gcc", *flags, *options, "-Wall", "-Wextra", "-Werror", SOURCE, "-o", library, "-lm"]
    subprocess.run(command, check=True)
    plain = compiled_occlusion.marking(ctypes.CDLL(str(library)))
    for shape in (bumpy_sphere(4), torn_hills()):
        bricks, points = ShadowField.fit(shape, 128)._field_bricks, around(50_000)
        tables = [directional_tables(bricks, unit([1, 0.4, 0.3]))]
        result = answers(plain, points, tables, bricks)
        assert np.array_equal(result, answers(mark_occluded, points, tables, bricks))


def test_as_rays_that_are_marched():
    """Samples at other places, by the older loop over any rays: all but those that graze."""
    for shape, most in ((bumpy_sphere(5), 1e-4), (torn_hills(), 1e-3)):
        field, d = ShadowField.fit(shape), unit([1, 0.4, 0.3]).astype(np.float32)
        points, marched = around(300_000, reach=1.0), np.zeros(300_000, bool)
        to_light = np.tile(9 * d, (len(points), 1))
        march = field.grid, field.bricks, 2 * field.resolution, field.cells, np.float32(0)
        mark_blocked(points, to_light, *march, marched)
        assert np.mean(marched != occluded(points, d, field._field_bricks)) < most


def test_points_moved_towards_the_light(either):
    """By a depth bias: as points that are moved."""
    bricks, points = ShadowField.fit(bumpy_sphere(4), 128)._field_bricks, around(20_000)
    for d in ([0.3, 0.9, -0.2], [-1, 0.1, 0]):
        for bias in (-0.05, 0.02):
            moved = (points + bias * unit(d)).astype(np.float32)
            result = occluded(points, unit(d), bricks, bias)
            assert np.mean(result != occluded(moved, unit(d), bricks)) < 0.001


def test_odd_points_are_lit(either):
    """NaN, infinite; and those beside them, and one beyond what an integer holds, are as they are."""
    odd = [[np.nan, 0, 0], [0, np.nan, 0], [0, 0, -np.inf], [np.inf] * 3]
    points = [around(2000, reach=0.5), odd, [[1e30, -2e30, 1e25]]]
    points = np.concatenate(points).astype(np.float32)
    for shape in (trimesh.creation.icosphere(4), torn_hills()):
        bricks = ShadowField.fit(shape, 64)._field_bricks
        for d in (*AXES, [0.4, 0.5, 0.6]):
            for result in (occluded(points, unit(d), bricks), occluded_from(points, d, bricks)):
                assert not result[2000:-1].any()
                assert shape.is_watertight == result[:2000].all()
        lamp = occluded_from(points, [np.nan, 0, 0], bricks)
        assert not lamp.any()


def test_points_far_outside(either):
    """A lamp's rays to 10^30 are those to the box's side: what rounds there was read out of memory."""
    bricks = ShadowField.fit(bumpy_sphere(4), 64)._field_bricks
    lamps = np.random.default_rng(1).normal(size=(50, 3))
    beyond = np.stack([point + 1e30 * (point - lamp) for point in around(200) for lamp in lamps])
    beyond = beyond.astype(np.float32).reshape(200, 50, 3)
    for lamp, points in zip(lamps, beyond.swapaxes(0, 1)):
        near = (lamp + 3e-30 * (points.astype(np.float64) - lamp)).astype(np.float32)
        assert (
            np.mean(occluded_from(points, lamp, bricks) != occluded_from(near, lamp, bricks))
            <= 0.02
        )


_WITHIN_BOX = """
import ctypes, sys
import numpy as np
import trimesh
from neural_shadows import ShadowField
from neural_shadows.representations.distance_bricks import compiled_occlusion, light_tables
mark = compiled_occlusion.marking(ctypes.CDLL(sys.argv[1]))
rng = np.random.default_rng(0)
solid = trimesh.creation.icosphere(4)
open_top = solid.submesh([solid.triangles_center[:, 2] < 0.3], append=True)
for mesh in (solid, open_top):
    bricks = ShadowField.fit(mesh, 64)._field_bricks
    for light in range(300):
        points = rng.normal(size=(300, 3)) * 10.0 ** rng.uniform(-6, 35, (300, 1))
        points = np.float32(points + rng.choice([0, np.nan, np.inf], (300, 3), p=[0.98, 0.01, 0.01]))
        lamp = rng.normal(size=3) * 10.0 ** rng.uniform(-4, 9)
        d = np.round(lamp / np.abs(lamp).max(), light % 4)
        tables = light_tables.point_tables(bricks, [lamp, d][light % 2], light % 3)
        tables.append(light_tables.directional_tables(bricks, d / np.linalg.norm(d), light % 3))
        for each in tables:
            mark(points, each, bricks, rng.choice([0, 0.5, -3]), np.zeros(300, bool))
"""


@in_c
def test_no_sample_is_out_of_the_box(tmp_path):
    """Its assertions hold, for points and lamps near and far."""
    library = tmp_path / "checked.so"
    flags = [flag for flag in FLAGS if flag != "-DNDEBUG"]
    subprocess.run(["gcc", *flags, SOURCE, "-o", library, "-lm"], check=True)
    subprocess.run([sys.executable, "-c", _WITHIN_BOX, library], check=True)


def test_rays_on_the_borders_of_bricks(either):
    """Along axes, through planes and edges between bricks and cells: no memory beyond the grid."""
    grid, values = shell(8, np.array([0.9, 0.9, 0.9]))
    bricks = field_bricks(grid, values, 0.0, 4)
    points = np.stack(np.meshgrid(*[np.arange(-8, 9) / 8] * 3), -1).reshape(-1, 3)
    points = np.random.default_rng(0).choice(points, 1000, replace=False).astype(np.float32)
    for d in np.concatenate([np.eye(3), -np.eye(3)]):
        result = occluded(points, d, bricks)
        expected = every_sample(points, far(points, d), grid, values, 0.0)
        assert (result == expected).mean() > 0.98


def test_an_empty_field_shadows_nothing(either):
    layout = lay_out(np.zeros((4, 4, 4), bool), solid=True)
    bricks = field_bricks(layout.grid, np.zeros((0, 125), np.int8), 0.0, 8)
    assert not occluded(around(50), [0, 0, 1], bricks).any()
    assert not occluded_from(around(50), [0, 0, 1], bricks).any()
    assert len(occluded(np.zeros((0, 3), np.float32), [0, 0, 1], bricks)) == 0


def test_a_lamp_under_a_roof():
    """A slab's shadow, by similar triangles; the lamp is within the field's box, beside the slab."""
    roof = trimesh.creation.box((1.0, 0.1, 1.0))
    post = trimesh.creation.box((0.1, 1.6, 0.1)).apply_translation((0.9, 0, 0.9))
    field = ShadowField.fit(trimesh.util.concatenate([roof, post]))
    lamp = np.array([0.1, 0.6, -0.2])
    x, z = np.random.default_rng(0).uniform(-3, 3, (2, 100_000))
    ground = np.stack([x, np.full_like(x, -0.8), z], axis=1)
    below, far_side = 1.4 / 0.55, 1.4 / 0.65  # from the slab's top, and its bottom, to the ground
    edges = np.outer(
        [-0.5 - lamp[0], 0.5 - lamp[0], -0.5 - lamp[2], 0.5 - lamp[2]], [below, far_side]
    )
    low_x, high_x, low_z, high_z = edges
    inside = (x > lamp[0] + low_x.min()) & (x < lamp[0] + high_x.max())
    inside &= (z > lamp[2] + low_z.min()) & (z < lamp[2] + high_z.max())
    at_post = (x - lamp[0]) + (z - lamp[2]) > 0.8  # its shadow, and more
    result = field.occluded_from(ground, lamp)
    assert np.mean((result != inside)[~at_post]) < 0.005


def test_a_lamp_within_a_solid_lights_nothing(either):
    """Deep within: all bricks around it are enclosed, which no ray from outside meets first."""
    bricks, points = ShadowField.fit(trimesh.creation.icosphere(4), 128)._field_bricks, around(5000)
    for lamp in ([0.11, 0.02, -0.03], [0.0, 0.6, 0.1]):
        assert occluded_from(points, lamp, bricks).all()


def test_no_light_exceeds_the_largest_tables():
    grid, values = shell(13, np.array([0.3, 0.9, 0.5]))
    bricks = field_bricks(grid, values, 0.0, 4)
    lights = [*np.random.default_rng(0).normal(size=(20, 3)), *AXES, [0.99, 1, 0.99]]
    sizes = [directional_tables(bricks, unit(d)).bytes for d in lights]
    assert max(sizes) <= 1.05 * most_bytes(bricks) < 1.2 * max(sizes)
