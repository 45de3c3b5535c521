"""The share of wrong pixels, and which way they are wrong."""

from typing import TYPE_CHECKING, NamedTuple

import numpy as np

if TYPE_CHECKING:
    import torch

    Features = list[torch.Tensor]


class ShadowError(NamedTuple):
    """Shares, in [0, 1], of the object and receiver pixels whose visibility is wrong."""

    false_shadow: float
    """Dark where the reference is lit."""
    light_leak: float
    """Lit where the reference is dark."""
    total: float


def shadow_error(
    lit: np.ndarray, reference_lit: np.ndarray, shaded_mask: np.ndarray
) -> ShadowError:
    """Share of wrong visibility among the pixels that show object or receiver.

    `lit`, `reference_lit` and `shaded_mask` are bool arrays of one shape (H, W); the
    mask is true where object or receiver is seen.

    Raises:
        ValueError: the mask is empty.
    """
    shaded = np.count_nonzero(shaded_mask)
    if shaded == 0:
        raise ValueError("shadow_error: no pixel shows object or receiver")
    wrong = shaded_mask & (lit != reference_lit)
    total = np.count_nonzero(wrong)
    false_shadow = np.count_nonzero(wrong & reference_lit)
    return ShadowError(false_shadow / shaded, (total - false_shadow) / shaded, total / shaded)
