"""Stage: reference frames of a batch of viewpoints [4.1]."""

from pathlib import Path

import numpy as np

from neural_shadows.evaluation.references import write_references
from neural_shadows.evaluation.registry import REFERENCES, classic_method
from neural_shadows.rendering.gbuffer import GBuffer, render_gbuffer
from neural_shadows.rendering.viewpoints import draw_viewpoints
from neural_shadows.running.progress import progress_bar
from neural_shadows.running.stage import run_stage
from neural_shadows.scenes.scene import open_scene
from neural_shadows.settings.records import SceneSettings, ViewSettings


def render_references(
    mesh_ply: Path,
    references: Path,
    *,
    scene: SceneSettings,
    frames: ViewSettings,
    first: int,
    last: int,
    reference: str = "exact",
) -> None:
    """Render viewpoints `first` to `last` (exclusive) of each set.

    Args:
        references: for the G-buffers and the visibilities, see `References`.
        scene: `up`, `ground` and `light`, see `open_scene`.
        frames: `width`, `height` (pixels), and the settings of `draw_viewpoints`: `view_sets`, `seed`,
            `least_shadow`.
        reference: `exact`, or the thesis's `shadow_map` of 32768² texels.

    Raises:
        InputError: the mesh cannot be read, or a setting does not fit the scene.
    """
    opened = open_scene(mesh_ply, **scene)
    reference_method = classic_method(REFERENCES[reference], opened)
    width, height, view_sets, seed = (
        frames[key] for key in ("width", "height", "view_sets", "seed")
    )
    views = draw_viewpoints(
        opened,
        view_sets,
        range(first, last),
        width / height,
        seed,
        frames.get("least_shadow", 0.0),
    )
    rendered: list[tuple[GBuffer, np.ndarray]] = []
    with progress_bar(len(views), "views", f"render references of {mesh_ply.parent.name}") as bar:
        for view in views:
            frame = render_gbuffer(opened, view, width, height)
            rendered.append((frame, reference_method(frame)(0.0)))
            bar.update()
    write_references(references, rendered, opened.ground)


if "snakemake" in globals():
    run_stage(snakemake, render_references)
