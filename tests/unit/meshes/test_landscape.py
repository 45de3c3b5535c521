"""The landscape: one sheet, of low frequency, that shadows itself."""

import numpy as np
import pytest
import trimesh

from neural_shadows.meshes.landscape import make_landscape
from neural_shadows.scenes.tracing import Tracer

CELLS = 128


@pytest.fixture(scope="module")
def landscape():
    vertices, faces = make_landscape(cells=CELLS)
    return trimesh.Trimesh(vertices, faces, process=False)


def test_it_is_one_open_sheet_over_a_square(landscape):
    assert len(landscape.vertices) == (CELLS + 1) ** 2
    assert len(landscape.faces) == 2 * CELLS**2
    assert landscape.body_count == 1 and not landscape.is_watertight
    edges, count = np.unique(np.sort(landscape.edges, axis=1), axis=0, return_counts=True)
    assert set(count) == {1, 2}
    assert (count == 1).sum() == 4 * CELLS  # one boundary, the square's
    assert (landscape.face_normals[:, 1] > 0).all()  # no overhang, seen from above
    assert landscape.bounds[:, [0, 2]] == pytest.approx(np.array([[-1, -1], [1, 1]]))


def test_most_of_its_relief_is_of_low_frequency(landscape):
    height = landscape.vertices[:, 1].reshape(CELLS + 1, -1)[:-1, :-1]
    window = np.hanning(CELLS)
    power = np.abs(np.fft.fft2((height - height.mean()) * np.outer(window, window))) ** 2
    frequency = np.hypot(*np.meshgrid(*[np.fft.fftfreq(CELLS, 1 / CELLS)] * 2))
    assert power[frequency <= 8].sum() > 0.9 * power.sum()


def test_a_low_sun_leaves_a_part_of_it_in_shadow(landscape):
    tracer = Tracer(landscape.vertices.astype(np.float32), landscape.faces)
    points = (landscape.triangles_center + 1e-3 * landscape.face_normals).astype(np.float32)
    light = np.float32([np.cos(np.radians(25)), np.sin(np.radians(25)), 0])
    dark = tracer.occluded(points, np.tile(light, (len(points), 1)))
    dark |= landscape.face_normals @ light <= 0
    share = np.average(dark, weights=landscape.area_faces)
    assert 0.1 < share < 0.4
