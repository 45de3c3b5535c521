import base64
import io

import numpy as np
import pandas as pd
from PIL import Image
from report_page import seen_frames, write_evaluated
from report_samples import row

from neural_shadows.reports.page.hard_comparison import hard_comparisons, map_picture


def test_frames_are_stored_without_loss_beside_their_scores(tmp_path):
    files = write_evaluated(tmp_path)
    # Two methods of one label bear their keys.
    labels = {"shadow_map_128": "A map", "shadow_map_512": "A map", "dragon": "Network"}
    rows = [row(method, label) for method, label in labels.items()]
    (data,) = hard_comparisons(**files, rows=rows, meshes={"dragon": "the dragon"})
    names = [method["name"] for method in data["methods"]]
    assert names == [
        "★ Reference",
        "■ A map (shadow_map_128)",
        "■ A map (shadow_map_512)",
        "✶ Network",
    ]
    assert (data["left"], data["right"]) == ("dragon", "reference")
    shown = data["views"][1]["pictures"]["dragon"]
    reference, change = (
        Image.open(io.BytesIO(base64.b64decode(uri.removeprefix("data:image/webp;base64,"))))
        for uri in (data["views"][1]["reference"], shown["change"])
    )
    frame = Image.alpha_composite(reference.convert("RGBA"), change.convert("RGBA"))
    np.testing.assert_array_equal(
        np.asarray(frame)[..., 0],
        np.round(255 * (0.25 + 0.75 * seen_frames()["dragon"]["surface", 0])),
    )
    assert shown["scores"] == "LPIPS 0.1100, PSNR 24.20 dB, FLIP 0.2200"
    # Without a reference nothing is compared.
    assert hard_comparisons(**files | {"references": []}, rows=rows, meshes={}) == []


def test_the_thesis_s_network_is_shown_first(tmp_path):
    """Though a trained field errs no more: the best method looks like the reference."""
    field = row("shadow_map_128") | {"encoding": "occupancy_field", "trained": True}
    rows = [field, row("shadow_map_512"), row("dragon")]
    (data,) = hard_comparisons(**write_evaluated(tmp_path), rows=rows, meshes={})
    assert data["left"] == "dragon"
    files = write_evaluated(tmp_path)
    (data,) = hard_comparisons(**files, rows=rows[:2], meshes={})
    assert data["left"] == "shadow_map_128"
    values = pd.read_csv(files["metrics"][0])  # of two networks that of less error
    values.loc[(values["method"] == "shadow_map_512") & (values["metric"] == "flip"), "value"] = 0
    values.to_csv(files["metrics"][0], index=False)
    fields = [field | {"method": method} for method in ("shadow_map_128", "shadow_map_512")]
    (data,) = hard_comparisons(**files, rows=fields, meshes={})
    assert data["left"] == "shadow_map_512"


def test_map_is_black_where_nothing_differs():
    error = np.zeros((4, 6))
    error[2:, 4:] = 1
    picture = np.asarray(map_picture(error))
    assert picture.shape == (2, 3, 3) and picture[0, 0].tolist() == [0, 0, 4]
    assert picture[1, 2].tolist() == [252, 253, 191]  # magma's ends


def test_of_a_half_finished_run_what_each_view_has_is_shown(tmp_path):
    files = write_evaluated(tmp_path)
    values = pd.read_csv(files["metrics"][0])
    values[values["method"] != "dragon"].to_csv(files["metrics"][0], index=False)
    (data,) = hard_comparisons(**files, rows=[], meshes={})
    shown = ["reference", "shadow_map_128", "shadow_map_512"]
    assert [method["key"] for method in data["methods"]] == shown
    assert all(list(view["pictures"]) == shown for view in data["views"])
