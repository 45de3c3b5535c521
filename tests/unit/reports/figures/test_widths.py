import pandas as pd

from neural_shadows.reports.figures.widths import draw, width_figure

NAN = float("nan")
TABLE = pd.DataFrame(
    {
        "method": ["64", "256", "64", "256", "ray traced"],
        "scene": ["dragon", "dragon", "landscape", "landscape", "dragon"],
        "frame_ms": [10.0, 30.0, 11.0, 31.0, 5.0],
        "frame_ms_q1": [9.0, 29.0, 10.0, 30.0, 4.0],
        "frame_ms_q3": [12.0, 33.0, 13.0, 34.0, 6.0],
        "lpips": [0.09, 0.04, 0.03, 0.02, NAN],
        "lpips_low": [0.08, 0.03, 0.02, 0.01, NAN],
        "lpips_high": [0.10, 0.05, 0.04, 0.03, NAN],
        "thesis_frame_ms": [11.5, 29.1, 13.2, 32.8, NAN],
        "thesis_lpips": [0.0894, 0.0379, 0.0279, 0.021, NAN],
    }
)
WIDTHS = {(scene, str(w)): w for scene in ("dragon", "landscape") for w in (256, 64)}


def test_lines_of_each_scene_over_width(tmp_path):
    quality, speed = width_figure(TABLE, WIDTHS, title="Widths").axes
    ours = [line.lines[0] for line in quality.containers]
    assert [line.get_xdata().tolist() for line in ours] == [[64, 256], [64, 256]]
    assert [line.get_ydata().tolist() for line in ours] == [[0.09, 0.04], [0.03, 0.02]]
    dashed = [line for line in speed.lines if line.get_linestyle() == "--"]
    assert [line.get_ydata().tolist() for line in dashed] == [[11.5, 29.1], [13.2, 32.8]]

    paths = [tmp_path / name for name in ("t.csv", "a.png", "a.svg")]
    rows = [{"scene": s, "label": label, "width": w} for (s, label), w in WIDTHS.items()]
    rows.append({"scene": "dragon", "label": "ray traced", "width": None})
    TABLE.to_csv(paths[0], index=False)
    draw(*paths, title="Widths", rows=rows, run={"scale": "test"})
    assert paths[1].stat().st_size > 10_000
