"""The landscape: one open sheet, of low frequency."""

import numpy as np
import pytest
import trimesh

from neural_shadows.meshes.landscape import make_landscape

CELLS = 128


@pytest.fixture(scope="module")
def landscape():
    return trimesh.Trimesh(*make_landscape(cells=CELLS), process=False)


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
