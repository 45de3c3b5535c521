"""A pixel's whole light by one walk through the field of each object, which may be split.

The fields are those of `object_fields`. What is open has no inside, and a few rays ask about it.
"""

from functools import partial

import numpy as np

from neural_shadows.evaluation.soft_method_names import CONE_WALKS
from neural_shadows.evaluation.soft_methods.object_fields import field_traced, fields_of
from neural_shadows.evaluation.soft_methods.ray_traced import ray_traced
from neural_shadows.evaluation.soft_methods.soft_method import SoftMethod
from neural_shadows.frames.soft_frame import SoftFrame
from neural_shadows.networks.object_space.field_cones import above_plane, dim_by_field, split_disc

_OPEN_RAYS = 8  # of a pixel, to what is open


def cone_traced(frame: SoftFrame, radius: float, *, walks: int, push: float) -> np.ndarray:
    """How much of a light of a radius each point sees, (n,) float32, on one thread.

    Objects are taken to hide it independently of each other.

    Args:
        radius: of the light, in the scene's unit; to a point one ray goes.
        walks: into how many a walk is split that is neither free nor dark; 1 for never.
        push: see `dim_by_field`.
    """
    if radius == 0:
        return field_traced(frame, radius, samples=1, cells=1.0)
    fields, normals = fields_of(frame.scene), frame.surface.n_g
    ways, size = frame.centre.astype(np.float32) - frame.starts, np.float32(radius)
    if fields.tracer is None:
        visible = above_plane(normals, ways, size)
    else:
        visible = ray_traced(frame, radius, samples=_OPEN_RAYS, blocked=fields.tracer.blocked)
    for one in fields.fields:
        around = one.centre, one.radius, one.cone_field
        told = split_disc(walks), np.float32(push)
        dim_by_field(frame.starts, normals, ways, size, *around, *told, visible)
    return visible


def cone_bytes(frame: SoftFrame) -> int:
    """In memory of all fields of a frame's scene and the distances around their surfaces."""
    fields = fields_of(frame.scene).fields
    return sum(field.bytes + field.cone_field.around.nbytes for field in fields)


def _by_cones(walks: int) -> SoftMethod:
    answer, tried = partial(cone_traced, walks=walks), {"push": (0.0, 0.15, 0.3, 0.6, 1.2, 2.4)}
    return SoftMethod(answer, tried, held=cone_bytes, texel_floats=0, by_rays=True)


METHODS = {f"cone_{walks}": _by_cones(walks) for walks in CONE_WALKS}
