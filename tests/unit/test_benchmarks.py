"""What the benchmarks print is right; how fast anything is they measure and no test asserts."""

from types import SimpleNamespace

import bench_field
import numpy as np
import precision_of_queries
import pytest
import torch
from measurement import COLUMNS, Row, median_seconds, table


def test_shares_and_ratios():
    rows = table(
        [
            Row("labels", "cpu", 3.0, "samples/s", ceiling=4.0, peer="trimesh", peer_rate=0.5),
            Row("rays", "cpu", 2.0, "samples/s"),
        ]
    )
    assert list(rows) == COLUMNS
    assert rows.iloc[0][["share", "ratio"]].tolist() == [0.75, 6.0]
    assert rows.iloc[1][["ceiling", "share", "peer", "ratio"]].isna().all()


def test_works_are_done_in_turn_and_the_first_round_does_not_count(monkeypatch):
    clock, done = [0.0], []
    monkeypatch.setattr("measurement.time.perf_counter", lambda: clock[0])
    seconds = {"a": iter([9, 1, 2, 6]), "b": iter([9, 4, 3, 5])}

    def work(name):
        done.append(name)
        clock[0] += next(seconds[name])

    found = median_seconds({"a": lambda: work("a"), "b": lambda: work("b")}, 3)
    assert done == ["a", "b"] * 4
    assert found == {"a": pytest.approx(2), "b": pytest.approx(4)}


def test_what_a_coarser_format_costs_is_counted():
    """Depths off by 0.01 and −0.02: of 11 points, those within that of the depth 1 flip."""

    def depths(origins, d, dtype):
        error = {torch.float32: 0.0, torch.bfloat16: 0.01, torch.float16: -0.02}[dtype]
        return torch.full((len(origins),), 1.0 + error)

    network = SimpleNamespace(depths=depths, device=torch.device("cpu"))
    # On the sphere's axis towards the light a point at height z has s = 1 − z; the last is culled.
    s = np.array([0.5, 0.975, 0.985, 0.995, 1.002, 1.005, 1.015, 1.03, 1.5, 1.6, -1.0])
    p = np.stack([0 * s, 1 - s, 0 * s], axis=1).astype(np.float32)
    view = SimpleNamespace(light=np.array([0.0, 1.0, 0.0]))
    found = precision_of_queries.differences(network, [SimpleNamespace(p=p, view=view)])
    assert found["precision"].tolist() == ["bfloat16", "float16"]
    for column in ("median", "share_90", "rms"):
        assert found[column].tolist() == pytest.approx([0.01, 0.02], abs=1e-6)
    assert found["flipped"].tolist() == [2 / 11, 2 / 11]


@pytest.mark.parametrize(
    ("ratios", "said"),
    [
        ([0.5, 2.0, 3.0], "field as fast from 10,000 triangles on; ratio at 1,000,000"),
        ([1.5, 2.0, 3.0], "field as fast from fewer than 1,000 triangles on; ratio at 1,000,000"),
        ([1.5, 0.5, 0.9], "field not as fast at 1,000,000 triangles; ratio there"),
    ],
)
def test_from_how_many_triangles_on_a_field_is_faster(ratios, said):
    counts = np.array([1_000, 100_000, 1_000_000])
    assert bench_field.crossing(counts, np.array(ratios)) == said
