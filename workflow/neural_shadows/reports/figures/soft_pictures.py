"""A frame by methods for soft shadows, with their errors."""

import sys
from collections.abc import Iterable, Mapping, Sequence
from pathlib import Path
from typing import Any, Literal

from pydantic import Field

from neural_shadows.layout import frame_sets, kinds
from neural_shadows.layout.layout import Layout
from neural_shadows.layout.tables import frame_set, unique
from neural_shadows.reports.data.lights import shown_radii
from neural_shadows.reports.drawing.style import Figure
from neural_shadows.reports.tables import soft_methods, soft_summary
from neural_shadows.sections.frame_sets import measured_scenes
from neural_shadows.sections.sections import Sections
from neural_shadows.sections.table_figures import RadiiFigure
from neural_shadows.settings.base import check_among, name_in


class Settings(RadiiFigure):
    """A scene with two boxes, and these enlarged by each method, with errors.

    The page compares the methods under the least light, the middle one and the largest.
    """

    tables = (soft_methods.Settings, soft_summary.Settings)
    kind: Literal["soft_pictures"] = Field(description="`soft_pictures`")
    scene: name_in("scenes") = Field(description="its first test frame is shown")
    methods: list[str] = Field(min_length=1, description="methods of the table")
    radii: list[int] | None = Field(
        None,
        min_length=1,
        description="numbers of radii, counted from 0; by default the least but a point light, the "
        "middle and the largest",
    )

    def check(self, config: Sections, key: str) -> None:
        super().check(config, key)
        table = config.tables[self.table]
        scenes = measured_scenes(config.frame_sets[table.frame_set])
        check_among(f"{key}.scene", self.scene, scenes)
        for method in self.methods:
            check_among(f"{key}.methods", method, table.methods_shown())

    def resolved(self, config: Sections) -> dict[str, Any]:
        frames = config.frame_sets[config.tables[self.table].frame_set]
        return self.model_dump() | {"radii": self.radii or shown_radii(frames.radii)}


def files(layout: Layout, figure: str) -> dict[str, Any]:
    settings = layout.entry("figures", figure)
    frames = frame_set(layout, settings["table"])
    return {"part": frame_sets.parts(layout, settings["scene"], frames, "test")[0]}


def shown(layout: Layout) -> list[dict[str, Any]]:
    """The frames of this kind's figures, for `soft_comparisons`."""
    frames = []
    for name in _of_this_kind(layout, layout.settings["figures"]):
        settings = layout.entry("figures", name)
        table = settings["table"]
        count = len(layout.frames(frame_set(layout, table))["radii"])
        frames.append(
            {
                "table": table,
                "title": layout.entry("tables", table)["title"],
                "frame_set": frame_set(layout, table),
                "scene": settings["scene"],
                "labels": kinds.params(layout, "figures", name)["labels"],
                "radii": sorted({0, count // 2, count - 1}),
            }
        )
    return frames


def shown_files(layout: Layout, figures: Iterable[str]) -> dict[str, list[str]]:
    """The files of this kind's figures, each once."""
    inputs = [kinds.files(layout, "figures", name) for name in _of_this_kind(layout, figures)]
    return {
        "soft_parts": unique(paths["part"] for paths in inputs),
        "soft_answers": unique(path for paths in inputs for path in paths["soft_answers"]),
    }


def _of_this_kind(layout: Layout, figures: Iterable[str]) -> list[str]:
    this = sys.modules[__name__]
    return [name for name in figures if kinds.kind_of(layout, "figures", name) is this]


def draw(
    part: Path,
    soft_answers: list[Path],
    heading: str,
    labels: Mapping[str, str],
    radii: Sequence[int],
) -> Figure:
    """Draw a part's first frame by each method and radius.

    Args:
        part: of a frame set, see `FrameSetPart`; soft_answers: of each method, by file name.
        labels: of the methods, in the order to draw them; radii: their numbers, counted from 0.
    """
    from neural_shadows.reports.data.soft_pictures import read_pictures
    from neural_shadows.reports.drawing.soft_sheet import crop_sheet

    paths = {path.stem: path for path in soft_answers}
    pictures = read_pictures(part, {method: paths[method] for method in labels}, radii)
    return crop_sheet(pictures, labels, heading, part.parent.name)
