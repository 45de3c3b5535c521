"""Rendering of a frame: buffers, and soft shadows of all radii."""

from collections.abc import Sequence

import numpy as np
from scipy.ndimage import binary_dilation, gaussian_filter

from neural_shadows.frames.buffers import buffers_of
from neural_shadows.frames.draw_settings import FrameKind, light_map_of
from neural_shadows.frames.ray_tracing import traced_images
from neural_shadows.frames.setting import Setting
from neural_shadows.frames.soft_frame import SoftFrame
from neural_shadows.frames.soft_scene import SoftScene
from neural_shadows.rendering.geometry_edges import geometry_edges
from neural_shadows.rendering.soft_shadows import CENTRE, PLACES, see_places, soft_visibility
from neural_shadows.rendering.surface import see_surface


def render_buffers(
    scene: SoftScene, kind: FrameKind, setting: Setting, aimed_from: np.ndarray | None = None
) -> tuple[np.ndarray, np.ndarray]:
    """Render the buffers of a setting.

    Returns:
        (channels, height, width) float16, and valid pixels, with a surface inside the light's map,
        (height, width) bool.

    Args:
        aimed_from: of a perturbed frame, its frame's light, to keep the map's axes. A map aimed anew
            at the same middle would look up its points in the same texels as before.
    """
    opened = scene.moved(setting.motion)
    surface = see_surface(opened, setting.camera, kind.width, kind.height)
    light_map = light_map_of(kind.light_map, scene, setting.centre, aimed_from, kind.shape)
    inside = light_map.texels_of(surface.p - setting.centre) >= 0
    return buffers_of(opened, surface, light_map), surface.image(inside, False)


def render_target(
    scene: SoftScene,
    kind: FrameKind,
    setting: Setting,
    *,
    radii: Sequence[float],
    samples: int,
    blur: float,
) -> tuple[np.ndarray, np.ndarray]:
    """Render the exact soft shadow for each radius.

    Returns:
        (radii, height, width) float32, and pixels at edges of the geometry, (height, width) bool:
        with a blur, also pixels beside one.

    Args:
        radii, samples: see `soft_visibility`. blur: σ in pixels of a Gaussian over all but a point
            light's (Datta et al. 2022, 3.1); 0 for none.
    """
    opened, seen = scene.moved(setting.motion), (setting.camera, kind.width, kind.height)
    middle, *surfaces = see_places(opened, *seen, places=(CENTRE, *PLACES))
    target = soft_visibility(
        opened,
        *seen,
        centre=setting.centre,
        radii=radii,
        samples=samples,
        shape=kind.shape,
        surfaces=surfaces,
    )
    edges = geometry_edges([middle, *surfaces])
    if blur:
        edges = binary_dilation(edges, np.ones((3, 3), bool))
    for image, radius in zip(target, radii):
        if blur and radius:
            image[:] = gaussian_filter(image, blur, mode="nearest", radius=1)
    return target, edges


def render_rays(
    scene: SoftScene, kind: FrameKind, setting: Setting, *, radii: Sequence[float], rays: int
) -> np.ndarray:
    """Trace few rays a pixel: (radii, 2, height, width) float16, see `traced_images`.

    Args:
        radii: of the lights, in metres. rays: of a pixel, to a light with an extent.
    """
    opened = scene.moved(setting.motion)
    surface = see_surface(opened, setting.camera, kind.width, kind.height)
    light_map = light_map_of(kind.light_map, scene, setting.centre, shape=kind.shape)
    frame = SoftFrame(opened, surface, setting.centre, light_map, shape=kind.shape)
    images = [np.stack(traced_images(frame, radius, samples=rays)) for radius in radii]
    return np.stack(images).astype(np.float16)
