import numpy as np

from neural_shadows.reports.figures.penumbra_model import model_figure


def test_a_panel_a_light_with_the_model_s_median():
    measured = np.geomspace(5, 80, 3000)
    pairs = {"wide": np.stack([measured, 2 * measured]), "narrow": np.zeros((2, 0))}
    wide, narrow, scale = model_figure(pairs, title="Widths").axes
    assert wide.get_title() == "wide" and scale.get_ylabel() == "pixels"
    assert "model ≥ measured: 100 % of pixels\nmedian ratio: 2\n" in wide.texts[0].get_text()
    (median,) = (line for line in wide.lines if line.get_label() == "median of the model")
    x, y = median.get_data()
    measured_there = (x > 5) & (x < 75)
    assert np.isnan(y[x < 4]).all() and measured_there.sum() > 5
    assert np.allclose((y / x)[measured_there], 2, rtol=0.15)
    counts = wide.collections[0].get_array()
    assert counts.sum() == measured.size
    assert not narrow.collections and "is 5 pixels wide" in narrow.texts[0].get_text()
