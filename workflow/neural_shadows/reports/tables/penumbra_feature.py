"""Pixels with a penumbra feature, by visibility (Hu et al. 2025, 4.1)."""

from pathlib import Path
from typing import TYPE_CHECKING, Literal

import numpy as np
import pandas as pd
from pydantic import Field

from neural_shadows.metrics.kinds.errors_of_visibility import LIT, UMBRA
from neural_shadows.reports.data.lights import light_name, radii_of, unit_of
from neural_shadows.reports.data.phrases import TEXTS
from neural_shadows.reports.data.table import Table, numbers
from neural_shadows.sections.frame_tables import FramesTable

if TYPE_CHECKING:
    from neural_shadows.frames.frame_set import FrameSetPart

FEATURE = "penumbra"
TOLD = 0.5  # pixels: narrower penumbrae are edges of hard shadows
WHERE = ("lit", "penumbra", "umbra")


class Settings(FramesTable):
    """Pixels with a penumbra in the features of kernel networks (Hu et al. 2025, 4.1)."""

    kind: Literal["penumbra_feature"] = Field(description="`penumbra_feature`")


def table(test_parts: list[Path]) -> Table:
    """Tabulate shares of pixels by area light, and over all lights.

    CSV: those of `feature_table`, `radius`, its unit, and the scale.

    Args:
        test_parts: parts of test frames.
    """
    from neural_shadows.frames.frame_set import FrameSetPart

    opened = [FrameSetPart(path) for path in test_parts]
    unit, radii = unit_of(opened[0].about), radii_of(opened[0].about)
    table = feature_table(sum(map(feature_pixels, opened)))
    table["radius"] = [radii[row] if row != "all" else np.nan for row in table["light"]]
    table = table.assign(unit=unit)
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
        f"{TEXTS['kpnsm']} (4.1): z_b is the distance of the occluder of the light's centre. Without one it is the "
        "point's own and p is 0, also in the outer half of each penumbra. Fully lit pixels have p > 0 "
        "at wrong texels of the light map.",
    ]
    return Table(table, columns, notes)


def feature_pixels(part: "FrameSetPart") -> np.ndarray:
    """Count the pixels of a part's frames, and those with p above `TOLD`.

    Returns: (radii, 3, 2) by light and `WHERE`.
    """
    from neural_shadows.frames.feature_names import buffers_of
    from neural_shadows.frames.kernel_features import PENUMBRA_PIXELS, kernel_feature

    counts = np.zeros((len(part.radii), len(WHERE), 2), np.int64)
    for number in range(len(part)):
        buffers = {name: part.image(number, name) for name in buffers_of([FEATURE])}
        valid, lens = part.valid[number, 0], part.lens(number)
        for k, radius in enumerate(part.radii):
            feature = kernel_feature(FEATURE, buffers, lens, part.light_size(radius))
            wide = PENUMBRA_PIXELS * feature > TOLD
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
