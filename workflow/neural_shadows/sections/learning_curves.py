"""`learning_curves`: trainings at several budgets, from several seeds."""

from typing import Annotated

from pydantic import Field, field_validator

from neural_shadows.sections.experiments import RayExperimentName
from neural_shadows.settings.base import Model

# A power law without offset has two unknowns; the third budget checks the fit.
FEWEST_BUDGETS = 3


class LearningCurves(Model):
    """Trainings per experiment and budget, with schedules of that length."""

    experiments: list[RayExperimentName] = Field(min_length=1, description="experiments on rays")
    steps: list[Annotated[int, Field(ge=1)]] = Field(
        description="budgets in optimiser steps: three or more, ascending"
    )
    seeds: int = Field(ge=1, le=100, description="trainings per budget, with successive seeds")

    @field_validator("steps")
    @classmethod
    def _check_steps(cls, steps: list[int]) -> list[int]:
        if len(steps) < FEWEST_BUDGETS:
            raise ValueError(
                f"{steps} are fewer than {FEWEST_BUDGETS} budgets. Add some: the last one checks the curve "
                "fitted to the others"
            )
        if steps != sorted(set(steps)):
            raise ValueError(f"{steps}: must be ascending, without repetition")
        return steps
