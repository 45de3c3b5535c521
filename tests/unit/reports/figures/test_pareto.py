import numpy as np
import pandas as pd
from matplotlib.backends.backend_agg import FigureCanvasAgg

from neural_shadows.reports.figures.pareto import draw, front, kind_of, pareto_figure

NAN = float("nan")
METHODS = ["ray_traced", "shadow_map_512", "shadow_map_256", "field_biased", "dragon"]
TABLE = pd.DataFrame(
    {
        "scene": "dragon",
        "method": ["Ray traced", "512²", "256²", "Field", "Thesis"],
        "encoding": [None, None, None, "occupancy_field", "frequency"],
        "lpips": [NAN, 0.01, 0.02, 0.005, 0.09],
        "lpips_low": [NAN, 0.009, 0.018, 0.004, 0.08],
        "lpips_high": [NAN, 0.012, 0.022, 0.006, 0.10],
        "flip": [NAN, 0.1, 0.2, 0.05, 0.9],
        "flip_low": [NAN, 0.09, 0.18, 0.04, 0.8],
        "flip_high": [NAN, 0.12, 0.22, 0.06, 1.0],
        "bytes": [NAN, 2.0**20, 2.0**18, 7e5, 2e6],
        "frame_ms": [5.0, 60.0, 20.0, 30.0, 900.0],
        "training_seconds": [NAN, NAN, NAN, 20.0, 300.0],
    }
)


def test_front_is_what_nothing_else_undercuts():
    rng = np.random.default_rng(0)
    cost, error = rng.integers(0, 12, (2, 40)).astype(float)
    points = np.stack([cost, error], axis=1)
    undercut = [(np.all(points <= p, axis=1) & np.any(points < p, axis=1)).any() for p in points]
    found = front(cost, error)
    assert {*map(tuple, points[found])} == {*map(tuple, points[~np.array(undercut)])}
    assert (np.diff(cost[found]) > 0).all() and (np.diff(error[found]) < 0).all()


def test_panels_show_what_has_a_cost_and_name_the_front():
    kinds = [kind_of(m, encoding) for m, encoding in zip(METHODS, TABLE["encoding"])]
    assert kinds == ["ray traced", "shadow map", "shadow map", "occupancy_field", "frequency"]
    figure = pareto_figure(TABLE.assign(kind=kinds), title="Dragon")
    assert [len(axes.containers) for axes in figure.axes] == [4, 4, 2]
    named = [{text.get_text() for text in axes.texts} for axes in figure.axes]
    # A map is a line to come below where it has no training to show.
    assert named == [
        {"256²", "Field"},
        {"ray traced: 0", "256²", "Field"},
        {"512²", "256²", "Field"},
    ]
    FigureCanvasAgg(figure).draw()
    for axes in figure.axes:
        for box in (text.get_window_extent() for text in axes.texts):
            assert axes.bbox.x0 <= box.x0 and box.x1 <= axes.bbox.x1


def test_flip_takes_the_place_of_missing_lpips(tmp_path):
    TABLE.assign(lpips=NAN, lpips_low=NAN, lpips_high=NAN).to_csv(tmp_path / "t.csv", index=False)
    rows = [{"method": m, "label": label} for m, label in zip(METHODS, TABLE["method"])]
    paths = [tmp_path / name for name in ("t.csv", "a.png", "a.svg")]
    draw(*paths, title="Dragon", scene="dragon", rows=rows, run={"scale": "test"})
    assert "FLIP, mean" in paths[2].read_text(encoding="utf-8")
