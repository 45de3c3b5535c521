"""Claims on methods of scenes' viewpoints."""

from collections.abc import Sequence
from typing import Any, ClassVar

from neural_shadows.evaluation.method_names import is_classic, unbiased
from neural_shadows.evaluation.null_predictors import is_null
from neural_shadows.layout import tables
from neural_shadows.layout.layout import Layout
from neural_shadows.reports.claims.claim_kinds import methods
from neural_shadows.reports.claims.measured import Claim
from neural_shadows.reports.data.trained import Row
from neural_shadows.sections.any_report import AnyClaim
from neural_shadows.sections.row_settings import RowSettings
from neural_shadows.sections.rows import row_of
from neural_shadows.sections.sections import Sections
from neural_shadows.settings.base import check_among


class RowsClaim(AnyClaim):
    """A claim on pairs of methods of scenes' viewpoints."""

    rows_key: ClassVar[str] = "pairs"  # of its methods

    def compared(self) -> list[list[str]]:
        """The methods by comparison."""
        return self.pairs

    def check(self, config: Sections, key: str) -> None:
        key = f"{key}.{self.rows_key}"
        for names in self.compared():
            for name in names:
                self.check_method(config, key, name)
            if all(is_classic(unbiased(name)) for name in names):
                raise ValueError(f"{key}: {names}: no experiment among them. Add one")
            if len(set(names)) < len(names):
                raise ValueError(f"{key}: {names[0]!r} is compared with itself. Name two methods")

    def check_method(self, config: Sections, key: str, method: str) -> None:
        """Check one method alone."""
        name = unbiased(method)
        if is_null(name) and name != method:
            raise ValueError(
                f"{key}: {method!r}: a null predictor has no depth bias. Write {name!r}"
            )
        if not is_classic(name):
            check_among(key, name, config.experiments)

    def resolved(self, config: Sections) -> dict[str, Any]:
        return super().resolved(config) | {
            "pairs": [compared_rows(config, names) for names in self.compared()]
        }


def compared_rows(config: Sections, names: Sequence[str]) -> list[Row]:
    """Compared methods as rows, maps on a network's scene."""
    keys = [unbiased(name) for name in names]
    scenes = [config.experiments[key].scene for key in keys if key in config.experiments]
    rows = []
    for key, name in zip(keys, names):
        row = RowSettings(method=key, bias=None if key == name else "held_out")
        experiment = config.experiments.get(key)
        rows.append(row_of(config, experiment.scene if experiment else scenes[0], row))
    return rows


def compared_in_pairs(claim: Claim) -> list[Sequence[Row]]:
    """The pairs of a claim."""
    return claim["pairs"]


def row_files(layout: Layout, rows: Sequence[Row]) -> dict[str, list[str]]:
    """Trainings and meshes of rows."""
    scenes = tables.unique(row["scene"] for row in rows)
    return {
        "trainings": tables.networks(layout, rows, "training.json"),
        "meshes": [layout.paths.scene("mesh.json", scene) for scene in scenes],
    }


def picture_files(layout: Layout, claim: Claim) -> dict[str, list[str]]:
    """Files of a claim on images, with those without shadow."""
    rows = tables.with_curves(layout, methods(claim))
    null = tables.unshadowed(tables.unique(row["scene"] for row in rows))
    return row_files(layout, rows) | {"metrics": tables.metrics(layout, [*rows, *null])}
