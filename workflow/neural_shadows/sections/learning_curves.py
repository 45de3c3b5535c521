"""`learning_curves`: trainings at several budgets, from several seeds."""

from collections.abc import Mapping
from typing import Annotated

from pydantic import Field, model_validator

from neural_shadows.settings.base import Model, name_in

# A power law without offset has two unknowns; the third budget checks the fit.
FEWEST_BUDGETS = 3
Number = Annotated[int, Field(ge=1)]


class LearningCurve(Model):
    """Trainings per experiment and budget, with schedules of that length."""

    experiments: list[name_in("experiments")] = Field(
        min_length=1, description="experiments on rays, or on rendered frames"
    )
    frames: list[Number] | None = Field(
        None,
        description="budgets of experiments on frames, three or more, ascending: training frames of each "
        "scene, the first files of its `shard` frames each",
    )
    steps: list[Number] = Field(
        min_length=1,
        description="optimiser steps, ascending: of experiments on rays the budgets, three or more; on "
        "frames each has a curve",
    )
    seeds: int = Field(ge=1, le=100, description="trainings per budget, with successive seeds")

    @model_validator(mode="after")
    def _check(self):
        key = "steps" if self.frames is None else "frames"
        budgets = getattr(self, key)
        if len(budgets) < FEWEST_BUDGETS:
            raise ValueError(
                f"{key}: {budgets} are fewer than {FEWEST_BUDGETS} budgets. Add some: the last one checks "
                "the curve fitted to the others"
            )
        for key, numbers in (("frames", self.frames or []), ("steps", self.steps)):
            if numbers != sorted(set(numbers)):
                raise ValueError(f"{key}: {numbers}: must be ascending, without repetition")
        return self


def check_curves(curves: Mapping[str, LearningCurve], key: str) -> None:
    """Check that there are learning curves for a table of them."""
    if not curves:
        raise ValueError(f"{key} needs the section `learning_curves`")
