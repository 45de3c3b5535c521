"""Claims on proportional columns, on synthetic tables."""

import numpy as np
import pandas as pd
import pytest
from claim_samples import measured

from neural_shadows.reports.claims.gates import judge
from neural_shadows.reports.claims.kinds.proportional import explained
from neural_shadows.reports.data import verdicts

CLAIM = {"kind": "proportional", "table": "levels", "column": "runtime", "needs": {}}
LEVELS = pd.DataFrame(
    {"runtime": [8.0, 4.0, 2.0], "storage_io": [16.0, 8.0, 4.0], "compute": [1.0, 2.0, 4.0]}
)


def judged(to, rather_than, same_size=True):
    levels = LEVELS.assign(of_printed_size=same_size)
    claim = CLAIM | {"to": to, "rather_than": rather_than}
    return judge(claim, measured(tables={"levels": levels}))


@pytest.mark.parametrize(
    ("to", "rather_than", "verdict"),
    [
        ("storage_io", "compute", verdicts.SUPPORTED),
        ("compute", "storage_io", verdicts.CONTRADICTED),
        ("compute", "compute", verdicts.CONTRADICTED),  # alike is not more
    ],
)
def test_the_better_line_decides(to, rather_than, verdict):
    outcome = judged(to, rather_than)
    assert outcome["verdict"] == verdict
    # (8 · 1 + 4 · 2 + 2 · 4)² of 84 · 21
    assert "R² 0.327 over compute" in outcome["evidence"]


def test_times_of_frames_of_another_size_are_not_compared():
    assert judged("storage_io", "compute", same_size=False)["verdict"] == verdicts.NOT_COMPARABLE


def test_a_missing_column_is_named():
    outcome = judged("storage_io", "bytes")
    assert outcome["verdict"] == verdicts.TOO_SMALL and "no bytes in levels" in outcome["reason"]


def test_a_line_through_the_origin_explains_what_is_on_it():
    x = np.array([1.0, 2.0, 3.0])
    assert explained(5 * x, x) == pytest.approx(1)
    # One with an offset is none through the origin: y = 1 has Σy² = 3, of which (Σx)² / Σx² is on it.
    assert explained(np.ones(3), x) == pytest.approx(36 / 14 / 3)
