import numpy as np
import pytest
from report_samples import MACHINE, write_record, written_table

from neural_shadows.reports.tables.cost import growth, write


def test_growth_is_the_exponent_of_a_power_over_the_largest_sizes():
    sizes = np.array([1000, 10, 100, 10000])
    for exponent in (0, 0.5, 2):
        assert growth(sizes, 3.0 * sizes**exponent) == pytest.approx(exponent, abs=1e-9)
    assert growth(sizes, np.array([1000.0, 50, 100, 10000])) == pytest.approx(1)
    assert np.isnan(growth(sizes[:1], np.array([1.0])))


def test_table_has_a_row_for_each_stage_and_size(tmp_path):
    costs = []
    for size in (10**4, 10**2, 10**3):
        labels = {"stage": "labels", "seconds": 1e-6 * size, "bytes": 2**20, "peak_bytes": 2**21}
        stages = [labels, {**labels, "stage": "training", "seconds": size**0.5, "bytes": 0}]
        cost = {"over": "samples", "size": size, "stages": stages, "machine": MACHINE, "threads": 2}
        costs.append(write_record(tmp_path / f"samples.{size}.json", cost))
    table, md = written_table(write, tmp_path, costs=costs)
    assert table["stage"].tolist() == ["labels"] * 3 + ["training"] * 3
    assert table["size"].tolist() == [100, 1000, 10000] * 2
    assert table["seconds_exponent"].tolist() == pytest.approx([1] * 3 + [0.5] * 3)
    assert table["memory_mib"].tolist() == [1] * 3 + [0] * 3
    assert table["memory_mib_exponent"].isna().tolist() == [False] * 3 + [True] * 3
    assert "a CPU, 2 threads" in md.read_text()
