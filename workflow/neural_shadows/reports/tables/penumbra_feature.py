"""Where networks of kernels are told of a penumbra: in it, in the umbra, and where all is lit (Hu et al.
2025, 4.1).
"""

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
from neural_shadows.reports.data.published_kpnsm import PAPER
from neural_shadows.reports.data.table import Table, numbers, write_table
from neural_shadows.running.stage import run_stage
from neural_shadows.sections.frame_tables import FramesTable
from neural_shadows.settings.records import Run

if TYPE_CHECKING:
    from neural_shadows.frames.frame_set import FrameSetPart

FEATURE = "penumbra"
TOLD = 0.5  # pixels: what is narrower is no more than the edge of a hard shadow
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
    """A row for each light but points, and one for all of them.

    CSV: those of `feature_table`, `radius`, its unit, and the scale.

    Args:
        parts: of test frames.

    Raises:
        InputError: a part is missing, not whole, or has no channel that the feature is made of.
    """
    from neural_shadows.frames.frame_set import FrameSetPart

    opened = [FrameSetPart(path) for path in parts]
    about = opened[0].about
    unit = UNITS[about.get("radius_unit", "metres")]
    radii = about.get("given_radii", about["radii"])
    table = feature_table(sum(map(told_pixels, opened)))
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
        f"{PAPER} (4.1): z_b is the distance to what hides the light's centre, and the point's own "
        "where nothing does, so that p is 0 there: also in the outer half of each penumbra. Of what "
        "is wholly lit it is told where a texel of the light's map says otherwise.",
        phrases.describe_run(run),
    ]
    return Table(title, table, columns, notes)


def told_pixels(part: "FrameSetPart") -> np.ndarray:
    """How many pixels of a part's frames there are, and of how many p exceeds `TOLD`: (radii, 3, 2) by
    light and `WHERE`.
    """
    from neural_shadows.frames.kernel_features import MADE_OF, PENUMBRA_PIXELS, kernel_feature
    from neural_shadows.frames.light_size import light_size

    found = np.zeros((len(part.radii), len(WHERE), 2), np.int64)
    for number in range(len(part)):
        buffers = {name: part.image(number, name) for name in MADE_OF[FEATURE]}
        valid, lens = part.valid[number, 0], part.lens(number)
        for k, radius in enumerate(part.radii):
            light = light_size(radius, max(part.radii), part.about["size"])
            told = PENUMBRA_PIXELS * kernel_feature(FEATURE, buffers, lens, light) > TOLD
            exact = part.targets[number, k]
            lit, umbra = exact > LIT, exact < UMBRA
            for place, pixels in zip(found[k], (lit, ~(lit | umbra), umbra)):
                place += (pixels & valid).sum(), (pixels & valid & told).sum()
    return np.where(np.array(part.radii)[:, None, None] > 0, found, 0)


def feature_table(counts: np.ndarray) -> pd.DataFrame:
    """A row for each light with pixels, and one for all.

    Columns: `light`, its number or `all`; by `WHERE` the pixels there, and of what share of them p
    exceeds `TOLD` (`lit_share` …), NaN of none.

    Args:
        counts: see `told_pixels`.
    """
    rows = {k: one for k, one in enumerate(counts) if one.any()} | {"all": counts.sum(axis=0)}
    records = []
    for light, one in rows.items():
        pixels, told = one.T
        shares = told / np.where(pixels, pixels, np.nan)
        named = {f"{where}_share": share for where, share in zip(WHERE, shares)}
        records.append({"light": light, **dict(zip(WHERE, pixels)), **named})
    return pd.DataFrame(records)


if "snakemake" in globals():
    run_stage(snakemake, table, write_table)
