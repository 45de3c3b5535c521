"""The dead-zone loss [3.5]."""

from torch import Tensor


def dead_zone_loss(t: Tensor, t_lb: Tensor, t_ub: Tensor) -> Tensor:
    """L(t) = max(t_lb − t, 0) + max(t − t_ub, 0) of each sample, (n,).

    Zero between the first and the second hit, the distance to the nearer bound outside;
    t_ub may be ∞.
    """
    return (t_lb - t).relu() + (t - t_ub).relu()
