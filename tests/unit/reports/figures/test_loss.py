import numpy as np
import pandas as pd

from neural_shadows.reports.figures.loss import draw, loss_figure, smoothed


def curve(losses):
    steps = np.arange(1, len(losses) + 1)
    frame = {"step": steps, "samples": 1024 * steps, "learning_rate": 1e-3, "loss": losses}
    return pd.DataFrame(frame)


def test_running_mean_keeps_a_line_and_length():
    line = np.linspace(5, 1, 500)
    np.testing.assert_allclose(smoothed(line), line)  # its ends too, where the loss falls fastest
    noisy = np.ones(500) + np.random.default_rng(1).normal(0, 0.1, 500)
    assert smoothed(noisy).std() < 0.5 * noisy.std()


def test_curves_are_drawn_over_their_samples_with_their_last_loss():
    # A first spike does not squeeze the rest.
    curves = {"a": curve([900.0, *np.linspace(1, 0.1, 200)]), "b": curve([1.0, 0.25])}
    (axes,) = loss_figure(curves, title="Losses").axes
    np.testing.assert_array_equal(axes.lines[2].get_xdata(), [1024, 2048])
    np.testing.assert_array_equal(axes.lines[2].get_ydata(), [1.0, 0.25])
    labels = [text.get_text() for text in axes.get_legend().get_texts()]
    assert labels == ["a (at the end 0.1)", "b (at the end 0.25)"]
    assert axes.get_ylim()[1] < 10


def test_figure_is_written_twice_alike(tmp_path):
    files = [tmp_path / name / "loss.csv" for name in ("one", "two")]
    for path, last in zip(files, (0.1, 0.2)):
        path.parent.mkdir()
        curve(np.linspace(1, last, 50)).to_csv(path, index=False)
    curves = [{"experiment": "two", "label": "second"}, {"experiment": "one", "label": "first"}]
    paths = tmp_path / "f.png", tmp_path / "f.svg"
    written = []
    for _ in range(2):
        draw(files, *paths, title="Losses", curves=curves, run={"scale": "test"})
        written.append([path.read_bytes() for path in paths])
    assert written[0] == written[1]
    assert b"second (at the end 0.2)" in written[0][1] and b"<dc:date>" not in written[0][1]
