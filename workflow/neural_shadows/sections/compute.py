"""`compute`: device, threads and number format of networks."""

from typing import Literal

from pydantic import Field

from neural_shadows.settings.base import Model


class Compute(Model):
    """Device, threads and number format of networks."""

    device: Literal["auto", "cpu", "cuda"] = Field("auto", description="`auto`: a GPU if available")
    threads: int = Field(2, ge=1, le=1024, description="CPU threads of a sampling or training job")
    precision: Literal["auto", "float32", "bfloat16", "float16"] = Field(
        "auto",
        description="number format of matrix products; `auto`: bfloat16 where the processor supports it, else float32",
    )
