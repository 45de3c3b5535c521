"""Uses of frames: the first word of a part's name."""

SEQUENCES = ("camera", "light", "both", "object")  # what moves from each frame to the next
USES = ("train", "validation", "test", *SEQUENCES)  # their order is part of the random streams
