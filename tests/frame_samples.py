"""Frames on disk whose pictures are given, for the tests of what shows them."""

from collections.abc import Mapping
from pathlib import Path

import numpy as np

from neural_shadows.evaluation.answers import write_answers
from neural_shadows.evaluation.references import write_references
from neural_shadows.rendering.gbuffer import GBuffer
from neural_shadows.scenes.cameras import Viewpoint


def flat_frame(view_set: str, index: int, height: int, width: int) -> GBuffer:
    """A frame full of a surface that faces the light."""
    x, y, z = np.eye(3)
    count = height * width
    return GBuffer(
        view=Viewpoint(view_set, index, z, 0 * z, y, 40.0, z),
        width=width,
        height=height,
        pixel=np.arange(count),
        is_object=np.ones(count, bool),
        lit_side=np.arange(count),
        p=np.zeros((count, 3), np.float32),
        cos_geometric=np.ones(count, np.float32),
        cos_shading=np.ones(count, np.float32),
    )


def write_frames(
    folder: Path, seen: Mapping[str, Mapping[tuple[str, int], np.ndarray]], batch: str = "000"
) -> tuple[list[Path], list[Path]]:
    """Write a batch of a scene whose visibility (H, W) by method and view is `seen`.

    `reference` is among the methods. Returns: the paths of the references and the visibilities.
    """
    truth = seen["reference"]
    frames = [
        (flat_frame(*view, *lit.shape), np.float32(lit.ravel())) for view, lit in truth.items()
    ]
    references = folder / f"{batch}.safetensors"
    write_references(references, frames, None)
    paths = []
    for method, views in seen.items():
        if method != "reference":
            paths.append(folder / f"{folder.name}.{batch}" / f"{method}.npz")
            paths[-1].parent.mkdir(exist_ok=True)
            lit = {str(number): views[view].ravel() for number, view in enumerate(truth)}
            write_answers(paths[-1], lit)
    return [references], paths
