"""Penumbra widths of test frames, measured and by model.

The model is Neural Shadow Mapping's (3.6).
"""

import numpy as np
from scipy.ndimage import gaussian_filter, map_coordinates, maximum_filter, minimum_filter

from neural_shadows.evaluation.measured_frames import MeasuredFrame
from neural_shadows.frames.penumbra_widths import model_widths

MIDDLE = (0.35, 0.65)  # visibilities of a penumbra's middle, where the search for its ends begins
ENDS = (0.1, 0.9)  # 0.8 of the width lies between them
FARTHEST = 256  # pixels to an end
SMOOTH = 1.5  # pixels of the slope's Gaussian
NARROWEST = 5.0  # pixels by the model: of narrower ones the pixels' own width is a part


def widths(measured: MeasuredFrame, k: int) -> np.ndarray:
    """Measured and modelled widths in a penumbra's middle, (2, n) pixels.

    Measured is the distance along the slope from visibility 10 to 90 %, times 1.25. Left out are
    penumbrae cut off by another surface or the frame's side, as where several overlap, and those
    that are narrow by the model: selection by measured width would bias the measured percentiles.
    """
    frame, target = measured.frame, measured.target[k]
    surface = frame.surface
    depth = surface.depth_image()
    same_surface = maximum_filter(depth, 5) - minimum_filter(depth, 5) < 0.03 * depth
    same_surface &= measured.valid
    middle = (target > MIDDLE[0]) & (target < MIDDLE[1]) & same_surface
    selected = np.flatnonzero(middle.ravel()[surface.pixel])
    rows_columns = np.divmod(surface.pixel[selected], surface.width)
    measured_across = measured_widths(target, same_surface, np.array(rows_columns))
    radius, focal = measured.part.radii[k], surface.camera.focal(surface.height)
    pixels = model_widths(frame.scene, surface, frame.centre, radius, focal, selected, frame.shape)
    return np.stack([measured_across, pixels])[:, (measured_across > 0) & (pixels >= NARROWEST)]


def modelled_widths(measured: MeasuredFrame, k: int) -> np.ndarray:
    """Widths above 0 by the model at all of a frame's pixels, (n,) pixels: of these the paper takes its bound."""
    frame, radius = measured.frame, measured.part.radii[k]
    focal = frame.surface.camera.focal(frame.surface.height)
    of_light = frame.centre, radius, focal
    pixels = model_widths(frame.scene, frame.surface, *of_light, shape=frame.shape)
    return pixels[pixels > 0]


def measured_widths(target: np.ndarray, near: np.ndarray, pixels: np.ndarray) -> np.ndarray:
    """Penumbra width through each pixel, (n,); NaN without an end.

    Args:
        target: visibility (H, W). near: (H, W) bool, pixels on one surface. pixels: rows and
            columns, (2, n).
    """
    slope = np.stack([gaussian_filter(target, SMOOTH, order) for order in ((1, 0), (0, 1))])
    direction = slope[:, pixels[0], pixels[1]]
    direction = direction / np.maximum(np.linalg.norm(direction, axis=0), 1e-9)
    return 1.25 * sum(
        _distance_to_end(target, near, pixels, sign * direction, end)
        for sign, end in zip((-1, 1), ENDS)
    )


def _distance_to_end(target, near, pixels, direction, end: float) -> np.ndarray:
    """Distance to an end of visibility, (n,) pixels; NaN without one."""
    distances = np.full(pixels.shape[1], np.nan)
    searching = np.ones(pixels.shape[1], bool)
    for step in range(1, FARTHEST):
        position = pixels[:, searching] + step * direction[:, searching]
        pixel = np.rint(position).astype(int)
        inside = ((pixel >= 0) & (pixel < np.array(target.shape)[:, None])).all(0)
        inside[inside] = near[tuple(pixel[:, inside])]
        value = map_coordinates(target, position, order=1, mode="nearest")
        reached = inside & ((value - end) * (end - 0.5) >= 0)
        index = np.flatnonzero(searching)
        distances[index[reached]] = step - 0.5  # the step's middle
        searching[index[reached | ~inside]] = False
    return distances
