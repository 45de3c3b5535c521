"""Moments of depth over windows as wide as the penumbra of their blockers.

Variance soft shadow mapping (Yang et al. 2010, without its division of windows in which a receiver is
not flat), and with four moments (Peters et al. 2017). As PCSS, but the blockers' mean depth and the
shadow are both computed from mean moments of a window, so that any width costs the same. Constants are those
of PCSS and of moments; a point light has the four texels round each receiver.
"""

from functools import partial
from typing import TYPE_CHECKING

import numpy as np

from neural_shadows.evaluation.look import YELLOW, Look
from neural_shadows.evaluation.method import Method
from neural_shadows.evaluation.methods import moments as fixed
from neural_shadows.evaluation.methods import pcss

if TYPE_CHECKING:
    from neural_shadows.frames.soft_frame import SoftFrame

LOOK = Look(
    "moments over a searched width (VSSM, MSSM)",
    YELLOW,
    "v",
    "▽",
    "Searches for blockers, and filters, by mean powers of depth over windows of any width.",
)


def _visibility(
    frame: "SoftFrame",
    radius: float,
    *,
    kind: str,
    bias: float,
    scale: float,
    nearest: float,
    bleeding: float,
) -> np.ndarray:
    from neural_shadows.shadow_maps import moments
    from neural_shadows.shadow_maps.light_filters import receiver_bias
    from neural_shadows.shadow_maps.light_map import distances_of
    from neural_shadows.shadow_maps.summed_moments import summed_views

    count, blockers_of, bound = {
        "vssm": (2, moments.variance_blockers, moments.variance_visibility),
        "mssm": (4, moments.hamburger_blockers, moments.hamburger_visibility),
    }[kind]
    light_map, distances = frame.light_map, distances_of(frame.from_light)
    near = light_map.near
    farthest = float(distances.max(initial=2 * frame.scene.size))
    radius = scale * radius
    first = near + nearest * np.maximum(distances - near, 0)
    widest = radius * (1 / first - 1 / distances)
    shares = np.ones(len(distances), np.float32)
    views = summed_views(
        light_map,
        frame.depths,
        frame.from_light,
        of=partial(moments.powers, count=count),
        far=farthest,
        widest=widest,
    )
    span = farthest - near
    for view in views:
        mine = view.receivers
        distance = distances[mine]
        of_mine = frame.from_light[mine], frame.cosines[mine]
        slanted = partial(receiver_bias, light_map, *of_mine, frame.scene.size)
        sides = view.sides(widest[mine])
        if radius:
            nearer = distance - near - bias * slanted(_reach(sides))
            blockers = blockers_of(view.means(sides), np.maximum(nearer, 0) / span)
            blocker = np.clip(near + span * blockers, first[mine], distance)
            sides = view.sides(radius * (1 / blocker - 1 / distance))
        nearer = distance - near - bias * slanted(_reach(sides))
        shares[mine] = bound(view.means(sides), np.maximum(nearer, 0) / span)
    return np.maximum((shares - bleeding) / (1 - bleeding), 0).astype(np.float32)


def _reach(sides: np.ndarray) -> np.ndarray:
    """Texels before a slanted receiver, (m,), by the standard deviation of windows of sides (m, 2)."""
    return 0.75 + np.sqrt(np.square(sides).sum(axis=1) / 24)


def _method(kind: str, floats: int) -> Method:
    constants = pcss._CONSTANTS | fixed.CONSTANTS
    return Method(
        partial(_visibility, kind=kind), constants, kind.upper(), texel_floats=2 * floats
    )  # sums of 64 bits


METHODS = {"vssm": _method("vssm", 2), "mssm": _method("mssm", 4)}
