import numpy as np
import pandas as pd
from frame_samples import write_frames

from neural_shadows.reports.data.frames import read_frames


def test_views_are_read_from_the_batch_that_has_them_in_the_order_asked_for(tmp_path):
    rng, paths, seen = np.random.default_rng(0), ([], []), {}
    for batch, numbers in {"000": (0, 1), "001": (2, 3)}.items():
        views = [(view_set, i) for view_set in ("shadow", "surface") for i in numbers]
        given = {m: {v: rng.random((4, 6)) for v in views} for m in ("reference", "b", "a")}
        for found, written in zip(paths, write_frames(tmp_path, given, batch)):
            found += written
        for method, frames in given.items():
            seen.setdefault(method, {}).update(frames)
    metrics = pd.DataFrame(
        [(s, i, m, "psnr", 10 * i) for s, i in seen["a"] for m in ("a", "b") if (m, i) != ("b", 3)],
        columns=["view_set", "view", "method", "metric", "value"],
    )
    asked = [("surface", 3), ("shadow", 0)]
    last, first = read_frames(*paths, metrics, asked)
    assert [list(frame.images) for frame in (last, first)] == [
        ["reference", "a"],  # without metrics of this view b is left out
        ["reference", "b", "a"],
    ]
    for frame, view in zip((last, first), asked):
        for method, image in frame.images.items():
            np.testing.assert_allclose(image, 0.25 + 0.75 * seen[method][view], atol=0.002)
    assert last.scores == {"a": {"psnr": 30}}
    assert last.caption.startswith("View 4 of 4, aimed at the object's surface")
