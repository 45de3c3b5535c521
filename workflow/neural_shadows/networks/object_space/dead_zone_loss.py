"""The dead-zone loss [3.5], and two changes to it that the thesis proposes [5.1, 5.4.1]."""

from dataclasses import dataclass

from torch import Tensor


@dataclass(frozen=True)
class DeadZone:
    """a max(t_lb − t, 0) + b max(t − t_ub, 0) + c |t − (t_lb + t_ub)/2| of each sample.

    The thesis's loss is a = b = 1, c = 0: zero between the first and the second hit, the distance
    to the nearer bound outside. The pull c counts between the bounds only, and only
    where both are finite.
    """

    false_shadow: float = 1.0  # a, of depths before the first hit
    light_leak: float = 1.0  # b, of depths behind the second
    middle_pull: float = 0.0  # c

    def __call__(self, t: Tensor, t_lb: Tensor, t_ub: Tensor) -> Tensor:
        """Loss of each sample (n,); t_ub may be ∞."""
        loss = self.false_shadow * (t_lb - t).relu() + self.light_leak * (t - t_ub).relu()
        if self.middle_pull:
            half = (t_ub - t_lb) / 2
            inside = (t > t_lb) & (t < t_ub) & half.isfinite()
            middle = (t - t_lb - half.where(inside, t - t_lb)).abs()
            loss = loss + self.middle_pull * middle
        return loss
