"""Loss on training rays. Trainings write it: loss.csv."""

from neural_shadows.metrics.metric import Metric

METRICS = {"loss": Metric("loss", lights=())}
