"""What figures of tables have in common."""

from typing import Any, ClassVar

from pydantic import Field

from neural_shadows.evaluation.method_names import RAY_TRACED
from neural_shadows.evaluation.null_predictors import is_null
from neural_shadows.sections.any_report import AnyFigure, AnyTable
from neural_shadows.sections.own_frames import OwnFrames
from neural_shadows.sections.rows import Row
from neural_shadows.sections.sections import Sections
from neural_shadows.settings.base import Name, check_among


class TableFigure(AnyFigure):
    """A figure of a table of some kinds, which `tables` are the settings of."""

    tables: ClassVar[tuple[type[AnyTable], ...]] = ()

    table: Name = Field(description="a name in `tables`, of a kind that it draws")

    def check(self, config: Sections, key: str) -> None:
        drawn = [name for name, one in config.tables.items() if isinstance(one, self.tables)]
        check_among(f"{key}.table", self.table, drawn)


class RowsFigure(TableFigure):
    """A figure of the rows of one scene of such a table."""

    scene: Name | None = Field(None, description="which scene of a table of several")

    def all_rows(self, config: Sections) -> list[Row]:
        """The rows of its scene that it can show."""
        rows = config.tables[self.table].resolved_rows(config)
        return [row for row in rows if row["scene"] == self.scene_of(config)]

    def rows(self, config: Sections) -> list[Row]:
        """The rows that it shows."""
        return self.all_rows(config)

    def scene_of(self, config: Sections) -> str:
        """The scene that it names, or the table's first."""
        return self.scene or config.tables[self.table].resolved_rows(config)[0]["scene"]

    def check(self, config: Sections, key: str) -> None:
        super().check(config, key)
        rows = config.tables[self.table].resolved_rows(config)
        scenes = list(dict.fromkeys(row["scene"] for row in rows))
        if self.scene is not None or len(scenes) > 1:
            check_among(f"{key}.scene", self.scene or "", scenes)

    def resolved(self, config: Sections) -> dict[str, Any]:
        found = {"rows": self.rows(config), "scene": self.scene_of(config)}
        return self.model_dump() | found


class MethodsFigure(RowsFigure):
    """A figure of methods of one scene, side by side."""

    methods: list[str] | None = Field(
        None, min_length=1, description="which of its rows; NAME_biased with a bias of its own"
    )

    def all_rows(self, config: Sections) -> list[Row]:
        # Ray tracing's pictures are the reference, shown anyway; null predictors' show nothing.
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
    """A figure of methods on rendered frames, at some radii."""

    radii: list[int] | None = Field(None, min_length=1, description="which radii, counted from 0")

    def check(self, config: Sections, key: str) -> None:
        super().check(config, key)
        frame_set = config.tables[self.table].frame_set
        frames = config.frame_sets[frame_set]
        if isinstance(frames, OwnFrames):
            raise ValueError(f"{key}.table: {self.table!r} is of frames of a user's own")
        for k in self.radii or []:
            if not 0 <= k < len(frames.radii):
                raise ValueError(
                    f"{key}.radii: {k} is not among 0 to {len(frames.radii) - 1}, the radii of "
                    f"{frame_set!r} counted from 0"
                )
