import pandas as pd

from neural_shadows.reports.figures.cost import cost_figure


def test_a_line_for_each_stage_with_its_exponent():
    sizes = {"over": "samples", "size": [10, 100, 10, 100], "stage": ["rays"] * 2 + ["labels"] * 2}
    values = {"seconds": [1.0, 10, 2, 2], "memory_mib": [5.0, 5, 0, 0]}
    exponents = {"seconds_exponent": [1.0, 1, 0, 0], "memory_mib_exponent": 0.0}
    seconds, memory = cost_figure(pd.DataFrame({**sizes, **values, **exponents}), title="C").axes
    assert [line.get_label() for line in seconds.lines] == ["rays (1.00)", "labels (0.00)"]
    assert [line.get_label() for line in memory.lines] == ["rays (0.00)"]  # 0 has no logarithm
    assert [axes.get_ylabel() for axes in (seconds, memory)] == ["seconds", "peak memory, MiB"]
