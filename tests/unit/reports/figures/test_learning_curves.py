import numpy as np
import pandas as pd
import pytest
from report_samples import row, written_figure

from neural_shadows.evaluation.look import COLOURS
from neural_shadows.reports.data.curve_lines import EXTRAPOLATED, MEASURED
from neural_shadows.reports.data.trained import THESIS_SAMPLES
from neural_shadows.reports.figures.learning_curves import curves_figure, draw

BUDGETS = 1e6 * np.array([1, 2, 4, 8])


def lines_of(label, metric, values, *, null, thesis=np.nan):
    """A method's rows: two trainings a budget, no extrapolation."""
    seeds = [f"{0.99 * value:.6g} {1.01 * value:.6g}" for value in values]
    budgets = pd.DataFrame({"samples": BUDGETS, "mean": values, "by_seed": seeds, "kind": MEASURED})
    predicted = pd.DataFrame({"predicted": [0.2], "predicted_low": 0.18, "predicted_high": 0.23})
    budgets.loc[3, predicted.columns] = predicted.iloc[0]
    end = pd.DataFrame({"samples": [THESIS_SAMPLES], "thesis": [thesis], "kind": EXTRAPOLATED})
    named = {"scene": "dragon", "method": label, "metric": metric, "no_shadow": null}
    return pd.concat([budgets, end], ignore_index=True).assign(**named)


@pytest.fixture
def table():
    falling = 0.4 * (BUDGETS / BUDGETS[0]) ** -0.3
    return pd.concat(
        [
            lines_of("A", "loss", falling, null=0.7),
            lines_of("B", "loss", 1.2 * falling, null=0.3),
            lines_of("A", "ssim", 1 - falling, null=0.5, thesis=0.97),
            lines_of("B", "ssim", 1 - 1.2 * falling, null=0.5),
        ],
        ignore_index=True,
    )


def test_trainings_law_prediction_and_null(table):
    looks = {"A": (COLOURS[0], "o"), "B": (COLOURS[1], "o")}
    figure = curves_figure(table, looks, title="Curves")
    loss, ssim = figure.axes[:2]
    points = next(line for line in loss.lines if line.get_marker() == "o").get_xydata()
    assert points[0].tolist() == pytest.approx([BUDGETS[0], 0.99 * 0.4])
    dotted = [line for line in loss.lines if line.get_linestyle() == ":"]
    assert [line.get_ydata()[0] for line in dotted] == [0.3, 0.7]
    assert len({line.get_color() for line in dotted}) == 2  # of each method's own rays
    # The law of the first three budgets goes on to the fourth, dashed.
    dashed = next(line for line in loss.lines if line.get_linestyle() == "--")
    assert dashed.get_xdata()[[0, -1]].tolist() == pytest.approx(BUDGETS[-2:])
    assert dashed.get_ydata()[-1] == pytest.approx(0.4 * 8**-0.3, rel=1e-3)
    # SSIM is drawn as the error that falls to 0: its interval and the thesis's value, too.
    assert ssim.get_yscale() == "log"
    bars = ssim.containers[0].lines[2][0].get_segments()[0]
    assert bars[:, 1].tolist() == pytest.approx([1 - 0.23, 1 - 0.18])
    low, high = loss.get_ylim()  # whole in the panel, though drawn beside its place
    assert low < 0.18
    figure.draw_without_rendering()
    assert "100B" in [text.get_text() for text in ssim.get_xticklabels()]
    star = next(line for line in ssim.lines if line.get_marker() == "*")
    assert star.get_xydata()[0].tolist() == pytest.approx([THESIS_SAMPLES, 0.03])
    assert len([line for line in ssim.lines if line.get_linestyle() == ":"]) == 1
    names = [text.get_text() for text in figure.legends[0].get_texts()]
    assert names[:2] == ["A", "B"] and "as the thesis prints it" in names
    assert "extrapolated, 90 %" not in names


def test_more_methods_than_colours_are_drawn(table, tmp_path):
    labels = [f"method {k}" for k in range(len(COLOURS) + 1)]
    pd.concat([table[table["method"] == "A"].assign(method=label) for label in labels]).to_csv(
        tmp_path / "table.csv", index=False
    )
    text = written_figure(
        draw,
        tmp_path,
        title="Curves",
        table_csv=tmp_path / "table.csv",
        rows=[row(label, label) for label in labels],
    )
    assert all(f">{label}<" in text for label in labels)


def test_a_scene_of_a_table_is_drawn(table, tmp_path):
    other = table.assign(scene="fence", method="C")
    pd.concat([table, other]).to_csv(tmp_path / "table.csv", index=False)
    rows = [row("a", "A"), row("b", "B")]
    text = written_figure(
        draw, tmp_path, title="Curves", table_csv=tmp_path / "table.csv", rows=rows
    )
    assert ">B<" in text and ">C<" not in text
    assert ">Curves (test scale)<" in text
