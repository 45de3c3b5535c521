"""`learning_curves`: networks trained anew for each of several budgets, from several seeds."""

from typing import Annotated

from pydantic import Field, field_validator

from neural_shadows.settings.base import Model, name_in

# A power law with an offset has three unknowns, and is checked on a budget that it was not fitted
# to: with three budgets at least its form without the offset can be.
FEWEST_BUDGETS = 3


class LearningCurves(Model):
    """Each experiment trained for each number of steps, with a schedule of that length."""

    experiments: list[name_in("experiments")] = Field(min_length=1, description="their networks")
    steps: list[Annotated[int, Field(ge=1)]] = Field(description="budgets, three or more, growing")
    seeds: int = Field(ge=1, le=100, description="trainings at each: its own seed, and the next")

    @field_validator("steps")
    @classmethod
    def _check_steps(cls, steps: list[int]) -> list[int]:
        if len(steps) < FEWEST_BUDGETS:
            raise ValueError(
                f"{steps} are fewer than {FEWEST_BUDGETS} budgets; the last one checks the curve "
                "that is fitted to the others"
            )
        if steps != sorted(set(steps)):
            raise ValueError(f"{steps}: must grow from each to the next")
        return steps
