"""A part of a frame set on disk: settings, buffers, targets, masks.

Of F frames with T perturbed frames each, C channels, K radii:

- `NAME.json`: the settings of each frame and its perturbed frames; `channels`, `radii` and the scene's
  `size` (both in metres, of a user's frames in a unit of theirs), how it was drawn (`seed`), and units;
- `NAME.buffers.npy`: (F, 1 + T, C, H, W) float16, of a frame and its perturbed frames, see `buffers`;
- `NAME.targets.npy`: (F, K, H, W) float16, the share of the light that each pixel of the frame itself sees, 1
  without a surface;
- `NAME.valid.npy`: (F, 1 + T, H, W) bool, pixels with a surface inside the light's map;
- `NAME.edges.npy`: (F, H, W) bool, pixels of the frame itself at edges of the geometry, see
  `geometry_edges`;
- `NAME.rays.npy`: (F, K, 2, H, W) float16, visibility and penumbrae by `rays` rays a pixel, see
  `traced_images`; 0 in place of 2 where `rays` is 0.

A user's frame set has the same files; it may lack some of `channels`, and an engine's frames have
no targets (`targets` is false, K 0), no edges, no rays, and only the camera's lens as their setting.
"""

from dataclasses import dataclass
from functools import cached_property
from pathlib import Path

import numpy as np

from neural_shadows.errors import InputError
from neural_shadows.files.arrays import open_array
from neural_shadows.files.whole_files import read_json
from neural_shadows.frames.buffers import CHANNELS, LIMITS, VISIBLE, out_of_range
from neural_shadows.frames.light_size import LightSize, light_size
from neural_shadows.frames.setting import Setting, setting_of
from neural_shadows.rendering.gbuffer import Lens, lens_of
from neural_shadows.rendering.light_shape import LightShape, light_shape
from neural_shadows.scenes.arrangement import UP
from neural_shadows.scenes.cameras import Camera, Window
from neural_shadows.settings.records import PartRecord

UNITS = (
    "settings and radii in metres; z, gap and d of the buffers in shares of `size`; "
    "visibilities from 0 (dark) to 1 (lit)"
)


@dataclass(frozen=True)
class FrameSetPart:
    """An opened part, with arrays read on first use.

    Args:
        frames_json: its JSON; the arrays lie beside it.
    """

    frames_json: Path

    @cached_property
    def about(self) -> PartRecord:
        """The part's JSON.

        Raises:
            InputError: it cannot be read, or lacks a key.
        """
        about = read_json(self.frames_json)
        for key in ("frames", "channels", "radii", "size", "width", "height"):
            if key not in about:
                raise InputError(f"{self.frames_json}: has no {key!r}")
        for number, frame in enumerate(about["frames"]):
            if "twins" not in frame:
                raise InputError(f"{self.frames_json}: frame {number} has no 'twins'")
        channels = about["channels"]
        if len(set(channels)) < len(channels) or not {"z"} <= {*channels} <= {*CHANNELS}:
            raise InputError(
                f"{self.frames_json}: channels {', '.join(channels)}; should be z and others of "
                f"{', '.join(CHANNELS)}."
            )
        if any(radius < 0 for radius in about["radii"]) or about["size"] <= 0:
            raise InputError(f"{self.frames_json}: a radius below 0, or a size that is not above 0")
        return about

    def __len__(self) -> int:
        return len(self.about["frames"])

    @property
    def radii(self) -> list[float]:
        """Radii of the lights, in metres, see `LightShape`."""
        return list(self.about["radii"])

    @cached_property
    def shape(self) -> LightShape:
        """Shape of the lights."""
        return light_shape(self.about.get("light"))

    def light_size(self, radius: float) -> LightSize:
        """Size of a light beside the largest of the part."""
        return light_size(radius, max(self.radii), self.about["size"], self.shape.AWAY)

    def setting(self, number: int) -> Setting:
        """The setting of a frame."""
        return setting_of(self.about["frames"][number]["setting"])

    def lens(self, number: int) -> Lens:
        """The lens of a frame's camera, its perturbed frames' too.

        Raises:
            InputError: the frame has no lens.
        """
        about = self.about
        setting = about["frames"][number].get("setting", {})
        for key in ("fov_deg", "window"):
            if key not in setting:
                raise InputError(
                    f"{self.frames_json}: the setting of frame {number} has no {key!r}"
                )
        window = setting["window"] and Window(**setting["window"])
        ahead = np.array([0.0, 0.0, -1.0])
        camera = Camera(np.zeros(3), ahead, UP, setting["fov_deg"], window)
        return lens_of(camera, about["width"], about["height"])

    def twin_setting(self, number: int, twin: int) -> Setting:
        """The setting of a frame's perturbed frame, counted from 0."""
        return setting_of(self.about["frames"][number]["twins"][twin])

    @cached_property
    def buffers(self) -> np.ndarray:
        """(F, 1 + T, C, H, W) float16."""
        twins = len(self.about["frames"][0]["twins"]) if len(self) else 0
        return self._open("buffers", np.float16, 1 + twins, len(self.about["channels"]))

    def image(self, number: int, channel: str, version: int = 0, window=(slice(None),) * 2):
        """A channel of a frame (version 0) or perturbed frame, (h, w) float32.

        Raises:
            InputError: the part lacks it.
        """
        channels = list(self.about["channels"])
        if channel not in channels:
            raise InputError(
                f"{self.source}: has no channel {channel}, only {', '.join(channels)}."
            )
        return np.float32(self.buffers[number, version, channels.index(channel)][window])

    @property
    def source(self) -> str:
        """The part's origin: an engine frame's folder, or its JSON."""
        return self.about.get("source", str(self.frames_json))

    @property
    def has_targets(self) -> bool:
        """True with exact soft shadows."""
        return self.about.get("targets", True)

    @cached_property
    def targets(self) -> np.ndarray:
        """(F, K, H, W) float16."""
        return self._open("targets", np.float16, len(self.radii) * self.has_targets)

    @cached_property
    def valid(self) -> np.ndarray:
        """(F, 1 + T, H, W) bool."""
        return self._open("valid", np.bool_, self.buffers.shape[1])

    @cached_property
    def edges(self) -> np.ndarray | None:
        """(F, H, W) bool; None for a user's frames."""
        return self._open("edges", np.bool_) if self.about.get("edges") else None

    @property
    def rays(self) -> int:
        """Rays a pixel of `traced`; 0 for none."""
        return self.about.get("rays", 0)

    @cached_property
    def traced(self) -> np.ndarray:
        """(F, K, 2, H, W) float16."""
        return self._open("rays", np.float16, len(self.radii), 2 * (self.rays > 0))

    def _open(self, stem: str, kind: type, *inner: int) -> np.ndarray:
        path = self.frames_json.with_suffix(f".{stem}.npy")
        shape = (len(self), *inner, self.about["height"], self.about["width"])
        # The JSON stands for all files of a part that a job writes: arrays are no inputs of other jobs.
        written = not {"scene", "source"}.isdisjoint(self.about)
        cure = f"Delete {self.frames_json} and run again" if written else "Write it anew"
        return open_array(path, shape, kind, cure)


def check_values(part: FrameSetPart) -> None:
    """Check the arrays of a user's part.

    Raises:
        InputError: NaN or infinity, a target or a surface's value outside its range (`LIMITS`), or no valid
            pixel.
    """
    for number in range(len(part)):
        buffers, targets = part.buffers[number], part.targets[number]
        for stem, array in {"buffers": buffers, "targets": targets}.items():
            if not np.isfinite(array).all():
                raise InputError(
                    f"{part.frames_json}: {stem} of frame {number} has NaN or infinity"
                )
        limited = [("a target", targets, VISIBLE)]
        surfaces = buffers[:, part.about["channels"].index("z")] != 0
        limited += [
            (f"channel {name}", buffers[:, at][surfaces], LIMITS[name])
            for at, name in enumerate(part.about["channels"])
            if name in LIMITS
        ]
        for name, values, limits in limited:
            if wrong := out_of_range(values, *limits):
                raise InputError(f"{part.frames_json}: {name} of frame {number} is {wrong}")
        if not part.valid[number, 0].any():
            raise InputError(f"{part.frames_json}: no pixel of frame {number} is valid")
