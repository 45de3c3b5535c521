"""Error colours of methods' pictures, and crops to show large."""

from collections.abc import Iterable, Mapping
from typing import NamedTuple

import numpy as np
from matplotlib.colors import to_rgb, to_rgba
from matplotlib.patches import Patch
from numpy.lib.stride_tricks import sliding_window_view
from scipy.ndimage import maximum_filter, uniform_filter

from neural_shadows.evaluation.look import FALSE_SHADOW, LIGHT_LEAK
from neural_shadows.reports.data.method_look import REFERENCE

# Grey levels in [0, 1]: light and shadow differ by 0.75 n.l, steps of an 8-bit picture by 0.004.
VISIBLE_DIFFERENCE = 0.05
FEW = 0.0005  # of a frame's pixels: a method with fewer wrong ones weighs less
CROP_SHARES = (0.2, 0.06)  # of the frame's height and width
APART = 3  # windows from one box's corner to the other's, down or across
TINT = 0.75  # of an error's colour; the rest is the picture's
FULL = 0.5  # a soft shadow's error of so much visibility has the whole colour


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


def choose_boxes(
    errors: Iterable[np.ndarray], counted: np.ndarray, height: int, width: int
) -> list[Window]:
    """Choose two windows with most of the methods' squared errors.

    Each method's add up to 1, so that no bad one outweighs the others. The windows do not overlap, and in
    a frame that has room they lie `APART`: neighbours show the same shadow twice.

    Args:
        errors: (lights, H, W) of each method. counted: (H, W) bool, pixels whose errors count.
        height, width: of a window, at most a third of the frame's: then a second one has room.
    """
    interest = np.zeros(counted.shape)
    for error in errors:
        square = np.where(counted, np.square(error, dtype=np.float64).sum(axis=0), 0)
        interest += square / (square.sum() or 1)
    row, column = _best_window(interest, height, width)
    high, wide = counted.shape
    apart = APART if high >= (2 * APART + 1) * height or wide >= (2 * APART + 1) * width else 1
    rows, columns = (
        slice(max(0, corner - apart * size + 1), corner + apart * size)
        for corner, size in ((row, height), (column, width))
    )
    other = _best_window(interest, height, width, besides=(rows, columns))
    return [Window(*corner, height, width) for corner in ((row, column), other)]


def _best_window(
    interest: np.ndarray, height: int, width: int, besides: tuple[slice, slice] | None = None
) -> tuple[int, int]:
    """Upper left corner of the window with most interest; none of the corners `besides`."""
    inside = sliding_window_view(interest, height, axis=0).sum(axis=-1)
    inside = sliding_window_view(inside, width, axis=1).sum(axis=-1)
    if besides is not None:
        inside[besides] = -1
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


def coloured(error: np.ndarray) -> np.ndarray:
    """Colours (…, 3) of a soft shadow's errors: orange below 0, blue above, white at 0."""
    share = np.clip(np.abs(error) / FULL, 0, 1)[..., None]
    colour = np.where(error[..., None] < 0, to_rgb(FALSE_SHADOW), to_rgb(LIGHT_LEAK))
    return 1 - share * (1 - colour)


def with_errors(image: np.ndarray, reference: np.ndarray, size: int = 1) -> np.ndarray:
    """A grey image (H, W) in [0, 1] under its `error_layer`, in colours (H, W, 3)."""
    layer = error_layer(image, reference, size) / 255
    colour, opacity = layer[..., :3], layer[..., 3:]
    return (1 - opacity) * image[..., None] + opacity * colour


def error_legend() -> list[Patch]:
    """Legend of the colours of `with_errors`."""
    names = {"false shadow": FALSE_SHADOW, "light leak": LIGHT_LEAK}
    return [Patch(color=colour, label=name) for name, colour in names.items()]
