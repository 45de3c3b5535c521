"""Errors over a sequence's frames after the first: `evaluation.flicker` measures them.

Errors of changes are of a point's visibility from frame to frame. Where the exact shadow changes, blur and lag leave
one; where it does not, they lower it, as they lower noise.
"""

from neural_shadows.metrics.metric import Metric

# What is shown of a method: it with a history of its own, if it has one; its single frames; and these
# behind temporal anti-aliasing, in the place of such a history.
SHOWN = {
    "": "",
    "_single": "of single frames",
    "_taa": "with TAA",
    "_recursive": "with recursive TAA",
}
ERRORS = {
    "mse_sequence": "in sequences",
    "mse_sequence_off_edges": "in sequences, off edges",
    "mse_change": "of changes",
    "mse_change_off_edges": "of changes, off edges",
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
    for error, of in ERRORS.items()
    for ending, shown in SHOWN.items()
}
