import numpy as np
import pandas as pd

from neural_shadows.reports.figures.loss import draw, loss_figure, smoothed


def curve(losses):
    steps = np.arange(1, len(losses) + 1)
    return pd.DataFrame(
        {"step": steps, "samples": 1024 * steps, "learning_rate": 1e-3, "loss": losses}
    )


def test_running_mean_keeps_a_line_and_length():
    line = np.linspace(5, 1, 500)
    np.testing.assert_allclose(smoothed(line), line)  # its ends too, where the loss falls fastest
    noisy = np.ones(500) + np.random.default_rng(1).normal(0, 0.1, 500)
    assert smoothed(noisy).std() < 0.5 * noisy.std()


def test_curves_are_drawn_over_their_samples_with_their_last_loss():
    figure = loss_figure({"a": curve([3.0, 2.0]), "b": curve([1.0, 0.25])}, title="Losses")
    (axes,) = figure.axes
    np.testing.assert_array_equal(axes.lines[2].get_xdata(), [1024, 2048])
    np.testing.assert_array_equal(axes.lines[2].get_ydata(), [1.0, 0.25])
    labels = [text.get_text() for text in axes.get_legend().get_texts()]
    assert labels == ["a (at the end 2)", "b (at the end 0.25)"]


def test_a_first_spike_does_not_squeeze_the_rest():
    figure = loss_figure({"a": curve([900.0, *np.linspace(1, 0.1, 200)])}, title="Losses")
    assert figure.axes[0].get_ylim()[1] < 10


def draw_losses(folder):
    files = [folder / name / "loss.csv" for name in ("one", "two")]
    curves = [{"experiment": "two", "label": "second"}, {"experiment": "one", "label": "first"}]
    paths = folder / "f.png", folder / "f.svg"
    draw(files, *paths, title="Losses", curves=curves, run={"scale": "test"})
    return [path.read_bytes() for path in paths]


def test_figure_is_written_twice_alike(tmp_path):
    for name, last in (("one", 0.1), ("two", 0.2)):
        (tmp_path / name).mkdir()
        curve(np.linspace(1, last, 50)).to_csv(tmp_path / name / "loss.csv", index=False)
    png, svg = draw_losses(tmp_path)
    assert [png, svg] == draw_losses(tmp_path)
    assert b"second (at the end 0.2)" in svg and b"<dc:date>" not in svg
