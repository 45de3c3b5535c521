import numpy as np
from report_samples import PUBLISHED

from neural_shadows.reports.data.published import read_published

# rows x columns of each table in the thesis
SIZES = {"4.1": (3, 3), "4.2": (4, 3), "4.3": (6, 3), "4.4": (6, 3), "4.5": (7, 3), "4.6": (6, 3)}
# table, row, column: value
SPOTS = {
    "4.1 poisson_quadtree lpips": 0.0392,
    "4.1 uniform psnr": 25.54,
    "4.2 frequencies_10 lpips": 0.0379,
    "4.2 frequencies_20 ssim": 0.9698,
    "4.3 shadow_map_2048 psnr": 38.50,
    "4.3 shadow_map_128 ssim": 0.9303,
    "4.4 network psnr": 17.29,
    "4.4 shadow_map_256 ssim": 0.8954,
    "4.5 network_single_axis lpips": 0.0210,
    "4.5 network_general psnr": 39.04,
    "4.6 dragon_256 frame_ms": 29.1,
    "4.6 landscape_128 lpips": 0.0187,
    "4.7 network memory_mib": 2.12,
}


def test_tables_are_complete_and_as_printed():
    published = read_published(PUBLISHED)
    assert {spot: published[tuple(spot.split())] for spot in SPOTS} == SPOTS
    frame = published.reset_index()
    assert len(frame) == 102 and np.isfinite(published).all() and published.index.is_unique
    for table, part in frame.groupby("table"):
        size = part["row"].nunique(), part["column"].nunique()
        assert size == SIZES.get(table, (6, 1)) and len(part) == np.prod(size), table
