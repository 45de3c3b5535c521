"""Costs are measured on request, each stage in a process of its own."""

import pandas as pd
from checkout import write_overlay


def test_costs_of_two_sizes(finished, tmp_path):
    sizes = {"subdivisions": [], "samples": [10000, 40000], "width": [], "views": []}
    overlay = write_overlay(tmp_path / "costs.yaml", tables={"cost": sizes | {"frame_width": []}})
    finished.run("reports/smoke/cost.csv", "reports/smoke/figure_cost.png", overlays=[overlay])
    table = pd.read_csv(finished.reports / "cost.csv")
    assert table[["stage", "size"]].to_numpy().tolist() == [
        [stage, size] for stage in ("labels", "rays", "training") for size in (10000, 40000)
    ]
    assert set(table["over"]) == {"samples"}
    assert (table["seconds"] > 0).all() and (table["peak_mib"] > 20).all()
    # What was made on the way to the numbers is gone.
    made = sorted(path.name for path in (finished.results / "cost").iterdir())
    assert made == ["samples.10000.json", "samples.40000.json"]
