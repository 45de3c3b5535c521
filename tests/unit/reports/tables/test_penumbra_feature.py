"""In which pixels networks of kernels are told of a penumbra, on a frame whose shadow is known."""

import numpy as np
import pytest
import report_samples as samples
from screen_frames import HEIGHT, write_frames

from neural_shadows.reports.tables import penumbra_feature


@pytest.fixture
def table(tmp_path):
    def made():
        parts = [tmp_path / "train_000.json"]
        data, md = samples.written_table(penumbra_feature.table, tmp_path, test_parts=parts)
        return data.set_index("light"), md.read_text(encoding="utf-8")

    return made


def test_a_straight_edge_is_told_of_in_the_half_that_the_map_darkens(tmp_path, table):
    """Dark up to column 24, soft by four pixels on each side: p is far above half a pixel where the
    light's centre is hidden, and 0 beyond. Two columns of 64 do not count.
    """
    write_frames(tmp_path)
    found, text = table()
    assert found.index.tolist() == ["1", "all"]  # a point has no penumbra
    assert found.loc["1", "radius"] == 0.25 and np.isnan(found.loc["all", "radius"])
    row = found.loc["all"]
    assert row[["lit", "penumbra", "umbra"]].tolist() == [36 * HEIGHT, 8 * HEIGHT, 18 * HEIGHT]
    assert row[["lit_share", "penumbra_share", "umbra_share"]].tolist() == [0, 0.5, 1]
    assert "0.5 pixels, in 1 test frames" in text


def test_what_the_map_darkens_by_mistake_is_told_as_well(tmp_path, table):
    part = write_frames(tmp_path).with_suffix(".targets.npy")
    targets = np.load(part)
    targets[:, 1, :8] = 1  # all of the light arrives
    np.save(part, targets)
    row = table()[0].loc["all"]
    assert row["lit_share"] == pytest.approx(8 * (18 + 4) / row["lit"], abs=1e-6)
