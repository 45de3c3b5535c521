import numpy as np

from neural_shadows.reports.figures.penumbra_model import model_figure


def test_a_panel_a_light_with_the_model_s_median():
    measured = np.geomspace(5, 80, 3000)
    pairs = {"wide": np.stack([measured, 2 * measured]), "narrow": np.zeros((2, 0))}
    wide, narrow = model_figure(pairs, title="Widths").axes
    assert "model ≥ measured in 100 % of pixels,\nmedian ratio 2," in wide.get_title()
    (median,) = (line for line in wide.lines if line.get_label() == "median of the model")
    x, y = median.get_data()
    assert len(x) > 5 and np.allclose(y / x, 2, rtol=0.15)
    counts = wide.collections[0].get_array()
    assert counts.sum() == measured.size
    assert not narrow.collections and "is 5 pixels wide" in narrow.texts[0].get_text()
