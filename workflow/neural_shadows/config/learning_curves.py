"""`learning_curves`: networks trained anew for each of several budgets, from several seeds."""

from typing import TYPE_CHECKING, Annotated, Any

from pydantic import Field, field_validator

from neural_shadows.config.base import Model, name_in
from neural_shadows.config.experiments import seed_of, training_of

if TYPE_CHECKING:
    from neural_shadows.config.whole import Config

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


def points_of(config: "Config", name: str) -> list[dict[str, Any]]:
    """The points of an experiment's learning curve, by steps and then by seed.

    Returns: of each `experiment`, the name of the network that is trained for it; `steps`; `seed`;
        `samples`, steps × batch. The experiment itself is the point of its own steps and seed.
    """
    curves, training, own_seed = (
        config.learning_curves,
        training_of(config, name),
        seed_of(config, name),
    )
    points = []
    for steps in curves.steps:
        for seed in range(own_seed, own_seed + curves.seeds):
            own = (steps, seed) == (training.steps, own_seed)
            points.append(
                {
                    "experiment": name if own else f"{name}_{steps}_steps_seed_{seed}",
                    "steps": steps,
                    "seed": seed,
                    "samples": steps * training.batch_size,
                }
            )
    return points


def check(config: "Config") -> None:
    """Check that each network of a learning curve is trained, and there once."""
    names = config.learning_curves.experiments if config.learning_curves else []
    for name in names:
        if training_of(config, name) is None:
            raise ValueError(f"learning_curves.experiments: {name!r} is not trained; leave it out")
        if names.count(name) > 1:
            raise ValueError(f"learning_curves.experiments: {name!r} is there twice")
