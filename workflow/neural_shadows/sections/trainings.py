"""`trainings`: on rays by `batch_size`, on frames by `crops`."""

from typing import Annotated

from pydantic import Discriminator, Tag

from neural_shadows.settings.base import EntryKind, has_key, name_in
from neural_shadows.training.settings.frames import ScreenTraining
from neural_shadows.training.settings.rays import RayTraining

FRAMES = EntryKind(
    "a training on frames (with `crops`)",
    lambda entry: has_key(entry, "crops") or has_key(entry, "crop"),
)
RAYS = EntryKind("a training on rays (with `batch_size`)", lambda entry: not FRAMES.holds(entry))
RayTrainingName, ScreenTrainingName = name_in("trainings", RAYS), name_in("trainings", FRAMES)

Training = Annotated[
    Annotated[RayTraining, Tag("Rays")] | Annotated[ScreenTraining, Tag("Frames")],
    Discriminator(lambda value: "Frames" if FRAMES.holds(value) else "Rays"),
]
