"""A pixel's whole light by one walk through the field of each object, which may be split.

The fields are those of `object_fields`. What is open has no inside, and takes a few rays.
"""

from functools import partial
from typing import TYPE_CHECKING

import numpy as np

from neural_shadows.evaluation.look import GREY, Look
from neural_shadows.evaluation.soft_method import SoftMethod

if TYPE_CHECKING:
    from neural_shadows.frames.soft_frame import SoftFrame

LOOK = Look(
    "cones through occupancy fields",
    GREY,
    "h",
    "⬢",
    "Walks once from a point to the light, and keeps how near it comes to each object's surface.",
)

_OPEN_RAYS = 8  # of a pixel, to what is open


def cone_traced(frame: "SoftFrame", radius: float, *, walks: int, push: float) -> np.ndarray:
    """How much of a light of a radius each point sees, (n,) float32, on one thread.

    Objects are taken to hide it independently of each other.

    Args:
        radius: of the light, in the scene's unit; to a point one ray goes.
        walks: into how many a walk is split that is neither free nor dark; 1 for never.
        push: see `dim_by_field`.
    """
    from neural_shadows.evaluation.method_parts.ray_tracing import ray_traced
    from neural_shadows.evaluation.method_parts.scene_fields import field_traced, fields_of
    from neural_shadows.representations.distance_bricks.field_cones import (
        above_plane,
        dim_by_field,
        split_disc,
    )

    if radius == 0:
        return field_traced(frame, radius, samples=1, cells=1.0)
    fields, normals = fields_of(frame.scene), frame.surface.n_g
    to_light, size = frame.centre.astype(np.float32) - frame.starts, np.float32(radius)
    if fields.tracer is None:
        visible = above_plane(normals, to_light, size)
    else:
        visible = ray_traced(frame, radius, samples=_OPEN_RAYS, blocked=fields.tracer.blocked)
    discs, push = split_disc(walks), np.float32(push)
    for field in fields.fields:
        around = field.centre, field.radius, field.cone_field
        dim_by_field(frame.starts, normals, to_light, size, *around, discs, push, visible)
    return visible


def _bytes(frame: "SoftFrame") -> int:
    """In memory of all fields of a frame's scene and the distances around their surfaces."""
    from neural_shadows.evaluation.method_parts.scene_fields import fields_of

    fields = fields_of(frame.scene).fields
    return sum(field.bytes + field.cone_field.around.nbytes for field in fields)


METHODS = {
    f"cone_{walks}": SoftMethod(
        partial(cone_traced, walks=walks),
        {"push": (0.0, 0.15, 0.3, 0.6, 1.2, 2.4)},
        "One walk, fields" if walks == 1 else f"One walk split in {walks}, fields",
        tuned_as=None if walks == 1 else "cone_1",  # the push does not depend on the walks
        fields=True,
        held=_bytes,
        texel_floats=0,
        by_rays=True,
    )
    for walks in (1, 4, 8)
}
