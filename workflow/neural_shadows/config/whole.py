"""The whole configuration, with kinds of tables, figures and claims.

`python -m neural_shadows.config` prints its JSON schema (workflow/schemas/config.schema.json).
"""

from pydantic import Field, model_validator

from neural_shadows.config.checks import (
    experiments,
    frame_sets,
    learning_curves,
    networks_by_scene,
    printed_rows,
    scenes,
    viewers,
)
from neural_shadows.sections.sections import FigureName, Sections
from neural_shadows.settings.base import Name
from neural_shadows.settings.kinds import union

Table = union("reports/tables", default="comparison")
Figure = union("reports/figures")
Claim = union("reports/claims/kinds")

# Folders of the default scale, with which an overlay's folder of this name would collide.
RESERVED_SCALES = {
    *("scenes", "rays", "networks", "references", "violations", "evaluations", "constants"),
    *("times", "logs", "benchmarks", "reference"),
    *("frames", "imported_frames", "frame_measures"),
    *("screen_profiles", "screen_sensitivities", "soft_fields", "sun_hours", "answers"),
}
RESERVED_TABLES = ("claims", "expected_minutes", "index", "manifest")


class Config(Sections):
    """The whole configuration."""

    tables: dict[Name, Table] = Field({}, description="tables, by name")
    figures: dict[FigureName, Figure] = Field(
        {}, description="figures to draw, by name: `figure_` and the thesis's number"
    )
    claims: dict[Name, Claim] = Field({}, description="conclusions to be judged, by name")

    @model_validator(mode="after")
    def _check(self):
        if self.scale in RESERVED_SCALES:
            raise ValueError(f"scale = {self.scale!r}: is a folder of results. Choose another name")
        for section in (
            scenes,
            frame_sets,
            experiments,
            networks_by_scene,
            learning_curves,
        ):
            section.check(self)
        for name in self.tables:
            if name in RESERVED_TABLES:
                raise ValueError(f"tables.{name}: a report has this name. Choose another")
        for section in ("tables", "figures"):
            for name, entry in getattr(self, section).items():
                entry.check(self, f"{section}.{name}")
        printed_rows.check(self)
        viewers.check(self)
        for name, claim in self.claims.items():
            claim.check(self, f"claims.{name}")
        return self
