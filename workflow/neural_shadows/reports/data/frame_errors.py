"""Error colours of methods' pictures, and crops to show large."""

from collections.abc import Mapping
from typing import NamedTuple

import numpy as np
from matplotlib.colors import to_rgba
from matplotlib.patches import Patch
from numpy.lib.stride_tricks import sliding_window_view
from scipy.ndimage import maximum_filter, uniform_filter

from neural_shadows.evaluation.look import FALSE_SHADOW, LIGHT_LEAK
from neural_shadows.reports.data.method_look import REFERENCE

# Grey levels in [0, 1]: light and shadow differ by 0.75 n.l, steps of an 8-bit picture by 0.004.
VISIBLE_DIFFERENCE = 0.05
FEW = 0.0005  # of a frame's pixels: a method with fewer wrong ones weighs less
CROP_SHARES = (0.2, 0.06)  # of the frame's height and width
TINT = 0.75  # of an error's colour; the rest is the picture's
FULL = 0.5  # a soft shadow's error of so much visibility has the whole colour
SHADES = 8  # of these colours: a layer of 512 × 256 has 18 KB, with 16 it has 25


class Window(NamedTuple):
    """A part of a frame, in pixels."""

    row: int
    column: int
    height: int
    width: int

    @property
    def extent(self) -> tuple[float, float, float, float]:
        """Left, right, lower and upper edge in the frame's pixels, for `imshow`."""
        right, lower = self.column + self.width, self.row + self.height
        return self.column - 0.5, right - 0.5, lower - 0.5, self.row - 0.5

    def of(self, image: np.ndarray) -> np.ndarray:
        """This part (height, width, …) of an image."""
        return image[self.row : self.row + self.height, self.column : self.column + self.width]


def choose_crops(images: Mapping[str, np.ndarray]) -> list[Window]:
    """Choose nested windows with most of the methods' errors.

    Args:
        images: greyscale, shape (H, W), in [0, 1], of the methods and of `reference`.

    Returns:
        Windows of `CROP_SHARES` of the frame either way, with most of the methods' visible errors:
        each method's add up to 1, so that no bad network outweighs the others.
        Of equally good windows the middle one.
    """
    reference = images[REFERENCE]
    interest = np.zeros(reference.shape)
    for image in images.values():
        wrong = np.abs(image - reference) > VISIBLE_DIFFERENCE
        interest += wrong / max(wrong.sum(), FEW * wrong.size)
    windows = [Window(0, 0, *reference.shape)]
    for share in CROP_SHARES:
        height, width = (max(1, round(share * size)) for size in reference.shape)
        row, column = _best_window(windows[-1].of(interest), height, width)
        windows.append(Window(windows[-1].row + row, windows[-1].column + column, height, width))
    return windows[1:]


def _best_window(interest: np.ndarray, height: int, width: int) -> tuple[int, int]:
    inside = sliding_window_view(interest, height, axis=0).sum(axis=-1)
    inside = sliding_window_view(inside, width, axis=1).sum(axis=-1)
    best = np.argwhere(np.isclose(inside, inside.max()))  # sums of shares are not exact
    row, column = best[np.argmin(((best - best.mean(axis=0)) ** 2).sum(axis=1))]
    return int(row), int(column)


def error_layer(image: np.ndarray, reference: np.ndarray, size: int = 1) -> np.ndarray:
    """Tint visible errors of a grey image (H, W): RGBA (H, W, 4) uint8.

    Each wrong pixel is `size` pixels wide and high, for small pictures; where both kinds of error
    meet, it has the colour of the majority.
    """
    layer = np.zeros((*image.shape, 4), np.uint8)
    difference = image - reference
    wrong = np.where(np.abs(difference) > VISIBLE_DIFFERENCE, np.sign(difference), 0)
    shown, most = maximum_filter(wrong != 0, size), uniform_filter(wrong, size)
    for where, colour in ((most <= 0, FALSE_SHADOW), (most > 0, LIGHT_LEAK)):
        layer[shown & where] = np.round(255 * np.array(to_rgba(colour, TINT)))
    return layer


def graded_layer(image: np.ndarray, reference: np.ndarray) -> np.ndarray:
    """Colour errors of a soft shadow (H, W): RGBA (H, W, 4) uint8.

    Opacity grows with the error, from none to all at `FULL`.
    """
    difference = image - reference
    share = np.round(SHADES * np.clip(np.abs(difference) / FULL, 0, 1)) / SHADES
    layer = np.zeros((*image.shape, 4), np.uint8)
    for where, colour in ((difference < 0, FALSE_SHADOW), (difference > 0, LIGHT_LEAK)):
        layer[where & (share > 0)] = np.round(255 * np.array(to_rgba(colour)))
    layer[..., 3] = np.round(255 * share)
    return layer


def with_errors(image: np.ndarray, reference: np.ndarray, size: int = 1) -> np.ndarray:
    """A grey image (H, W) in [0, 1] under its `error_layer`, in colours (H, W, 3)."""
    layer = error_layer(image, reference, size) / 255
    colour, opacity = layer[..., :3], layer[..., 3:]
    return (1 - opacity) * image[..., None] + opacity * colour


def error_legend() -> list[Patch]:
    """Legend of the colours of `with_errors`."""
    names = {"false shadow": FALSE_SHADOW, "light leak": LIGHT_LEAK}
    return [Patch(color=colour, label=name) for name, colour in names.items()]
