import pandas as pd
from report_samples import PUBLISHED

from neural_shadows.reports.data.equivalent_maps import equivalent_maps
from neural_shadows.reports.data.published import printed_networks, read_published

METHODS = ["shadow_map_128", "shadow_map_512", "shadow_map_pcf_256", "network", "no_shadow"]


def test_sizes_between_the_maps_and_outside_them():
    table = {"lpips": [0.4, 0.1, 0.2, 0.05, 0.5], "psnr_pooled": [24.0, 30, 27, 31, 12]}
    found = equivalent_maps(pd.DataFrame(table), METHODS)
    # A map that is filtered is a method, and no measure for others.
    assert found["map_lpips"] == found["map_psnr"] == ["", "", "256", "> 512", "< 128"]


def test_nothing_without_two_maps_or_without_lpips():
    table = pd.DataFrame({"lpips": [float("nan")] * 5, "psnr_pooled": [24.0, 30, 27, 31, 12]})
    assert equivalent_maps(table, METHODS)["map_lpips"] == [""] * 5
    some = table.iloc[1:].reset_index(drop=True)
    assert equivalent_maps(some, METHODS[1:])["map_psnr"] == [""] * 4


def test_the_thesis_is_worth_what_its_tables_say():
    published = read_published(PUBLISHED)
    dragon = printed_networks(published, "dragon")
    assert dragon[["lpips", "psnr", "map_lpips", "map_psnr"]].to_numpy().tolist() == [
        [0.0379, 27.39, "386", "191"]
    ]
    assert dragon["stored_bytes"].tolist() == [2175 * 1024]
    landscape = printed_networks(published, "landscape").set_index("method")
    assert landscape["map_psnr"]["Thesis's network, as printed"] == "245"  # 128 · 2^(6.95 / 7.44)
    assert len(landscape) == 2
