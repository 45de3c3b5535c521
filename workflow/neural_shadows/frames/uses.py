"""Uses of frames: the first word of a part's name."""

SEQUENCES = ("camera", "light", "both", "object")  # what moves from each frame to the next
USES = ("train", "validation", "test", *SEQUENCES)  # their order is part of the random streams

# Frames of the first view at rest before a sequence begins, for methods with a history. Histories grow for
# 8 frames and more: without any E of five frames was 1.7 to 3 times that of later ones (FFX-like filter).
RUN_IN = 16
