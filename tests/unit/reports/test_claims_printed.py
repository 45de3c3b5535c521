import numpy as np
import pytest
from claim_samples import PRINTED as TABLES
from claim_samples import measured

from neural_shadows.reports.claims.gates import judge

# The thesis against its own tables. 4.6 has 64 neurons worst on the landscape.
PRINTED = {
    "wider is worse": (
        {
            "table": "4.6",
            "pairs": [["landscape_64", "landscape_128"], ["landscape_128", "landscape_256"]],
        },
        ["lpips"],
        "contradicted",
    ),
    "fence better than 128": (
        {"table": "4.4", "pairs": [["network", "shadow_map_128"]]},
        ["lpips", "psnr", "ssim"],
        "contradicted",
    ),
    "axis better than 512": (
        {"table": "4.5", "pairs": [["network_single_axis", "shadow_map_512"]]},
        ["lpips", "psnr", "ssim"],
        "contradicted",
    ),
    "comparable to 512": (
        {"table": "4.3", "row": "network", "equivalent_to": 512},
        ["lpips", "psnr"],
        "contradicted",
    ),
    "30 better than 20 frequencies": (
        {"table": "4.2", "pairs": [["frequencies_30", "frequencies_20"]]},
        ["lpips", "psnr", "ssim"],
        "supported",
    ),
    "the same trained twice": (
        {"table": "4.2", "pairs": [["frequencies_10", "frequencies_10"]]},
        ["lpips"],
        "undecided",
    ),
    "between 256 and 512": (
        {"table": "4.3", "row": "network", "equivalent_to": 256},
        ["psnr"],
        "supported",
    ),
}


@pytest.mark.parametrize(("about", "metrics", "expected"), PRINTED.values(), ids=PRINTED)
def test_the_thesis_is_judged_by_its_own_tables(about, metrics, expected):
    outcome = judge({"kind": "printed", "metrics": metrics, **about}, measured())
    assert outcome["verdict"] == expected
    assert np.isnan([outcome["seeds"], outcome["budget_fraction"]]).all()


def test_the_thesis_is_worth_a_map_of_386_texels_by_lpips_and_of_191_by_psnr():
    claim = {"kind": "printed", "table": "4.3", "row": "network", "equivalent_to": 512}
    outcome = judge({**claim, "metrics": ["lpips", "psnr"]}, measured())["evidence"]
    assert "LPIPS of Our method 0.0379: as a map of 386² [" in outcome
    assert "PSNR of Our method 27.39: as a map of 191² [" in outcome


@pytest.mark.parametrize(("lpips", "expected"), [(0.0354, "undecided"), (0.0352, "supported")])
def test_a_printed_difference_counts_from_twice_that_from_run_to_run(lpips, expected):
    # 0.0013 apart is what the same configuration is, printed twice.
    published = TABLES.copy()
    cell = (published["row"] == "frequencies_30") & (published["column"] == "lpips")
    published.loc[cell, "value"] = lpips
    claim = {"kind": "printed", "table": "4.2", "pairs": [["frequencies_30", "frequencies_10"]]}
    outcome = judge(claim | {"metrics": ["lpips"]}, measured(published=published))
    assert outcome["verdict"] == expected
    assert " times that from run to run (0.0013)" in outcome["evidence"]
