"""Errors beside the exact shadow at pixels' centres: what of an error is antialiasing."""

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any, Literal

import numpy as np
import pandas as pd
from pydantic import Field

from neural_shadows.layout import tables
from neural_shadows.layout.layout import Layout
from neural_shadows.reports.data.frame_means import OFF_EDGES, describe_units, mean_with_interval
from neural_shadows.reports.data.lights import light_names, radii_of, unit_of
from neural_shadows.reports.data.quality_cells import metric_column
from neural_shadows.reports.data.table import Table
from neural_shadows.sections.frame_tables import MethodsTable, OfScenes
from neural_shadows.sections.sections import Sections
from neural_shadows.settings.base import Name

EXACT = "exact_centre"
FROM_CENTRE = "centre_off_edges"


class Settings(MethodsTable):
    """Errors of methods off edges, beside the target and beside the exact shadow at pixels' centres."""

    kind: Literal["centre_errors"] = Field(description="`centre_errors`")
    methods: list[Name] = Field(
        min_length=2, description="as those of `soft_methods`, `exact_centre` among them"
    )
    over: OfScenes = "trained"

    def methods_shown(self) -> list[str]:
        return self.methods

    def check(self, config: Sections, key: str) -> None:
        super().check(config, key)
        if EXACT not in self.methods:
            raise ValueError(f"{key}.methods: lacks {EXACT}, which the others are compared with")


def params(layout: Layout, table: str) -> dict[str, Any]:
    return {"measured": tables.shown_scenes(layout, table)}


def table(
    first_parts: list[Path],
    soft_answers: list[Path],
    labels: Mapping[str, str],
    measured: Sequence[str],
) -> Table:
    """Tabulate errors by light and method.

    CSV: `number` and `radius` of the light, `method, label`, `mse_off_edges` beside the target and
    `centre_off_edges` beside the exact shadow at pixels' centres, with their intervals; the radii's unit, and
    the scale.

    Args:
        first_parts: of test frames, of each scene; soft_answers: of each method, by file name.
        labels: by method; measured: the scenes whose frames count.
    """
    from neural_shadows.frames.frame_set import FrameSetPart

    parts = [part for part in first_parts if part.parent.name in measured]
    about = FrameSetPart(parts[0]).about
    radii, unit = radii_of(about), unit_of(about)
    paths = {path.stem: path for path in soft_answers}
    errors = pd.concat([_errors(part, paths, len(radii)) for part in parts])
    rows = [
        {"number": k, "radius": radius, "method": method, "label": label}
        | mean_with_interval(own["target"], OFF_EDGES)
        | mean_with_interval(own["centre"], FROM_CENTRE)
        for k, radius in enumerate(radii)
        for method, label in labels.items()
        for own in [errors.query("method == @method and number == @k")]
    ]
    found = pd.DataFrame(rows).assign(unit=unit)
    lights = light_names(about)
    cells = {
        "light": [lights[k] for k in found["number"]],
        "method": found["label"],
        "off edges": metric_column(found, OFF_EDGES, interval=True, digits=2),
        "beside the centre's": metric_column(
            found, OFF_EDGES, FROM_CENTRE, interval=True, digits=2
        ),
    }
    scenes = [part.parent.name for part in parts]
    notes = [
        f"First test frames of {', '.join(scenes)} [{describe_units(scenes, len(scenes))}], answers in steps of "
        "1/255; pixels in which all eight sample points see one surface.",
        "The target is antialiased, also at edges of shadows on one surface. *Beside the centre's*: squared "
        "difference from the exact shadow at the pixel's centre in the target's place, which is not. A method "
        "that antialiases, such as a network trained on such targets, has an error there.",
    ]
    return Table(found, cells, notes, text_columns=2)


def _errors(part: Path, answers: Mapping[str, Path], lights: int) -> pd.DataFrame:
    """Mean squared errors of a part's first frame, `target` and `centre`, by scene, `method` and `number`."""
    from neural_shadows.reports.data.soft_pictures import read_pictures

    pictures = read_pictures(part, answers, range(lights))
    mask, centre = pictures.smooth, pictures.answers[EXACT]
    rows = [
        {
            "scene": part.parent.name,
            "method": method,
            "number": k,
            "target": np.square(answer[k] - pictures.exact[k])[mask].mean(dtype=np.float64),
            "centre": np.square(answer[k] - centre[k])[mask].mean(dtype=np.float64),
        }
        for method, answer in pictures.answers.items()
        for k in range(lights)
    ]
    return pd.DataFrame(rows).set_index("scene")
