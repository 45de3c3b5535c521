"""Measured widths of penumbrae beside a model's (Datta et al. 2022, 3.6)."""

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Literal

import numpy as np
import pandas as pd
from pydantic import Field

from neural_shadows.metrics.intervals import t_interval
from neural_shadows.reports.data.lights import light_names
from neural_shadows.reports.data.table import Table, intervals, numbers, with_ends
from neural_shadows.sections.frame_tables import FramesTable, check_penumbrae
from neural_shadows.sections.sections import Sections

WIDE = 95  # percentile of widths: the paper chooses the network's levels by it


class Settings(FramesTable):
    """Widths of penumbrae beside those of Neural Shadow Mapping's model (3.6)."""

    kind: Literal["penumbra_widths"] = Field(description="`penumbra_widths`")

    def check(self, config: Sections, key: str) -> None:
        super().check(config, key)
        check_penumbrae(config, key, self.frame_set)


def table(first_parts: list[Path], soft_meshes: list[Path]) -> Table:
    """Tabulate measured and modelled widths by scene and light.

    CSV: those of `widths_table`, and the scale.

    Args:
        first_parts: of test frames, one a scene. soft_meshes: see `measured_frames`.
    """
    from neural_shadows.evaluation.measured_frames import measured_frames
    from neural_shadows.evaluation.measured_penumbrae import NARROWEST, modelled_widths, widths

    pairs, modelled, names = {}, {}, []
    for frame in measured_frames(first_parts, soft_meshes):
        names = light_names(frame.part.about)
        for light, radius in enumerate(frame.part.radii):
            if radius > 0:
                key = frame.scene_name, light, radius
                pairs.setdefault(key, []).append(widths(frame, light))
                modelled.setdefault(key, []).append(modelled_widths(frame, light))
    bounds = {key: _wide(np.concatenate(frames)) for key, frames in modelled.items()}
    table = widths_table(pairs, bounds)
    columns = {
        "scene": table["scene"],
        "light": [names[light] for light in table["light"]],
        "pixels": numbers(table["pixels"], "{:,.0f}"),
        "measured, px": numbers(table["measured"], "{:.1f}"),
        f"{WIDE} % of them": numbers(table["measured_wide"], "≤ {:.1f}"),
        "by the model, px": numbers(table["modelled"], "{:.1f}"),
        f"{WIDE} % of all": numbers(table["modelled_wide"], "≤ {:.1f}"),
        "their ratio": intervals(table, with_ends("wide_ratio"), 2),
        "measured within, %": numbers(table["within"], "{:.1f}", 100),
    }
    notes = [
        "Measured: the distance from 10 to 90 % visibility, times 1.25, through pixels in the middle of a "
        f"penumbra with both ends on one surface and, by the model, {NARROWEST:g} pixels or more; "
        "medians. Other penumbrae have no such width, among them the widest of a light never fully "
        "hidden. By the model: seen head-on at the same pixels. Whole steps to both ends may add 2.5 "
        "pixels to the measured width.",
        f"{WIDE} % of all: quantile of the model's widths above 0 over all pixels of the frames, the bound by which "
        "the paper chooses the network's levels.",
        f"Their ratio: of the {WIDE} % quantile of a frame's measured widths to that bound, geometric mean "
        "[95 % over a scene's frames, Student's t]. Within: share of pixels not wider than it.",
    ]
    return Table(table, columns, notes)


def widths_table(
    pairs: Mapping[tuple[str, int, float], Sequence[np.ndarray]],
    bounds: Mapping[tuple[str, int, float], float],
) -> pd.DataFrame:
    """Tabulate widths by scene and light.

    Columns: `scene`, `light`, the radius's number from 0, `radius`, `pixels`; of these `measured`
    and `modelled`, medians in pixels, and `measured_wide`, which `WIDE` percent do not exceed;
    `modelled_wide`, the bound; `wide_ratio`, of a frame's `measured_wide` to it, with the ends of its interval
    over frames; `within`, the share of measured widths up to the bound. NaN without pixels.

    Args:
        pairs: measured widths and the model's, (2, n) pixels of each frame, by scene, light and radius.
        bounds: by these what `WIDE` percent of the model's widths do not exceed, over all pixels.
    """
    rows = []
    for (scene, light, radius), frames in pairs.items():
        both, bound = np.hstack(frames), bounds[scene, light, radius]
        row = {"scene": scene, "light": light, "radius": radius, "pixels": both.shape[1]}
        row |= {"measured": np.nan, "measured_wide": _wide(both[0]), "modelled": np.nan}
        if both.size:
            row["measured"], row["modelled"] = np.median(both, axis=1)
        row |= {"modelled_wide": bound} | _wide_ratio([f[0] for f in frames if f.size], bound)
        within = both[0] <= bound
        rows.append(row | {"within": within.mean() if within.size else np.nan})
    return pd.DataFrame(rows)


def _wide(pixels: np.ndarray) -> float:
    """What `WIDE` percent of widths do not exceed; NaN of none."""
    return float(np.percentile(pixels, WIDE)) if pixels.size else np.nan


def _wide_ratio(frames: Sequence[np.ndarray], bound: float) -> dict[str, float]:
    """Ratio of the `WIDE` percentiles of frames' measured widths to a bound.

    The geometric mean over frames, with its interval by Student's t, NaN of fewer than two. (The ratio
    of all frames' percentiles has none that covers: simulated over eight frames 89 %.)
    """
    names = with_ends("wide_ratio")
    if not frames:
        return dict.fromkeys(names, np.nan)
    ratios = [_wide(frame) / bound for frame in frames]
    interval = np.exp(t_interval(np.log(ratios))[:3])
    return dict(zip(names, interval if len(frames) > 1 else (interval[0], np.nan, np.nan)))
