import math
from pathlib import Path

import pytest

from neural_shadows.errors import InputError
from neural_shadows.reports.published import printed, read_published

PATH = Path(__file__).parents[3] / "config" / "published.csv"

# rows x columns of each table in the thesis
SIZES = {
    "4.1": (3, 3),
    "4.2": (4, 3),
    "4.3": (6, 3),
    "4.4": (6, 3),
    "4.5": (7, 3),
    "4.6": (6, 3),
    "4.7": (6, 1),
}


@pytest.fixture(scope="module")
def published():
    return read_published(PATH)


def test_all_tables_are_complete(published):
    assert set(published["table"]) == set(SIZES)
    assert len(published) == 102
    for table, (rows, columns) in SIZES.items():
        part = published[published["table"] == table]
        assert (part["row"].nunique(), part["column"].nunique()) == (rows, columns), table
        assert len(part) == rows * columns, table
        assert part.groupby("row")["label"].nunique().eq(1).all()


@pytest.mark.parametrize(
    ("table", "row", "column", "value"),
    [
        ("4.1", "poisson_quadtree", "lpips", 0.0392),
        ("4.1", "uniform", "psnr", 25.54),
        ("4.2", "frequencies_10", "lpips", 0.0379),
        ("4.2", "frequencies_30", "psnr", 27.13),
        ("4.2", "frequencies_20", "ssim", 0.9698),
        ("4.3", "shadow_map_2048", "psnr", 38.50),
        ("4.3", "network", "lpips", 0.0379),
        ("4.3", "shadow_map_128", "ssim", 0.9303),
        ("4.4", "network", "psnr", 17.29),
        ("4.4", "shadow_map_256", "ssim", 0.8954),
        ("4.5", "network_single_axis", "lpips", 0.0210),
        ("4.5", "network_general", "psnr", 39.04),
        ("4.6", "dragon_256", "frame_ms", 29.1),
        ("4.6", "landscape_128", "lpips", 0.0187),
        ("4.6", "dragon_64", "size_kib", 160),
        ("4.7", "shadow_map_2048", "memory_mib", 16),
        ("4.7", "network", "memory_mib", 2.12),
        ("4.7", "shadow_map_128", "memory_mib", 64 / 1024),
    ],
)
def test_spot_values(published, table, row, column, value):
    assert printed(published, table, row, column) == value


def test_one_number_printed_twice_agrees(published):
    # The 256-wide single-axis landscape network is in tables 4.5 and 4.6, the dragon's in 4.3 too.
    assert printed(published, "4.6", "landscape_256", "lpips") == printed(
        published, "4.5", "network_single_axis", "lpips"
    )
    assert printed(published, "4.6", "dragon_256", "lpips") == printed(
        published, "4.3", "network", "lpips"
    )


def test_sizes_follow_from_the_parameter_counts(published):
    for width, parameters in {64: 40_896, 128: 147_328, 256: 556_800}.items():
        size = printed(published, "4.6", f"dragon_{width}", "size_kib")
        assert size == pytest.approx(parameters * 4 / 1024, abs=0.51)
    memory = printed(published, "4.7", "network", "memory_mib")
    assert memory == pytest.approx(556_800 * 4 / 2**20, abs=0.005)


def test_shadow_map_memory_is_four_bytes_a_texel(published):
    for resolution in (128, 256, 512, 1024, 2048):
        memory = printed(published, "4.7", f"shadow_map_{resolution}", "memory_mib")
        assert memory == resolution**2 * 4 / 2**20


def test_what_is_not_printed_is_nan(published):
    assert math.isnan(printed(published, "4.6", "dragon_64", "psnr"))
    assert math.isnan(printed(published, "4.9", "network", "lpips"))


HEAD = "table,row,label,column,value,unit,section\n"


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("table,row\n4.1,uniform\n", "no column label"),
        (HEAD + "4.1,a,A,psnr,high,dB,4.2.1\n", "cannot be"),
        (HEAD + "4.1,a,A,psnr,,dB,4.2.1\n", "line 2"),
        (HEAD + "4.1,a,A,psnr,25,dB,4.2.1,1,2\n4.1,b,A,psnr,25,dB,4.2.1,1,2,3\n", "cannot be read"),
        (
            HEAD + "4.1,a,A,psnr,25,dB,4.2.1\n" * 2,
            "is there twice",
        ),
    ],
)
def test_bad_file_is_named(tmp_path, text, message):
    path = tmp_path / "printed.csv"
    path.write_text(text)
    with pytest.raises(InputError, match=message) as caught:
        read_published(path)
    assert str(path) in str(caught.value)
    assert "\n" not in str(caught.value)


def test_missing_file_is_named(tmp_path):
    with pytest.raises(InputError, match="none.csv"):
        read_published(tmp_path / "none.csv")
