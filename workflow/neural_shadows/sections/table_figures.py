"""Base classes of figures of tables."""

from typing import Any, ClassVar

from pydantic import Field

from neural_shadows.evaluation.null_predictors import is_null
from neural_shadows.evaluation.registry import RAY_TRACED
from neural_shadows.sections.any_report import AnyFigure, AnyTable
from neural_shadows.sections.own_frames import OwnFrames
from neural_shadows.sections.rows import Row
from neural_shadows.sections.sections import Sections
from neural_shadows.settings.base import Name, check_among


class TableFigure(AnyFigure):
    """Figure of a table of the kinds in `tables`."""

    tables: ClassVar[tuple[type[AnyTable], ...]] = ()

    table: Name = Field(description="a name in `tables`, of a kind supported by the figure")

    def check(self, config: Sections, key: str) -> None:
        drawn = [name for name, table in config.tables.items() if isinstance(table, self.tables)]
        check_among(f"{key}.table", self.table, drawn)


class RowsFigure(TableFigure):
    """Figure of a table's rows of one scene."""

    scene: Name | None = Field(None, description="a scene of the table; needed if it has several")

    def all_rows(self, config: Sections) -> list[Row]:
        """Drawable rows of the scene."""
        rows = config.tables[self.table].resolved_rows(config)
        return [row for row in rows if row["scene"] == self.scene_of(config)]

    def rows(self, config: Sections) -> list[Row]:
        """Rows of the figure."""
        return self.all_rows(config)

    def scene_of(self, config: Sections) -> str:
        """Configured scene, or the table's first."""
        return self.scene or config.tables[self.table].resolved_rows(config)[0]["scene"]

    def check(self, config: Sections, key: str) -> None:
        super().check(config, key)
        rows = config.tables[self.table].resolved_rows(config)
        scenes = list(dict.fromkeys(row["scene"] for row in rows))
        if self.scene is not None or len(scenes) > 1:
            check_among(f"{key}.scene", self.scene or "", scenes)

    def resolved(self, config: Sections) -> dict[str, Any]:
        return self.model_dump() | {"rows": self.rows(config), "scene": self.scene_of(config)}


class MethodsFigure(RowsFigure):
    """Figure of methods on one scene, side by side."""

    methods: list[str] | None = Field(
        None,
        min_length=1,
        description="keys of rows to draw; NAME_biased for a row with `bias`; default: all",
    )

    def all_rows(self, config: Sections) -> list[Row]:
        # Without ray tracing, the reference itself, and null predictors, which are uniform.
        rows = super().all_rows(config)
        return [row for row in rows if row["method"] != RAY_TRACED and not is_null(row["method"])]

    def rows(self, config: Sections) -> list[Row]:
        rows = self.all_rows(config)
        return [row for row in rows if not self.methods or row["method"] in self.methods]

    def check(self, config: Sections, key: str) -> None:
        super().check(config, key)
        drawn = [row["method"] for row in self.all_rows(config)]
        for method in self.methods or []:
            check_among(f"{key}.methods", method, drawn)


class RadiiFigure(TableFigure):
    """Figure of methods on rendered frames at some radii."""

    radii: list[int] | None = Field(
        None, min_length=1, description="numbers of radii, counted from 0"
    )

    def check(self, config: Sections, key: str) -> None:
        super().check(config, key)
        frame_set = config.tables[self.table].frame_set
        frames = config.frame_sets[frame_set]
        if isinstance(frames, OwnFrames):
            raise ValueError(
                f"{key}.table: {self.table!r} evaluates a user's own frames. Choose a table on rendered frames"
            )
        for k in self.radii or []:
            if not 0 <= k < len(frames.radii):
                raise ValueError(
                    f"{key}.radii: {k} is not among 0 to {len(frames.radii) - 1}, the radii of "
                    f"{frame_set!r} counted from 0"
                )
