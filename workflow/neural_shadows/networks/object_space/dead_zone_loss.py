"""Dead-zone loss [3.5], and a weight on false shadow [5.1]."""

from dataclasses import dataclass

from torch import Tensor


@dataclass(frozen=True)
class DeadZone:
    """a max(t_lb − t, 0) + max(t − t_ub, 0) of each sample.

    Zero between the first and the second hit, the distance to the nearer bound outside; the
    thesis's loss is a = 1.
    """

    false_shadow: float = 1.0  # a, of depths before the first hit

    def __call__(self, t: Tensor, t_lb: Tensor, t_ub: Tensor) -> Tensor:
        """Loss of each sample (n,); t_ub may be ∞."""
        return self.false_shadow * (t_lb - t).relu() + (t - t_ub).relu()
