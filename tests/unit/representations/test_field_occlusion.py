"""Occlusion by a solid's field, against numpy and Embree."""

import numpy as np
import pytest
import torch
import trimesh
from shapes import bumpy_sphere, prepared

from neural_shadows.networks.object_space.sphere_rays import sphere_rays
from neural_shadows.representations.distance_bricks.brick_distances import signed_distances
from neural_shadows.representations.distance_bricks.brick_layout import lay_out
from neural_shadows.representations.distance_bricks.field_bricks import field_bricks
from neural_shadows.representations.distance_bricks.field_marching import SOLID
from neural_shadows.representations.distance_bricks.field_occlusion import occluded
from neural_shadows.representations.distance_bricks.light_tables import light_tables, most_bytes
from neural_shadows.representations.voxels.occupancy import surface_cells

AXES = ([0, 0, 1], [0, -1, 0], [1, 0, 0], [1, 1e-7, 0], [0, 1, -1], [-1, -1, -1])


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


def every_sample(origins, d, ends, grid, values, level, steps):
    """Whether the field is above the level at a sample before the end, or at the end."""
    result = np.zeros(len(origins), bool)
    middles = 2 * (np.arange(steps) + 0.5) / steps
    for ray, (o, end) in enumerate(zip(origins.astype(np.float64), ends)):
        t = np.append(middles[middles < end], end)
        position = (o + t[:, None] * d + 1) * (len(grid) / 2)
        position = position[((position >= 0) & (position < len(grid))).all(1)]
        brick = position.astype(int)
        row = grid[tuple(brick.T)]
        cell = np.minimum(((position - brick) * 4).astype(int), 3)
        part = (position - brick) * 4 - cell
        sums = np.zeros(len(row))
        for corner in np.ndindex(2, 2, 2):
            weight = np.prod(np.where(corner, part, 1 - part), axis=1)
            at = ((cell + corner) * [25, 5, 1]).sum(1)
            sums += weight * values[np.maximum(row, 0), at]
        result[ray] = end > 0 and ((row == SOLID) | ((row >= 0) & (sums > level))).any()
    return result


def rays_along(d, count: int, seed: int = 0) -> tuple[np.ndarray, np.ndarray]:
    """Entry points (k, 3) on the unit sphere, and ends anywhere on the way, some beside it."""
    rng = np.random.default_rng(seed)
    o = rng.normal(size=(count, 3))
    o = (o / np.linalg.norm(o, axis=1, keepdims=True)).astype(np.float32)
    o = o[o @ d < -0.01]
    share = rng.uniform(-0.1, 1.3, len(o)).clip(max=1)
    return o, (share * -2 * (o @ d)).astype(np.float32)


@pytest.mark.parametrize(
    ("size", "radii"),
    [
        (8, [0.6, 0.6, 0.6]),
        (13, [0.9, 0.5, 0.3]),  # its box reaches out of the sphere
        (72, [0.3, 0.95, 0.2]),  # more layers than a word has bits
    ],
)
@pytest.mark.parametrize(("level", "corner_bits"), [(0.0, 4), (-4.0, 4), (-4.0, 8)])
def test_equals_a_test_of_every_sample(size, radii, level, corner_bits):
    grid, values = shell(size, np.array(radii))
    bricks, steps = field_bricks(grid, values, level, corner_bits), 8 * size
    rng = np.random.default_rng(1)
    differ = []
    for d in (*rng.normal(size=(4, 3)), *AXES):
        d = (np.array(d) / np.linalg.norm(d)).astype(np.float32)
        o, ends = rays_along(d, 120)
        # Half of them into the box.
        o[::2] = o[::2] * radii
        o[::2] -= (
            d * ((o[::2] @ d) + np.sqrt((o[::2] @ d) ** 2 - (o[::2] ** 2).sum(1) + 1))[:, None]
        )
        result = occluded(o, d, ends, bricks, steps)
        expected = every_sample(o, d, ends, grid, values, level, steps)
        differ.append(result != expected)
        assert 0.05 < expected.mean() < 0.95
    # Of a sample on a brick's border, where these values jump, rounding decides.
    assert np.concatenate(differ).mean() < 0.005


def test_rays_on_the_borders_of_bricks():
    """Along axes, through planes and edges between bricks and cells: no memory beyond the grid."""
    grid, values = shell(8, np.array([0.9, 0.9, 0.9]))
    bricks = field_bricks(grid, values, 0.0, 4)
    for axis in range(3):
        across = np.stack(np.meshgrid(*[np.arange(-7, 8) / 8] * 2), -1).reshape(-1, 2)
        across = across[(across**2).sum(1) < 1]
        for sign in (-1, 1):
            along = -sign * np.sqrt(1 - (across**2).sum(1))
            o = np.insert(across, axis, along, axis=1).astype(np.float32)
            d = (sign * np.eye(3)[axis]).astype(np.float32)
            ends = np.full(len(o), 2 * np.abs(along), np.float32)
            result = occluded(o, d, ends, bricks, 64)
            expected = every_sample(o, d, ends, grid, values, 0.0, 64)
            assert (result == expected).mean() > 0.98


def test_an_empty_field_shadows_nothing():
    layout = lay_out(np.zeros((4, 4, 4), bool), solid=True)
    bricks = field_bricks(layout.grid, np.zeros((0, 125), np.int8), 0.0, 8)
    o, ends = rays_along(np.float32([0, 0, 1]), 50)
    assert not occluded(o, np.float32([0, 0, 1]), ends, bricks, 32).any()


@pytest.mark.parametrize("corner_bits", [4, 8])
@pytest.mark.parametrize("shape", [trimesh.creation.icosphere(4, radius=0.6), bumpy_sphere(4)])
def test_shadows_of_a_mesh(shape, corner_bits):
    """Points around it, lit or not as by rays through the mesh, but close to its surface."""
    mesh, tracer = prepared(shape)
    layout = lay_out(surface_cells(mesh.vertices, mesh.faces, 32), solid=True)
    values = np.round(60 * signed_distances(mesh, layout, 2.0)).astype(np.int8)[layout.table]
    bricks = field_bricks(layout.grid, values, 0.0, corner_bits)
    rng = np.random.default_rng(0)
    p = torch.from_numpy(rng.uniform(-1.5, 1.5, (20_000, 3)).astype(np.float32))
    for light in ([0.2, 1, -0.4], [0, 0, 1]):
        light = torch.nn.functional.normalize(torch.tensor(light, dtype=torch.float32), dim=0)
        rays = sphere_rays(p, light)
        ends = torch.minimum(rays.s, rays.chord).numpy()
        result = occluded(rays.origins.numpy(), -light.numpy(), ends, bricks, 256)
        at = p[rays.index].numpy()
        expected = tracer.occluded(at, np.tile(light.numpy(), (len(at), 1)))
        inside = np.abs(np.linalg.norm(at, axis=1) - 0.7) < 0.3
        assert (result != expected)[~inside].mean() < 5e-3
        assert 0.1 < expected.mean() < 0.9


def test_no_light_exceeds_the_largest_tables():
    grid, values = shell(13, np.array([0.3, 0.9, 0.5]))
    bricks = field_bricks(grid, values, 0.0, 4)
    lights = [*np.random.default_rng(0).normal(size=(20, 3)), *AXES, [0.99, 1, 0.99]]
    sizes = [light_tables(bricks, d, 1 / 8).bytes for d in lights]
    assert max(sizes) <= 1.01 * most_bytes(bricks) < 1.1 * max(sizes)
