"""`experiments`: networks on rays of a scene, or on frames; one training each."""

from typing import Annotated, Literal

from pydantic import Discriminator, Field, Tag

from neural_shadows.networks.settings.networks import RayNetwork, ScreenNetwork
from neural_shadows.sections.frame_sets import FrameSetName
from neural_shadows.sections.networks import RayNetworkName, ScreenNetworkName
from neural_shadows.sections.scenes import MeshName
from neural_shadows.sections.trainings import RayTrainingName, ScreenTrainingName
from neural_shadows.settings.base import (
    EntryKind,
    Model,
    Seed,
    Text,
    has_key,
    name_in,
    text_or,
)
from neural_shadows.training.settings.frames import ScreenTraining
from neural_shadows.training.settings.rays import RayTraining


class RayExperiment(Model):
    """A network on rays: scene, training rays, architecture, training, seed."""

    scene: MeshName = Field(description="a mesh in `scenes`")
    sampling: name_in("samplings") | None = Field(
        None, description="a name in `samplings`; omitted for a network without training"
    )
    network: text_or(RayNetworkName, RayNetwork) = Field(
        description="name in `networks`, or section"
    )
    training: text_or(RayTrainingName, RayTraining) | None = Field(
        None,
        description="a name in `trainings`, or a section; omitted for a network without training",
    )
    seed: Seed | None = Field(None, description="seed of the training; default: the scene's")
    bias: text_or(Literal["held_out"], Annotated[float, Field(ge=0, le=1)]) = Field(
        0.0,
        description="depth bias added to t_pred, in sphere radii; `held_out`: the best on held-out views",
    )
    label: Text | None = Field(
        None,
        description="label in tables; may contain settings in braces, such as `{resolution}³ field`",
    )


class ShippedWeights(Model):
    """A file of weights that `ship_weights` has written, and its checksum."""

    path: str = Field(
        min_length=1,
        description="a file, in the working directory or else in the checkout, or its URL",
    )
    sha256: str = Field(pattern=r"^[0-9a-f]{64}$", description="SHA-256 of the file, hexadecimal")


class ScreenExperiment(Model):
    """A screen-space network: frames, architecture, training, seed."""

    network: text_or(ScreenNetworkName, ScreenNetwork) = Field(
        description="a name in `networks`, or a section"
    )
    training: text_or(ScreenTrainingName, ScreenTraining) = Field(
        description="a name in `trainings`, or a section"
    )
    frame_set: FrameSetName = Field(description="a name in `frame_sets`")
    scenes: list[str] = Field(min_length=1, description="training scenes of the frame set")
    lights: list[Annotated[int, Field(ge=0)]] | None = Field(
        None,
        min_length=1,
        description="indices, from 0, of the frame set's radii for training; default: all",
    )
    seed: Seed | None = Field(None, description="seed of the training; default: the global seed")
    weights: ShippedWeights | None = Field(
        None, description="take these weights and train nothing; null in an overlay: train"
    )
    label: Text | None = Field(None, description="label in tables")


FRAMES = EntryKind(
    "an experiment on frames (with `frame_set`)",
    lambda entry: has_key(entry, "frame_set") or has_key(entry, "scenes"),
)
RAYS = EntryKind("an experiment on rays (with `scene`)", lambda entry: not FRAMES.holds(entry))
RayExperimentName, ScreenExperimentName = (name_in("experiments", kind) for kind in (RAYS, FRAMES))

Experiment = Annotated[
    Annotated[RayExperiment, Tag("Rays")] | Annotated[ScreenExperiment, Tag("Frames")],
    Discriminator(lambda value: "Frames" if FRAMES.holds(value) else "Rays"),
]
