"""Stage: penumbra widths of a frame set's test frames."""

from collections import defaultdict
from pathlib import Path

import numpy as np

from neural_shadows.files.whole_files import write_json
from neural_shadows.frames.frame_set import FrameSetPart
from neural_shadows.metrics.penumbra_width import WIDEST, local_widths
from neural_shadows.running.origin import describe_origin
from neural_shadows.running.progress import progress_bar
from neural_shadows.running.stage import run_stage

PERCENTILES = (50, 90)


def measure_widths(parts: list[Path], widths_json: Path) -> None:
    """Write median and 90th percentile of widths, in pixels. Of each scene and light.

    Over the penumbra pixels of a scene's frames, see `local_widths`. The JSON has by scene, as
    `scenes`, a pair by radius, None of a light without a penumbra; `radii` as they are configured, in
    `radius_unit`; `widest`: see `WIDEST`.

    Args:
        parts: of test frames with their exact shadows.

    Raises:
        InputError: a part is damaged.
    """
    widths: dict[tuple[str, int], list[np.ndarray]] = defaultdict(list)
    opened = [FrameSetPart(path) for path in parts]
    scenes = list(dict.fromkeys(path.parent.name for path in parts))
    with progress_bar(sum(map(len, opened)), "frames", "widths of penumbrae") as bar:
        for part in opened:
            scene = part.frames_json.parent.name
            for number in range(len(part)):
                valid, edges = part.valid[number, 0], part.edges
                edges = np.zeros_like(valid) if edges is None else edges[number]
                for k in range(len(part.radii)):
                    visibility = part.targets[number, k].astype(np.float32)
                    widths[scene, k].append(local_widths(visibility, valid, edges))
                bar.update()
    radii = range(len(opened[0].radii))
    by_scene = {
        scene: [_percentiles(np.concatenate(widths[scene, k])) for k in radii] for scene in scenes
    }
    about = opened[0].about
    lights = {"radii": about.get("given_radii", about["radii"])}
    lights["radius_unit"] = about.get("radius_unit", "metres")
    summary = {"widest": WIDEST, **lights, "scenes": by_scene}
    write_json(widths_json, summary | describe_origin())


def _percentiles(widths: np.ndarray) -> list[float] | None:
    return np.percentile(widths, PERCENTILES).tolist() if widths.size else None


if "snakemake" in globals():
    run_stage(snakemake, measure_widths)
