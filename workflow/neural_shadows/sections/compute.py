"""`compute`: device, threads and number format of networks."""

from typing import Literal

from pydantic import Field

from neural_shadows.settings.base import Model


class Compute(Model):
    """Device, threads and number format of networks."""

    device: Literal["auto", "cpu", "cuda"] = Field("auto", description="`auto`: a GPU if available")
    # Two trainings side by side learn from 1.07 (kernel prediction), 1.11 (Neural Shadow Mapping) and
    # 1.4 times (the thesis's network, batches of 1,024) the samples a second of one on two threads.
    threads: int = Field(
        1,
        ge=1,
        le=1024,
        description="CPU threads of a sampling or training job; trainings use idle cores of the run as well",
    )
    timing_cores: int = Field(
        2,
        ge=1,
        le=1024,
        description="cores that a job of times keeps to itself: methods and hours of sun on one thread, networks by level on one and on all",
    )
    precision: Literal["auto", "float32", "bfloat16", "float16"] = Field(
        "auto",
        description="number format of matrix products; `auto`: bfloat16 where the processor supports it, else float32",
    )
