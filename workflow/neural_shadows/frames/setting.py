"""Setting of a frame: camera, light, and motion of the scene's mover."""

from dataclasses import dataclass

import numpy as np

from neural_shadows.scenes.arrangement import UP
from neural_shadows.scenes.cameras import Camera, Window
from neural_shadows.settings.records import SettingRecord


@dataclass(frozen=True, eq=False)
class Setting:
    """A camera, the centre of a light, and the motion of the scene's mover; in metres."""

    camera: Camera
    centre: np.ndarray  # (3,) float64
    motion: np.ndarray  # (4, 4) float64, rigid; the identity at rest

    def as_json(self) -> SettingRecord:
        """The setting as plain data."""
        camera, window = self.camera, self.camera.window
        return {
            "eye": camera.eye.tolist(),
            "target": camera.target.tolist(),
            "fov_deg": camera.fov,
            "window": None if window is None else vars(window),
            "light": self.centre.tolist(),
            "motion": self.motion.tolist(),
        }


def setting_of(data: SettingRecord) -> Setting:
    """Read a setting from the data of `as_json`."""
    window = data["window"] and Window(**data["window"])
    eye, target, light, motion = (
        np.array(data[key], np.float64) for key in ("eye", "target", "light", "motion")
    )
    return Setting(Camera(eye, target, UP, data["fov_deg"], window), light, motion)
