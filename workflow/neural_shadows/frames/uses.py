"""Uses of frames: a part's name without its number."""

SEQUENCES = ("camera", "light", "both", "object")  # what moves from each frame to the next
# Constants of methods with a history are chosen on them.
TUNED_SEQUENCES = ("validation_both", "validation_camera", "validation_light", "validation_object")
# Their order is part of the random streams: new ones go last.
USES = ("train", "validation", "test", *SEQUENCES, *TUNED_SEQUENCES)
# Frames of the first view at rest before a sequence begins, for methods with a history. Histories grow for
# 8 frames and more: without any E of five frames was 2 to 3 times that of later ones (FFX-like filter).
RUN_IN = 16


def motion_of(use: str) -> str | None:
    """What moves in a sequence; None for the other uses."""
    motion = use.removeprefix("validation_")
    return motion if motion in SEQUENCES else None


def use_of(part: str) -> str:
    """Use of a part by its name: `validation_both` of `validation_both_000`."""
    return part.rpartition("_")[0]
