"""`experiments`: the networks that are trained."""

from pydantic import Field

from neural_shadows.config.base import Model, Name


class Experiment(Model):
    """One trained network: scene + sampling + network + training, by name."""

    scene: Name = Field(description="a name in `scenes`")
    sampling: Name = Field(description="a name in `samplings`")
    network: Name = Field(description="a name in `networks`")
    training: Name = Field(description="a name in `trainings`")
    seed: int | None = Field(
        None, ge=0, lt=2**32, description="seed of this training; without it the scene's"
    )
