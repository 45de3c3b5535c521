"""`compute`: what the networks run on."""

from typing import Literal

from pydantic import Field

from neural_shadows.settings.base import Model


class Compute(Model):
    """What the networks run on."""

    device: Literal["auto", "cpu", "cuda"] = Field(
        "auto", description="`auto`: a GPU if there is one"
    )
    threads: int = Field(2, ge=1, le=1024, description="CPU threads of a sampling or training job")
    precision: Literal["auto", "float32", "bfloat16", "float16"] = Field(
        "auto",
        description="of matrix products, one that the processor has; `auto`: bfloat16, or float32",
    )
