"""Notes on widths of penumbrae, from `measure_widths`."""

from collections.abc import Sequence
from pathlib import Path

import numpy as np

from neural_shadows.files.whole_files import read_json
from neural_shadows.reports.data.lights import light_names


def describe_widths(widths_json: Path | None, scenes: Sequence[str] | None = None) -> list[str]:
    """Describe penumbra widths by light: median and 90th percentile.

    Each is the median over `scenes`, of the former also the least and the most. Nothing of a point
    light, whose penumbrae are the antialiasing's, or without a file.

    Args:
        scenes: of the table; without them all of the frame set.
    """
    if widths_json is None:
        return []
    record = read_json(widths_json)
    scenes = [*record["scenes"]] if scenes is None else scenes
    parts = []
    for k, light in enumerate(light_names(record)):
        widths = [record["scenes"][scene][k] for scene in scenes if record["scenes"][scene][k]]
        if light == "point light" or not widths:
            continue
        medians, wide = np.array(widths).T
        ends = f"{medians.min():.0f} to {medians.max():.0f}"
        parts.append(f"{light} {np.median(medians):.0f} ({ends}) and {np.median(wide):.0f}")
    return [
        "Exact widths of penumbrae in pixels, median and 90th percentile over a scene's penumbra "
        f"pixels, of {len(scenes)} scenes the median (least to most): {'; '.join(parts)}. Wider "
        f"ones count as {record['widest']}."
    ]
