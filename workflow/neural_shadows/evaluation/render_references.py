"""The stage that renders a batch of viewpoints once for all methods [4.1]."""

from collections.abc import Mapping
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path
from typing import Any

import numpy as np

from neural_shadows.evaluation.first_frames import write_first_frames
from neural_shadows.evaluation.references import write_references
from neural_shadows.evaluation.shadow_methods import REFERENCES, traced_method
from neural_shadows.rendering.gbuffer import GBuffer, render_gbuffer
from neural_shadows.rendering.shading import shade
from neural_shadows.rendering.viewpoints import draw_viewpoints
from neural_shadows.running.progress import progress_bar
from neural_shadows.running.stage import run_stage
from neural_shadows.scenes.scene import open_scene


def render_references(
    mesh_ply: Path,
    references: Path,
    pictures_npz: Path,
    *,
    scene: Mapping[str, Any],
    frames: Mapping[str, Any],
    first: int,
    last: int,
    reference: str = "exact",
    threads: int = 1,
) -> None:
    """Draw viewpoints `first` to `last` (exclusive) of each view set, and render them.

    Args:
        references: for the G-buffers and the visibilities, see `References`.
        pictures_npz: for the picture of each set's first view, see `write_first_frames`.
        scene: `up`, `ground` and `light`, see `open_scene`.
        frames: `width`, `height` (pixels), `view_sets` and `seed`, see `draw_viewpoints`.
        reference: `exact`, or the thesis's `shadow_map` of 32768² texels.

    Raises:
        InputError: the mesh cannot be read, or a setting does not fit the scene.
    """
    opened = open_scene(mesh_ply, **scene)
    answer = traced_method(REFERENCES[reference], opened)
    width, height = frames["width"], frames["height"]

    def render(view_set: str, index: int) -> tuple[GBuffer, np.ndarray]:
        (view,) = draw_viewpoints(opened, [view_set], [index], width / height, frames["seed"])
        frame = render_gbuffer(opened, view, width, height)
        return frame, answer(frame)

    views = [(view_set, i) for view_set in frames["view_sets"] for i in range(first, last)]
    rendered: list[tuple[GBuffer, np.ndarray]] = []
    pictures: dict[str, np.ndarray] = {}
    with (
        ThreadPoolExecutor(threads) as pool,  # Embree and NumPy release the GIL
        progress_bar(len(views), "views", "references") as bar,
    ):
        for frame, visibility in pool.map(render, *zip(*views, strict=True)):
            rendered.append((frame, visibility))
            pictures.setdefault(frame.view.view_set, shade(frame, visibility))
            bar.update()
    write_first_frames(pictures_npz, "reference", pictures)
    write_references(references, rendered, opened.ground)


if "snakemake" in globals():
    run_stage(snakemake, render_references)
