"""Pixels with a penumbra feature, by visibility (Hu et al. 2025, 4.1)."""

from pathlib import Path
from typing import TYPE_CHECKING, Any, Literal

import numpy as np
import pandas as pd
from pydantic import Field

from neural_shadows.layout import soft_methods
from neural_shadows.layout.layout import Layout
from neural_shadows.metrics.visibility_error import LIT, UMBRA
from neural_shadows.reports.data import phrases
from neural_shadows.reports.data.lights import UNITS, light_name
from neural_shadows.reports.data.table import Table, numbers, write_table
from neural_shadows.running.stage import run_stage
from neural_shadows.sections.frame_tables import FramesTable
from neural_shadows.settings.records import Run

if TYPE_CHECKING:
    from neural_shadows.frames.frame_set import FrameSetPart

FEATURE = "penumbra"
TOLD = 0.5  # pixels: narrower penumbrae are edges of hard shadows
WHERE = ("lit", "penumbra", "umbra")


class Settings(FramesTable):
    """Pixels with a penumbra in the features of kernel networks (Hu et al. 2025, 4.1)."""

    kind: Literal["penumbra_feature"] = Field(description="`penumbra_feature`")


def files(layout: Layout, table: str) -> dict[str, Any]:
    return {"parts": soft_methods.tests(layout, soft_methods.frame_set(layout, table))}


def params(layout: Layout, table: str) -> dict[str, Any]:
    return {"run": layout.run()}


def table(
    *,
    parts: list[Path],
    title: str,
    run: Run,
) -> Table:
    """Tabulate shares of pixels by area light, and over all lights.

    CSV: those of `feature_table`, `radius`, its unit, and the scale.

    Args:
        parts: of test frames.

    Raises:
        InputError: a part is missing, not whole, or lacks a channel of the feature.
    """
    from neural_shadows.frames.frame_set import FrameSetPart

    opened = [FrameSetPart(path) for path in parts]
    about = opened[0].about
    unit = UNITS[about.get("radius_unit", "metres")]
    radii = about.get("given_radii", about["radii"])
    table = feature_table(sum(map(feature_pixels, opened)))
    table["radius"] = [radii[row] if row != "all" else np.nan for row in table["light"]]
    table = table.assign(unit=unit, scale=run["scale"])
    columns = {
        "light": [
            "all" if row == "all" else light_name(radii[row], unit) for row in table["light"]
        ],
        **{f"{where}, % told": numbers(table[f"{where}_share"], "{:.2f}", 100) for where in WHERE},
        **{f"pixels {where}": numbers(table[where], "{:,.0f}") for where in WHERE},
    }
    notes = [
        f"Shares of pixels whose feature p, the width of the penumbra in the frame, exceeds {TOLD:g} "
        f"pixels, in {sum(map(len, opened))} test frames; lit, penumbra and umbra by the exact "
        f"shadow (above {LIT:.0%}, between, below {UMBRA:.0%}).",
        f"{phrases.TEXTS['kpnsm']} (4.1): z_b is the distance of the occluder of the light's centre. Without one it is the "
        "point's own and p is 0, also in the outer half of each penumbra. Fully lit pixels have p > 0 "
        "at wrong texels of the light map.",
        phrases.describe_run(run),
    ]
    return Table(title, table, columns, notes)


def feature_pixels(part: "FrameSetPart") -> np.ndarray:
    """Count the pixels of a part's frames, and those with p above `TOLD`.

    Returns: (radii, 3, 2) by light and `WHERE`.
    """
    from neural_shadows.frames.kernel_features import MADE_OF, PENUMBRA_PIXELS, kernel_feature
    from neural_shadows.frames.light_size import light_size

    counts = np.zeros((len(part.radii), len(WHERE), 2), np.int64)
    for number in range(len(part)):
        buffers = {name: part.image(number, name) for name in MADE_OF[FEATURE]}
        valid, lens = part.valid[number, 0], part.lens(number)
        for k, radius in enumerate(part.radii):
            light = light_size(radius, max(part.radii), part.about["size"])
            wide = PENUMBRA_PIXELS * kernel_feature(FEATURE, buffers, lens, light) > TOLD
            exact = part.targets[number, k]
            lit, umbra = exact > LIT, exact < UMBRA
            for count, pixels in zip(counts[k], (lit, ~(lit | umbra), umbra)):
                count += (pixels & valid).sum(), (pixels & valid & wide).sum()
    return np.where(np.array(part.radii)[:, None, None] > 0, counts, 0)


def feature_table(counts: np.ndarray) -> pd.DataFrame:
    """Tabulate shares by light with pixels, and over all lights.

    Columns: `light`, its number or `all`; by `WHERE` the pixels there, and the share in which p
    exceeds `TOLD` (`lit_share` …), NaN of none.

    Args:
        counts: see `feature_pixels`.
    """
    rows = {k: count for k, count in enumerate(counts) if count.any()} | {"all": counts.sum(axis=0)}
    records = []
    for light, count in rows.items():
        pixels, wide = count.T
        shares = wide / np.where(pixels, pixels, np.nan)
        named = {f"{where}_share": share for where, share in zip(WHERE, shares)}
        records.append({"light": light, **dict(zip(WHERE, pixels)), **named})
    return pd.DataFrame(records)


if "snakemake" in globals():
    run_stage(snakemake, table, write_table)
