"""Labels of logarithmic axes."""

import pytest
from matplotlib.figure import Figure

from neural_shadows.reports.drawing.style import plain_numbers


@pytest.mark.parametrize(
    ("ends", "some"),
    [
        ((0.07, 0.12), {"0.08", "0.1", "0.12"}),  # less than from 1 to 5, as an LPIPS may be
        ((2, 9), {"4", "8"}),
        ((2, 400), {"5", "20", "200"}),  # over two decades, and two powers of ten
        ((1, 300), {"1", "10", "100"}),
        ((0.5, 2e6), {"1", "1k", "1M"}),
    ],
)
def test_a_logarithmic_axis_has_three_labels_at_least(ends, some):
    axes = Figure().add_subplot()
    axes.plot(ends, ends)
    axes.set_yscale("log")
    plain_numbers(axes.yaxis)
    low, high = axes.get_ylim()
    shown = {
        label.get_text()
        for label in axes.get_yticklabels()
        if low <= label.get_position()[1] <= high
    }
    assert some <= shown and len(shown) >= 3
