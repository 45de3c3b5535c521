import numpy as np
import pytest
import report_samples as samples
from frame_samples import write_frames

from neural_shadows.evaluation.metric_files import write_metrics
from neural_shadows.reports.figures import contact_sheet


@pytest.mark.parametrize(("views", "shown"), [(3, [0, 1, 2]), (47, list(range(0, 48, 2)))])
def test_every_method_has_a_row_of_numbered_views(tmp_path, views, shown):
    lit = np.ones((8, 12))
    lit[2:4] = 0
    frames = {m: {("shadow", i): lit for i in range(views)} for m in ("reference", "same", "none")}
    frames["none"] = dict.fromkeys(frames["none"], np.ones_like(lit))
    references, visibilities = write_frames(tmp_path, frames)
    key = {"scene": "dragon", "part": "shadow", "radius": 0, "metric": "psnr"}
    psnr = {"same": 100.0, "none": 10.0}
    rows = [
        {"frame": i, "method": m, "value": value + i / 100} | key
        for m, value in psnr.items()
        for i in range(views)
    ]
    write_metrics(tmp_path / "metrics.csv", rows)
    figure = contact_sheet.draw(
        metrics=[tmp_path / "metrics.csv"],
        references=references,
        visibilities=visibilities,
        mesh_json=samples.write_mesh(tmp_path),
        title="All views",
        rows=[samples.row("same", "Same"), samples.row("none", "None")],
        run=samples.RUN,
    )
    panels = [axes for axes in figure.axes if axes.images]
    texts = [axes.get_xlabel() for axes in panels]
    assert sorted(texts) == sorted(
        text for i in shown for text in (f"{i + 1}: equal", f"{i + 1}: {10 + i / 100:.1f}")
    )
    for axes in panels:
        red, _, blue = np.moveaxis(np.asarray(axes.images[0].get_array()), 2, 0)
        leak = blue > red + 0.1
        assert leak.any() == ("equal" not in axes.get_xlabel())
