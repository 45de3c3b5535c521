import numpy as np
import pytest
from claim_samples import PRINTED as TABLES
from claim_samples import measured

from neural_shadows.reports.claims.gates import judge

ALL = ["lpips", "psnr", "ssim"]


def judged(table, metrics=("lpips",), data=None, **compared):
    claim = {"kind": "printed", "table": table, "metrics": list(metrics), **compared}
    return judge(claim, data or measured())


@pytest.mark.parametrize(
    ("table", "pairs", "metrics", "expected"),
    [
        ("4.4", [["network", "shadow_map_128"]], ALL, "contradicted"),
        ("4.5", [["network_single_axis", "shadow_map_512"]], ALL, "contradicted"),
        ("4.2", [["frequencies_30", "frequencies_20"]], ALL, "supported"),
        ("4.2", [["frequencies_10", "frequencies_10"]], ["lpips"], "undecided"),
    ],
)
def test_the_thesis_is_judged_by_its_own_tables(table, pairs, metrics, expected):
    outcome = judged(table, metrics, pairs=pairs)
    assert outcome["verdict"] == expected
    assert np.isnan([outcome["seeds"], outcome["budget_fraction"]]).all()


@pytest.mark.parametrize(
    ("texels", "metric", "expected"),
    [(512, "lpips", "undecided"), (512, "psnr", "contradicted"), (256, "psnr", "supported")],
)
def test_a_row_is_worth_a_map_of_a_size(texels, metric, expected):
    outcome = judged("4.3", [metric], row="network", equivalent_to=texels)
    assert outcome["verdict"] == expected
    words = {
        "lpips": "LPIPS of Our method 0.0379: as a map of 386² [",
        "psnr": "PSNR of Our method 27.39: as a map of 191² [",
    }
    assert words[metric] in outcome["evidence"]


@pytest.mark.parametrize(("lpips", "expected"), [(0.0354, "undecided"), (0.0352, "supported")])
def test_a_printed_difference_counts_from_twice_that_from_run_to_run(lpips, expected):
    # 0.0013 apart is what the same configuration is, printed twice.
    published = TABLES.copy()
    cell = (published["row"] == "frequencies_30") & (published["column"] == "lpips")
    published.loc[cell, "value"] = lpips
    pairs = [["frequencies_30", "frequencies_10"]]
    outcome = judged("4.2", data=measured(published=published), pairs=pairs)
    assert outcome["verdict"] == expected
    assert " times that from run to run (0.0013)" in outcome["evidence"]
