"""Moments of depth over windows as wide as the penumbra of their blockers.

Moment soft shadow mapping (Peters et al. 2017): as PCSS, but the blockers' mean depth and the shadow are
both computed from a window's mean moments, so that any width costs the same. Constants are those of PCSS, of
moments, and `least`, a share of blockers below which their mean depth is not trusted; `scale` is the filter's
alone. A point light has the four texels round each receiver. With two moments (VSSM, Yang et al. 2010)
windows in which a receiver is not flat need a division; without it the error under the largest light of
`windows` was 5.7 times that of four moments.
"""

from collections.abc import Callable
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
    "moments over a searched width (MSSM)",
    YELLOW,
    "v",
    "▽",
    "Searches for blockers, and filters, by mean powers of depth over windows of any width.",
)


def _visibility(
    frame: "SoftFrame",
    radius: float,
    *,
    bias: float,
    scale: float,
    nearest: float,
    least: float,
) -> np.ndarray:
    from neural_shadows.rendering.lengths import lengths_of
    from neural_shadows.shadow_maps import moments
    from neural_shadows.shadow_maps.light_filters import receiver_bias
    from neural_shadows.shadow_maps.summed_moments import summed_views

    light_map, distances = frame.light_map, lengths_of(frame.from_light)
    near = light_map.near
    farthest = float(distances.max(initial=2 * frame.scene.size))
    first = near + nearest * np.maximum(distances - near, 0)
    widest = radius * (1 / first - 1 / distances)
    shares = np.ones(len(distances), np.float32)
    views = summed_views(
        light_map,
        frame.depths,
        frame.from_light,
        of=partial(moments.powers, count=4),
        far=farthest,
        widest=widest,
    )
    span = farthest - near
    for view in views:
        mine = view.receivers
        distance = distances[mine]
        of_mine = frame.from_light[mine], frame.cosines[mine]
        slanted = partial(receiver_bias, light_map, *of_mine, frame.scene.size)
        depths = partial(_depths, (distance - near) / span, slanted, bias / span)
        sides = view.sides(widest[mine])
        if radius:
            blockers = moments.hamburger_blockers(view.means(sides), depths(sides), least)
            blocker = np.clip(near + span * blockers, first[mine], distance)
            sides = view.sides(scale * radius * (1 / blocker - 1 / distance))
        shares[mine] = moments.hamburger_visibility(view.means(sides), depths(sides))
    return shares


def _depths(
    depth: np.ndarray, slanted: Callable[[np.ndarray], np.ndarray], bias: float, sides: np.ndarray
) -> np.ndarray:
    """Receivers' depths less the bias, (m,), as half of a slanted receiver's window lies before it.

    Args:
        slanted: the cone's bias by its reach in texels. sides: of windows, (m, 2), whose standard
            deviation is its reach, as that of fixed kernels.
    """
    reach = 0.75 + np.sqrt(np.square(sides).sum(axis=1) / 24)
    return np.maximum(depth - bias * slanted(reach), 0)


# At 0.0001 the error under the largest light of `windows` was 1.2 times that at 0.01.
_LEAST = {"least": (0.001, 0.003, 0.01, 0.03, 0.1, 0.3)}
# The scale is of the filter alone: when it also widened the search, errors by constants chosen one after the other
# were up to 9 % above the least (`frames`, `panels`; which lights, depended on the order), now up to 1.4 %.
_CONSTANTS = {
    **fixed.BIAS,  # a cone's, as of fixed moments
    "nearest": pcss.CONSTANTS["nearest"],
    **_LEAST,
    "scale": pcss.CONSTANTS["scale"],
    **fixed.BLEEDING,
}
METHODS = {
    "mssm": Method(
        _visibility,
        _CONSTANTS,
        "MSSM",
        rounds=2,
        texel_floats=8,  # a table's sums are float64
        last=fixed.without_leaks,
        of_last=(*fixed.BLEEDING,),
    )
}
