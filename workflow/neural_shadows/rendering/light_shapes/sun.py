"""A sun: a direction with an angular radius."""

from typing import Literal

import numpy as np
from pydantic import Field

from neural_shadows.rendering.light_shape import LightShape, MapView

# In sizes of the scene. Its directions from a scene's points differ by 0.05° at most, and penumbrae's
# widths by 0.1 %. Positions in float32 so far away, as of maps, are known to 3e-5 of the size: less
# than any depth bias.
DISTANCE = 1000.0
_MARGIN = 1.02  # of the scene's bounding sphere in the map


class Settings(LightShape):
    """A sun, realised as a sphere 1000 scene sizes away.

    Its light map is a perspective one fitted to the scene's bounding sphere.
    """

    shape: Literal["sun"] = Field(
        description="`sun`: `radii` are angular, in degrees; the real sun has 0.27"
    )
    min_elevation_deg: float = Field(
        20.0, ge=0, lt=90, description="least elevation above the horizon, degrees"
    )

    RADIUS_UNITS = ("degrees",)
    MAPS = ("perspective",)
    AWAY = DISTANCE

    def radius_of(self, size, unit, scene_size):
        return float(DISTANCE * scene_size * np.tan(np.radians(size)))

    def draw_centre(self, lights, scene, rng):
        from neural_shadows.scenes.lights import draw_light

        domain = {"domain": "sphere", "min_elevation_deg": self.min_elevation_deg}
        return scene.ball[0] + DISTANCE * scene.size * draw_light(domain, scene.up, rng)

    def map_view(self, scene, centre):
        middle, radius = scene.ball
        forward, radius = middle - centre, _MARGIN * radius
        distance = np.linalg.norm(forward)
        fov = 2 * np.degrees(np.arcsin(radius / distance))
        return MapView(forward, float(fov), float(distance - radius))
