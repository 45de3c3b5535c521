"""How wide penumbrae of test frames are, beside what Neural Shadow Mapping's model gives them (3.6)."""

import numpy as np
from scipy.ndimage import gaussian_filter, map_coordinates, maximum_filter, minimum_filter

from neural_shadows.evaluation.measured_frames import MeasuredFrame
from neural_shadows.frames.penumbra_widths import model_widths

MIDDLE = (0.35, 0.65)  # visibilities of a penumbra's middle, from which its ends are looked for …
ENDS = (0.1, 0.9)  # … which are here; 0.8 of the width lies between them
FARTHEST = 256  # pixels to an end
SMOOTH = 1.5  # pixels of the slope's Gaussian
NARROWEST = 5.0  # pixels by the model: of what is narrower the pixels' own width is a part


def widths(measured: MeasuredFrame, k: int) -> np.ndarray:
    """Measured width and the model's, in pixels, of a frame's pixels in a penumbra's middle: (2, n).

    Measured is the way along the slope on which visibility goes from 10 to 90 %, times 1.25. Left out
    are penumbrae that end at another surface or the frame's side before, as where several overlap,
    and those that are narrow by the model: to leave out what is measured as narrow would lift the
    percentiles of what is measured alone.
    """
    frame, target = measured.frame, measured.target[k]
    surface = frame.surface
    depth = surface.depth_image()
    near = maximum_filter(depth, 5) - minimum_filter(depth, 5) < 0.03 * depth
    near &= measured.valid
    middle = (target > MIDDLE[0]) & (target < MIDDLE[1]) & near
    chosen = np.flatnonzero(middle.ravel()[surface.pixel])
    places = np.divmod(surface.pixel[chosen], surface.width)
    across = measured_widths(target, near, np.array(places))
    radius, focal = measured.part.radii[k], surface.camera.focal(surface.height)
    pixels = model_widths(frame.scene, surface, frame.centre, radius, focal, chosen)
    return np.stack([across, pixels])[:, (across > 0) & (pixels >= NARROWEST)]


def measured_widths(target: np.ndarray, near: np.ndarray, places: np.ndarray) -> np.ndarray:
    """The width of the penumbra through each place, (n,) pixels; NaN where it has no end.

    Args:
        target: visibility (H, W). near: (H, W) bool, what lies on one surface. places: rows and
            columns, (2, n).
    """
    slope = np.stack([gaussian_filter(target, SMOOTH, order) for order in ((1, 0), (0, 1))])
    way = slope[:, places[0], places[1]]
    way = way / np.maximum(np.linalg.norm(way, axis=0), 1e-9)
    return 1.25 * sum(
        _way_to_end(target, near, places, sign * way, end) for sign, end in zip((-1, 1), ENDS)
    )


def _way_to_end(target, near, places, way, end: float) -> np.ndarray:
    """How far along each way (2, n) visibility reaches an end, (n,) pixels; NaN if it does not."""
    found = np.full(places.shape[1], np.nan)
    alive = np.ones(places.shape[1], bool)
    for step in range(1, FARTHEST):
        place = places[:, alive] + step * way[:, alive]
        pixel = np.rint(place).astype(int)
        inside = ((pixel >= 0) & (pixel < np.array(target.shape)[:, None])).all(0)
        inside[inside] = near[tuple(pixel[:, inside])]
        value = map_coordinates(target, place, order=1, mode="nearest")
        there = inside & ((value - end) * (end - 0.5) >= 0)
        index = np.flatnonzero(alive)
        found[index[there]] = step - 0.5  # somewhere in it
        alive[index[there | ~inside]] = False
    return found
