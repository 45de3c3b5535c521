"""Tables of methods on scenes, and their resolved rows."""

from collections import Counter
from typing import Any, ClassVar

from pydantic import Field

from neural_shadows.evaluation.null_predictors import is_null
from neural_shadows.evaluation.registry import (
    PATTERNS,
    RAY_TRACED,
    biased_key,
    is_classic,
    method_of,
)
from neural_shadows.sections.any_report import AnyTable
from neural_shadows.sections.experiments import RAYS
from neural_shadows.sections.row_settings import Rows, RowSettings
from neural_shadows.sections.scenes import MeshName
from neural_shadows.sections.sections import Sections
from neural_shadows.settings.base import check_among, of_another_kind
from neural_shadows.settings.records import Row


class RowsTable(AnyTable):
    """Common base of tables of methods on scenes."""

    null_rows: ClassVar[tuple[str, ...]] = ()  # added to each scene's rows
    timed: ClassVar[bool] = False  # may time ray tracing, the reference

    def named_rows(self, config: Sections) -> dict[str, list[RowSettings]]:
        """Configured rows by scene."""
        raise NotImplementedError

    def rows_by_scene(self, config: Sections) -> dict[str, list[RowSettings]]:
        """Rows by scene, including null predictors."""
        return {
            scene: [*rows, *self._missing_null_rows(rows)]
            for scene, rows in self.named_rows(config).items()
        }

    def _missing_null_rows(self, rows: list[RowSettings]) -> list[RowSettings]:
        named = {row.method for row in rows}
        return [RowSettings(method=key) for key in self.null_rows if key not in named]

    def resolved_rows(self, config: Sections) -> list[Row]:
        """Resolved rows; `published` is None if the table has no number."""
        return [
            row_of(config, scene, row)
            | {"published": (row.published or row.method) if self.published else None}
            for scene, rows in self.rows_by_scene(config).items()
            for row in rows
        ]

    def resolved(self, config: Sections) -> dict[str, Any]:
        return self.model_dump() | {"rows": self.resolved_rows(config)}

    def experiments_allowed(self, config: Sections) -> list[str]:
        """Experiments allowed as rows."""
        return list(config.ray_experiments)

    def check(self, config: Sections, key: str) -> None:
        """Check that rows are methods of their scene, without duplicates."""
        for scene, rows in self.rows_by_scene(config).items():
            if not scene:
                raise ValueError(f"{key}: has shadow maps only. Add `scene`")
            for row in rows:
                self._check_row(config, f"{key}.rows: of {scene}", scene, row)
            resolved = [row_of(config, scene, row) for row in rows]
            for part in ("method", "label"):
                for value, count in Counter(row[part] for row in resolved).items():
                    if count > 1:
                        raise ValueError(
                            f"{key}.rows: of {scene}: {value!r} is listed twice. List it once"
                        )
            against = getattr(self, "against", None)
            against = against.get(scene) if isinstance(against, dict) else against
            if against is not None:
                check_among(f"{key}.against", against, [row["method"] for row in resolved])

    def _check_row(self, config: Sections, key: str, scene: str, row: RowSettings) -> None:
        if row.bias is not None and is_null(row.method):
            raise ValueError(
                f"{key}: {row.method!r} is a null predictor and has no depth bias. Remove `bias`"
            )
        names = self.experiments_allowed(config)
        allowed = [name for name in names if config.ray_experiments[name].scene == scene]
        if row.method in config.screen_experiments:
            raise ValueError(f"{key}: {of_another_kind(row.method, RAYS, allowed)}")
        if row.method in names and row.method not in allowed:
            other = config.ray_experiments[row.method].scene
            raise ValueError(f"{key}: {row.method!r} has the scene {other!r}. Name one of {scene}")
        check_among(key, row.method, [*self.classic_allowed(row), *allowed])

    def classic_allowed(self, row: RowSettings) -> list[str]:
        """Methods without networks allowed in a row."""
        own = [row.method] * is_classic(row.method)
        timed = [RAY_TRACED] * (self.timed and row.bias is None)
        return [*own, *PATTERNS, *timed]


class TableOfOneScene(RowsTable):
    """Table of methods on one scene."""

    rows: Rows = Field(description="methods, in the table's order")
    scene: MeshName | None = Field(
        None, description="a mesh in `scenes`; default: that of the rows' experiments"
    )

    def check(self, config: Sections, key: str) -> None:
        if not self.scene and not any(row.method in config.ray_experiments for row in self.rows):
            for row in self.rows:  # a misspelt experiment has no scene
                allowed = [*self.classic_allowed(row), *self.experiments_allowed(config)]
                check_among(f"{key}.rows", row.method, allowed)
        super().check(config, key)

    def named_rows(self, config: Sections) -> dict[str, list[RowSettings]]:
        experiments = [config.ray_experiments.get(row.method) for row in self.rows]
        scenes = {experiment.scene for experiment in experiments if experiment}
        return {self.scene or min(scenes, default=""): self.rows}


class TableByScene(RowsTable):
    """Table of methods on several scenes."""

    rows: dict[MeshName, Rows] = Field(min_length=1, description="methods, by scene")

    def named_rows(self, config: Sections) -> dict[str, list[RowSettings]]:
        return self.rows


def row_of(config: Sections, scene: str, row: RowSettings) -> Row:
    """Resolve a row of a scene.

    Returns: `method`, the method's key; `label`; `published`, None; `scene`; `experiment` and the
        network's `encoding`, or None if it is none, and whether it is `trained`; `bias`, a number,
        `held_out`, or None if it has none.
    """
    method, own, label = row.method, None, row.label
    if experiment := config.ray_experiments.get(row.method):
        label, own = config.label_of(row.method, row.label), experiment.bias
    elif method == RAY_TRACED:
        label = label or "Ray traced"
    else:
        label = label or method_of(method).label
    bias = row.bias or own
    if bias != own:  # of a method whose own depth bias the row changes
        method = biased_key(method)
        label = label if row.label else f"{label}, with bias"
    return {
        "method": method,
        "label": label,
        "published": None,
        "scene": scene,
        "experiment": row.method if experiment else None,
        "encoding": config.network_of(row.method).encoding if experiment else None,
        "trained": bool(experiment and config.training_of(row.method)),
        "bias": bias,
    }
