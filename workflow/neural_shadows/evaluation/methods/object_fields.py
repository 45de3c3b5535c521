"""Rays through each object's distance field instead of triangles.

A field is a sparse grid of signed distances, fitted to the object's convex edges and not trained,
around each closed object of a scene; open objects are traced as triangles.
"""

from functools import partial

from neural_shadows.evaluation.look import BLACK, Look
from neural_shadows.evaluation.method import Method, rays_label

LOOK = Look(
    "rays through distance fields",
    BLACK,
    "p",
    "⬟",
    "Rays through a sparse grid of signed distances of each object.",
    joined=True,
)


def _visibility(*of_frame, samples: int, cells: float):
    from neural_shadows.evaluation.method_parts.scene_fields import field_traced

    return field_traced(*of_frame, samples=samples, cells=cells)


def _bytes(frame) -> int:
    """Bytes of all fields of a frame's scene; open objects count nothing."""
    from neural_shadows.evaluation.method_parts.scene_fields import fields_of

    return sum(field.bytes for field in fields_of(frame.scene).fields)


METHODS = {
    f"field_{count}": Method(
        partial(_visibility, samples=count),
        {"cells": (0.12, 0.25, 0.5, 1.0, 2.0, 4.0)},
        f"{rays_label(count)}, fields",
        # The offset of rays' starts does not depend on their number; tuning by five took 98 s of a core.
        tuned_as=None if count == 1 else "field_1",
        fields=True,
        held=_bytes,
        texel_floats=0,
        by_rays=True,
    )
    for count in (1, 4, 16)
}
