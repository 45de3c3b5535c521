"""Stage: import an engine's frame as a part of a frame set."""

from collections.abc import Mapping, Sequence
from pathlib import Path

import numpy as np

from neural_shadows.files.frame_images import FrameImages
from neural_shadows.files.whole_files import write_array, write_json
from neural_shadows.frames.engine_frame import engine_frame
from neural_shadows.running.stage import run_stage


def import_frame(
    files: list[Path],
    frames_json: Path,
    buffers_npy: Path,
    targets_npy: Path,
    valid_npy: Path,
    *,
    size: float,
    fov: float,
    radii: Sequence[float],
    radius_unit: str,
    channels: Mapping[str, str | None],
    targets: Sequence[str],
) -> None:
    """Write a frame as a `FrameSetPart`, lengths in the engine's unit.

    Args:
        files: of the frame's folder.
        size: of the scene, in the unit of the frame's distances.
        fov: vertical, in degrees.
        radii: of the lights of its targets, in metres or in shares of the size (`radius_unit`).
        channels, targets: see `engine_frame`.

    Raises:
        InputError: see `engine_frame`.
    """
    folder = files[0].parent
    images = FrameImages(folder)
    frame = engine_frame(images, channels, targets, size)
    height, width = frame.valid.shape
    buffers = np.stack([*frame.buffers.values()])
    write_array(buffers_npy, buffers[None, None].astype(np.float16))
    write_array(targets_npy, frame.targets[None].astype(np.float16))
    write_array(valid_npy, frame.valid[None, None])
    unit = {"metres": 1.0, "scene_sizes": size}[radius_unit]
    setting = {"fov_deg": fov, "window": None}
    about = {"use": "test", "source": str(folder), "form": images.form}
    about |= {"width": width, "height": height, "size": size}
    about |= {"radii": [unit * radius for radius in radii]}
    about |= {"given_radii": [*radii], "radius_unit": radius_unit}
    about |= {"targets": bool(len(frame.targets)), "channels": [*frame.buffers]}
    write_json(frames_json, about | {"frames": [{"setting": setting, "twins": []}]})


if "snakemake" in globals():
    run_stage(snakemake, import_frame)
