"""`tables`: those of methods for soft shadows, by kind."""

from typing import TYPE_CHECKING, Literal

from pydantic import Field, model_validator

from neural_shadows.config.any_table import AnyTable
from neural_shadows.config.base import Model, Name, Text, check_among, name_in, section_or
from neural_shadows.config.own_frames import OwnFrames
from neural_shadows.config.screen_tables import ScreenTemporalTable
from neural_shadows.evaluation.soft_method_names import BASE, LABELS, NULL, is_network

if TYPE_CHECKING:
    from neural_shadows.config.whole import Config


class SoftMethodsTable(AnyTable):
    """A table of methods for soft shadows on a frame set: errors, flicker, time, bytes, by radius."""

    kind: Literal["soft_methods"] = Field(description="`soft_methods`")
    frame_set: name_in("frame_sets") = Field(description="a name in `frame_sets`")
    methods: list[Name] = Field(
        min_length=1,
        description="keys of evaluation/soft_method_names.py, in the table's order; `no_shadow` "
        "and `all_dark` are there without being named",
    )

    @property
    def asked(self) -> list[str]:
        """Its methods."""
        return self.methods


class SummaryRow(Model):
    """A row of a summary that is more than a name."""

    method: Name = Field(description="as those of `soft_methods`")
    label: Text | None = Field(None, description="without it the method's own label")
    published: Name | None = Field(None, description="its row in published_kpnsm.csv")
    column: Name | None = Field(
        None,
        description="its column there, of the first metric; without it they are called as the metrics",
    )


class SoftSummaryTable(AnyTable):
    """A table of methods for soft shadows over all lights together, beside printed numbers."""

    kind: Literal["soft_summary"] = Field(description="`soft_summary`")
    published: str | None = Field(
        None, pattern=r"^kpnsm\.[1-4]$", description="`kpnsm.` and the paper's number of this table"
    )
    frame_set: name_in("frame_sets") = Field(description="a name in `frame_sets`")
    methods: list[section_or(SummaryRow, "method")] = Field(
        min_length=1, description="in the table's order"
    )
    over: Literal["trained", "unseen"] = Field(
        "trained", description="whose test frames: those of the set's `scenes` or of its `unseen`"
    )
    by: Literal["scene", "radius"] | None = Field(
        None, description="a part of the table for each; without it one row a method"
    )
    metrics: list[Literal["mse", "ssim", "time", "temporal_error"]] = Field(
        ["mse", "ssim"],
        min_length=1,
        description="`temporal_error` is of sequences, of the set's first scene",
    )

    @model_validator(mode="after")
    def _check_metrics(self):
        if self.by and (wrong := {"time", "temporal_error"} & set(self.metrics)):
            raise ValueError(f"metrics: {min(wrong)} is not to be had by {self.by}")
        return self

    @property
    def asked(self) -> list[str]:
        """Its methods."""
        return [row.method for row in self.methods]


class PenumbraTable(AnyTable):
    """Widths of penumbrae: what is measured beside models, or what networks are told, and where."""

    kind: Literal["penumbra_widths", "penumbra_feature"] = Field(
        description="measured widths beside those of Neural Shadow Mapping's model (3.6); or in which "
        "pixels networks of kernels are told of one (Hu et al. 2025, 4.1)"
    )
    frame_set: name_in("frame_sets") = Field(description="a name in `frame_sets`")


def check_soft(
    config: "Config", key: str, table: SoftMethodsTable | SoftSummaryTable | ScreenTemporalTable
) -> None:
    """Check that a table's methods are known, and can be asked about its frames, which it needs.

    Raises:
        ValueError: one is not, or cannot.
    """
    frames = config.frame_sets[table.frame_set]
    own = isinstance(frames, OwnFrames)
    known = [*LABELS, *config.screen_experiments, *config.networks_by_scene]
    for method in table.asked:
        check_among(f"{key}.methods", method, known)
        if table.asked.count(method) > 1:
            raise ValueError(f"{key}.methods: {method!r} is there twice; should be there once")
        if own and not (method.startswith(BASE) or method in NULL or is_network(method)):
            raise ValueError(
                f"{key}.methods: {method!r} needs a scene to look at, and frames of a user's own have "
                f"none; allowed: {', '.join(name for name in LABELS if name.startswith(BASE))}, and "
                "networks"
            )
    if isinstance(table, SoftSummaryTable):
        if table.over == "unseen" and not getattr(frames, "unseen", ()):
            raise ValueError(f"{key}.over: frame_sets.{table.frame_set} has no `unseen`")
    temporal = isinstance(table, ScreenTemporalTable) or "temporal_error" in getattr(
        table, "metrics", ()
    )
    if temporal and not getattr(frames, "sequence", 0):
        raise ValueError(f"{key}.frame_set: frame_sets.{table.frame_set} has sequence = 0")
