import numpy as np
import pandas as pd

from neural_shadows.metrics.power_law import Curve
from neural_shadows.reports.data.curve_lines import metric_lines
from neural_shadows.reports.figures.frame_curves import draw

FRAMES = np.array([12, 48, 84])
AWAY = np.array([-0.01, 0.0, 0.01])  # relative, of the seeds' errors


def test_a_colour_a_network_and_a_marker_a_number_of_steps(tmp_path):
    """And a dotted line of what its base gives; no shadow, far above, in words."""
    names = {600: "A, 600 steps", 2400: "A, 2,400 steps"}
    lines = [
        {"scene": "layouts", "method": name, "metric": "mse", "no_shadow": 0.1, "base": 0.008}
        | {"thesis": np.nan}
        | line
        for steps, name in names.items()
        for line in metric_lines(
            "mse",
            Curve(FRAMES, np.outer(2.4 / steps * FRAMES**-0.5, 1 + AWAY)),
            4 * FRAMES[-1],
            seed=0,
            diverged=False,
        )
    ]
    pd.DataFrame(lines).to_csv(tmp_path / "table.csv", index=False)
    rows = [
        {"label": name, "experiment": "a", "steps": steps, "scene": "layouts"}
        for steps, name in names.items()
    ]
    (axes,) = draw(tmp_path / "table.csv", rows, "Curves").axes
    dots = [line for line in axes.lines if line.get_alpha()]  # one a training
    assert [*dict.fromkeys(line.get_marker() for line in dots)] == ["o", "^"]
    assert len({line.get_color() for line in dots}) == 1
    of_12_frames = dots[1].get_xydata()[0]  # of the second seed
    assert np.allclose(of_12_frames, [12, 1e4 * 2.4 / 600 * 12**-0.5])  # × 10⁻⁴
    assert axes.get_xlabel() == "training frames"
    levels = {line.get_linestyle(): line.get_ydata()[0] for line in axes.lines}
    assert levels[":"] == 80 and axes.get_title().endswith("(no shadow: 1,000)")
