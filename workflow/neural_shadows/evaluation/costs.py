"""The sizes over which costs are measured."""

# Which stages each is a size of, in the order in which one needs the files of the other.
STAGES = {
    "subdivisions": ("mesh", "rays", "labels", "evaluation"),
    "samples": ("rays", "labels", "training"),
    "width": ("training",),
    "views": ("evaluation",),
    "frame_width": ("evaluation",),
}
