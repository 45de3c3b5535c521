"""The table of penumbrae's widths, from made widths."""

import numpy as np
import pytest

from neural_shadows.reports.tables.penumbra_widths import widths_table


def test_widths_as_measured_and_as_modelled():
    """Of widths up to 100 a model that gives each twice exceeds all, one that gives half just half."""
    measured = np.arange(101.0)
    pairs = {
        ("twice", 1, 0.25): np.stack([measured, 2 * measured]),
        ("half", 1, 0.25): np.stack([measured, measured / 2]),
        ("none", 1, 0.25): np.empty((2, 0)),
    }
    table = widths_table(pairs).set_index("scene")
    assert table["light"].tolist() == [1, 1, 1] and table["pixels"].tolist() == [101, 101, 0]
    assert table["measured"].tolist()[:2] == [50, 50] and table["modelled"].tolist()[:2] == [
        100,
        25,
    ]
    assert table["measured_wide"].tolist()[:2] == pytest.approx([95, 95])
    assert table["modelled_wide"].tolist()[:2] == pytest.approx([190, 47.5])
    assert table["within"].tolist()[:2] == pytest.approx([1, 48 / 101])
    assert table.loc["none", ["measured", "modelled_wide", "within"]].isna().all()
