import numpy as np
import pytest
from report_samples import write_record, written_table
from sample_records import MACHINE

from neural_shadows.reports.tables.cost import growth, write


def measured(size: int) -> dict:
    """Labels linear in the samples, training as the root; one MiB whatever the samples."""
    return {
        "over": "samples",
        "size": size,
        "stages": [
            {"stage": "labels", "seconds": 1e-6 * size, "bytes": 2**20, "peak_bytes": 2**21},
            {"stage": "training", "seconds": size**0.5, "bytes": 0, "peak_bytes": 2**21},
        ],
        "machine": MACHINE,
        "threads": 2,
    }


def test_growth_is_the_exponent_of_a_power_over_the_largest_sizes():
    sizes = np.array([1000, 10, 100, 10000])
    for exponent in (0, 0.5, 1, 2):
        assert growth(sizes, 3.0 * sizes**exponent) == pytest.approx(exponent, abs=1e-9)
    assert growth(sizes, np.array([1000.0, 50, 100, 10000])) == pytest.approx(1)
    assert np.isnan(growth(sizes[:1], np.array([1.0])))
    assert np.isnan(growth(sizes, np.zeros(4)))


def test_table_has_a_row_for_each_stage_and_size(tmp_path):
    sizes = (10**4, 10**2, 10**3)
    costs = [write_record(tmp_path / f"samples.{size}.json", measured(size)) for size in sizes]
    table, md = written_table(write, tmp_path, costs=costs)
    assert table["stage"].tolist() == ["labels"] * 3 + ["training"] * 3
    assert table["size"].tolist() == [100, 1000, 10000] * 2
    labels, training = (table[table["stage"] == stage] for stage in ("labels", "training"))
    assert labels["seconds_exponent"].tolist() == pytest.approx([1] * 3)
    assert training["seconds_exponent"].tolist() == pytest.approx([0.5] * 3)
    assert labels["memory_mib"].tolist() == [1] * 3
    assert labels["memory_mib_exponent"].tolist() == pytest.approx([0] * 3, abs=1e-9)
    assert training["memory_mib_exponent"].isna().all()
    assert "a CPU, 2 threads" in md.read_text()
