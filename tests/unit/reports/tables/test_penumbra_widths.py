"""The table of penumbrae's widths, from made widths."""

import numpy as np
import pytest

from neural_shadows.reports.tables.penumbra_widths import widths_table


def test_widths_as_measured_and_as_modelled():
    """Of widths up to 100 a bound of twice their quantile exceeds all, one of half of it just half."""
    measured = np.arange(101.0)
    pairs = {
        ("twice", 1, 0.25): [np.stack([measured, 2 * measured])],
        ("half", 1, 0.25): [np.stack([measured, measured / 2])],
        ("none", 1, 0.25): [np.empty((2, 0))],
    }
    bounds = dict(zip(pairs, (190, 47.5, np.nan)))
    table = widths_table(pairs, bounds).set_index("scene")
    assert table["light"].tolist() == [1, 1, 1] and table["pixels"].tolist() == [101, 101, 0]
    assert table["measured"].tolist()[:2] == [50, 50]
    assert table["modelled"].tolist()[:2] == [100, 25]
    assert table["measured_wide"].tolist()[:2] == pytest.approx([95, 95])
    assert table["modelled_wide"].tolist()[:2] == pytest.approx([190, 47.5])
    assert table["within"].tolist()[:2] == pytest.approx([1, 48 / 101])
    assert table.loc["none", ["measured", "modelled_wide", "within"]].isna().all()
    assert table["wide_ratio"].tolist()[:2] == pytest.approx([0.5, 2])
    assert table["wide_ratio_low"].isna().all()  # of one frame there is no interval


def test_the_ratio_of_wide_penumbrae_is_covered_over_frames():
    """Frames differ by a tenth, far more than their many pixels do."""
    rng, trials = np.random.default_rng(3), 1000
    modelled = np.broadcast_to(np.linspace(5, 10, 20), (trials, 8, 20))
    both = np.stack([modelled * rng.lognormal(0, 0.1, (trials, 8, 1)), modelled], axis=2)
    pairs = {("plate", trial, 0.25): [*both[trial]] for trial in range(trials)}
    table = widths_table(pairs, dict.fromkeys(pairs, np.percentile(modelled, 95)))
    covered = (table["wide_ratio_low"] <= 1) & (table["wide_ratio_high"] >= 1)
    assert 0.93 <= covered.mean() <= 0.97  # 0.7 % by chance
