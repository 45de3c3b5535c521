import numpy as np
import pandas as pd
import pytest

from neural_shadows.errors import InputError
from neural_shadows.reports.figures.loss import loss_figure, smoothed, write_loss_figure
from neural_shadows.training.loss_curve import read_loss


def curve(losses):
    steps = np.arange(1, len(losses) + 1)
    return pd.DataFrame(
        {"step": steps, "samples": 1024 * steps, "learning_rate": 1e-3, "loss": losses}
    )


@pytest.fixture
def loss_csv(tmp_path):
    path = tmp_path / "loss.csv"
    curve(np.linspace(1, 0.1, 50)).to_csv(path, index=False, lineterminator="\n")
    return path


def test_running_mean_keeps_a_line_and_length():
    line = np.linspace(5, 1, 500)
    smooth = smoothed(line)
    assert smooth.shape == line.shape
    np.testing.assert_allclose(smooth, line)  # its ends too, where the loss falls fastest
    noisy = np.ones(500) + np.random.default_rng(1).normal(0, 0.1, 500)
    assert smoothed(noisy).std() < 0.5 * noisy.std()


def test_curves_are_drawn_over_their_samples_with_their_last_loss():
    figure = loss_figure({"a": curve([3.0, 2.0]), "b": curve([1.0, 0.25])}, title="Losses")
    (axes,) = figure.axes
    np.testing.assert_array_equal(axes.lines[2].get_xdata(), [1024, 2048])
    np.testing.assert_array_equal(axes.lines[2].get_ydata(), [1.0, 0.25])
    labels = [text.get_text() for text in axes.get_legend().get_texts()]
    assert labels == ["a (at the end 2)", "b (at the end 0.25)"]


def test_figure_is_written_twice_alike(loss_csv, tmp_path):
    for name in ("one", "two"):
        write_loss_figure(
            [loss_csv],
            tmp_path / f"{name}.png",
            tmp_path / f"{name}.svg",
            title="Losses",
            labels=["a"],
            scale="test",
        )
    for ending in ("png", "svg"):
        assert (tmp_path / f"one.{ending}").read_bytes() == (
            tmp_path / f"two.{ending}"
        ).read_bytes()


@pytest.mark.parametrize("damage", ["cut", "empty", "header", "missing"])
def test_damaged_curve_is_named(loss_csv, damage):
    text = loss_csv.read_text()
    if damage == "missing":
        loss_csv.unlink()
    else:
        loss_csv.write_text({"cut": text[:-3], "empty": "", "header": "a,b\n1,2\n"}[damage])
    with pytest.raises(InputError, match=r"loss\.csv: (not a whole|no such)"):
        read_loss(loss_csv)
