"""Errors over a sequence's frames after the first: `evaluation.flicker` measures them.

Of what is shown: a method, and it with temporal anti-aliasing. Errors of changes are of a point's visibility from
frame to frame: neither blur nor lag lowers them.
"""

from neural_shadows.metrics.metric import Metric

SHOWN = {"": "", "_taa": "with TAA", "_recursive": "with recursive TAA"}
_ERRORS = {
    "mse_sequence": "in sequences",
    "mse_sequence_off_edges": "in sequences, off edges",
    "mse_change": "of changes",
}
METRICS = {
    f"{error}{ending}": Metric(
        "MSE",
        ", ".join(filter(None, (of, shown))),
        unit="× 10⁻⁴",
        factor=1e4,
        digits=1,
        lights=(),
    )
    for error, of in _ERRORS.items()
    for ending, shown in SHOWN.items()
}
