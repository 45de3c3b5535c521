"""A rendered frame as an engine writes it: distances in its own unit, normals in world axes."""

from pathlib import Path

import numpy as np
import OpenEXR

from neural_shadows.evaluation.measured_frames import MeasuredFrame

Images = dict[str, np.ndarray]  # by `FILE:CHANNEL`, as `engine_channels` names them

NAMES = {
    "z": "MyGBuffer.distE.15:R",
    "z_b": "MyShadowMap.color.15:B",
    "d": "MyGBuffer.distV.15:R",
    "c_e": "MyGBuffer.ce.15:R",
    "c_v": "MyGBuffer.cv.15:R",
    "hard": "MyShadowMap.color.15:G",
    "pcf": "MyGBuffer.visibility.70:R",
    "msm": "MyShadowMap.msm.15:G",
    **{f"n_{axis}": f"MyGBuffer.normW.15:{colour}" for axis, colour in zip("xyz", "RGB")},
}
TARGETS = [f"AccumulatePass1.output.90:{colour}" for colour in "RG"]  # of two radii


def engine_images(rendered: MeasuredFrame) -> Images:
    """The images of a frame; of its surface points, but for what its map shows.

    Where nothing is seen distances are 0, and all else is what an engine may leave there: NaN.
    """
    frame, about = rendered.frame, rendered.part.about
    surface = frame.surface
    eye = surface.camera.eye - surface.p
    z, d = (np.linalg.norm(ways, axis=1) for ways in (frame.from_light, eye))
    points = {
        "z": z,
        "d": d,
        "c_e": -np.einsum("ij,ij->i", frame.from_light, surface.n) / z,
        "c_v": np.einsum("ij,ij->i", eye, surface.n) / d,
        **dict(zip(("n_x", "n_y", "n_z"), surface.n.T)),
    }
    images = {name: surface.image(np.float32(one), np.nan) for name, one in points.items()}
    seen = np.isfinite(images["z"])
    beyond = rendered.picture("gap") * about["size"]
    images["z_b"] = images["z"] + beyond
    images |= {
        name: np.where(seen, rendered.picture(name), np.nan) for name in ("hard", "pcf", "msm")
    }
    for name in ("z", "d"):
        images[name] = np.where(seen, images[name], 0)
    found = {NAMES[name]: image for name, image in images.items()}
    return found | dict(zip(TARGETS, rendered.target))


def write_exr(folder: Path, images: Images) -> None:
    """A file for each file's name, in half floats."""
    folder.mkdir(parents=True, exist_ok=True)
    for file, channels in by_file(images).items():
        header = {"compression": OpenEXR.ZIP_COMPRESSION, "type": OpenEXR.scanlineimage}
        halves = {name: np.ascontiguousarray(one, np.float16) for name, one in channels.items()}
        OpenEXR.File(header, halves).write(str(folder / f"{file}.exr"))


def write_npz(folder: Path, images: Images) -> None:
    """One file of (H, W, 3) float32."""
    folder.mkdir(parents=True, exist_ok=True)
    arrays = {}
    for file, channels in by_file(images).items():
        empty = np.zeros_like(next(iter(channels.values())))
        planes = [channels.get(name, empty) for name in "RGB"]
        arrays[file] = np.stack(planes, axis=-1, dtype=np.float32)
    np.savez(folder / "frame.npz", **arrays)


def by_file(images: Images) -> dict[str, Images]:
    """Images by file and channel."""
    found: dict[str, Images] = {}
    for name, image in images.items():
        file, channel = name.rsplit(":", 1)
        found.setdefault(file, {})[channel] = image
    return found
