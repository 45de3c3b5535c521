"""Object height on the plate for a penumbra width (Datta et al. 2022, 3.6)."""

from collections.abc import Mapping
from functools import cache

import numpy as np

from neural_shadows.errors import InputError
from neural_shadows.frames.penumbra_widths import model_widths
from neural_shadows.meshes.prepared_mesh import PreparedMesh
from neural_shadows.rendering.surface import see_surface
from neural_shadows.scenes.arrangement import UP, scene_of
from neural_shadows.scenes.cameras import Camera
from neural_shadows.scenes.generated import generator

# The paper's largest light and, in pixels, its frames' size.
RADIUS, SIDE, FOV = 0.25, 512, 45.0
PERCENTILE = 95  # of the widths above 0
# Many cameras of few pixels: of 64, which 3 m of distance vary by 7 %, the mean is known to 1 %.
_CAMERAS, _PIXELS = 64, 24


def height_of(
    inserted: Mapping[str, PreparedMesh], penumbra: float, rng: np.random.Generator
) -> float:
    """Find the spot's height, to the millimetre, for a penumbra width.

    Args:
        penumbra: the model's 95th percentile, in pixels.

    Raises:
        InputError: no height of the spot has that width.
    """
    from scipy.optimize import brentq  # 0.2 s to import, needless for scenes of known height

    settings = [_drawn(rng) for _ in range(_CAMERAS)]

    @cache  # each takes 0.4 s, most of it to build the scene
    def too_wide(height: float) -> float:
        return np.log(_width(inserted, height, settings) / penumbra)

    ends = 0.0, generator("plate").HIGHEST
    least, most = (penumbra * np.exp(too_wide(end)) for end in ends)
    if not least < penumbra < most:
        raise InputError(
            f"penumbra = {penumbra:g}: {', '.join(inserted)} on a plate has {least:.0f} to "
            f"{most:.0f} pixels, by its height. Choose a width between these"
        )
    return round(brentq(too_wide, *ends, xtol=1e-3), 3)


def _drawn(rng: np.random.Generator) -> tuple[Camera, np.ndarray]:
    plate = generator("plate").arrange_plate(0.0)
    eye, target, centre = (
        region.draw(rng) for region in (plate.cameras, plate.targets, plate.lights)
    )
    return Camera(eye, target, UP, FOV), centre


def _width(inserted: Mapping[str, PreparedMesh], height: float, settings) -> float:
    """The percentile in pixels of a whole frame, for a height."""
    scene = scene_of(generator("plate").arrange_plate(height), inserted)
    widths = []
    for camera, centre in settings:
        surface = see_surface(scene, camera, _PIXELS, _PIXELS)
        widths.append(model_widths(scene, surface, centre, RADIUS, camera.focal(SIDE)))
    pixels = np.concatenate(widths)
    return float(np.percentile(pixels[pixels > 0], PERCENTILE))
