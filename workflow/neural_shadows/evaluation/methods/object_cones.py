"""Cone tracing of a light through each object's distance field.

The fields are those of `object_fields`; open objects take a few rays. A cone may be split.
"""

from functools import partial
from typing import TYPE_CHECKING

import numpy as np

from neural_shadows.evaluation.look import GREY, Look
from neural_shadows.evaluation.method import Method

if TYPE_CHECKING:
    from neural_shadows.frames.soft_frame import SoftFrame

LOOK = Look(
    "cones through distance fields",
    GREY,
    "h",
    "⬢",
    "One march from a point to the light, with the nearest distance to each object's surface.",
)

_OPEN_RAYS = 8  # of a pixel, for open objects


def cone_traced(frame: "SoftFrame", radius: float, *, walks: int, push: float) -> np.ndarray:
    """Visibility of a light at each point, (n,) float32. On one thread.

    Objects are assumed to occlude independently.

    Args:
        radius: of the light, in the scene's unit; to a point one ray goes.
        walks: cones in a split of a partly occluded one; 1 without splits.
        push: see `dim_by_field`.
    """
    from neural_shadows.evaluation.method_parts.scene_fields import field_traced, fields_of
    from neural_shadows.frames.ray_tracing import ray_traced
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
        sphere = field.centre.astype(np.float32), np.float32(field.radius)
        around = *sphere, field.cone_field
        dim_by_field(frame.starts, normals, to_light, size, *around, discs, push, visible)
    return visible


def _bytes(frame: "SoftFrame") -> int:
    """Bytes of all fields and the distances around their surfaces."""
    from neural_shadows.evaluation.method_parts.scene_fields import fields_of

    fields = fields_of(frame.scene).fields
    return sum(field.bytes + field.cone_field.around.nbytes for field in fields)


METHODS = {
    f"cone_{walks}": Method(
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
