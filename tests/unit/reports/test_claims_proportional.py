"""Claims on proportional columns, on a synthetic table."""

import pandas as pd
import pytest
from claim_samples import measured

from neural_shadows.reports.claims.gates import judge
from neural_shadows.reports.data import verdicts

LEVELS = pd.DataFrame(
    {
        "runtime": [8.0, 4.0, 2.0],
        "storage_io": [16.0, 8.0, 4.0],
        "compute": [1.0, 2.0, 4.0],
        "unmeasured": [1.0, float("nan"), 4.0],
    }
)


@pytest.mark.parametrize(
    ("to", "rather_than", "same_size", "verdict", "words"),
    [
        # (8 · 1 + 4 · 2 + 2 · 4)² of 84 · 21
        ("storage_io", "compute", True, verdicts.SUPPORTED, "R² 1.000 over storage_io, R² 0.327"),
        ("compute", "storage_io", True, verdicts.CONTRADICTED, "R² 0.327 over compute"),
        ("compute", "compute", True, verdicts.UNDECIDED, ""),  # alike
        ("storage_io", "unmeasured", True, verdicts.TOO_SMALL, "in a row of levels"),
        ("storage_io", "compute", False, verdicts.NOT_COMPARABLE, "the paper's size"),
        ("storage_io", "bytes", True, verdicts.TOO_SMALL, "no bytes in levels"),
    ],
)
def test_the_better_line_through_the_origin_decides(to, rather_than, same_size, verdict, words):
    claim = {"kind": "proportional", "table": "levels", "column": "runtime", "needs": {}}
    tables = {"levels": LEVELS.assign(of_printed_size=same_size)}
    outcome = judge(claim | {"to": to, "rather_than": rather_than}, measured(tables=tables))
    assert outcome["verdict"] == verdict and words in outcome["evidence"]
