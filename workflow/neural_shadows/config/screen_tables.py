"""`tables`: those of networks that answer whole frames, by kind."""

from typing import Literal

from pydantic import Field

from neural_shadows.config.any_table import AnyTable
from neural_shadows.config.base import Model, Name, name_in, section_or


class ScreenTable(AnyTable):
    """A table of networks of whole frames that needs no training (Datta et al. 2022, S3, S4.1)."""

    published: str | None = Field(
        None, pattern=r"^nsm\.s[2-5]$", description="`nsm.` and the paper's number of this table"
    )


class ScreenProfileTable(ScreenTable):
    """What each level of a network counts and takes, or the time of each part of it."""

    kind: Literal["screen_levels", "screen_parts"] = Field(description="by level, or by part, too")
    network: name_in("screen_networks") = Field(description="a name in `screen_networks`")


class ScreenRow(Model):
    """A row of a table of networks of whole frames that is more than a name."""

    network: name_in("screen_networks") = Field(description="a name in `screen_networks`")
    published: Name | None = Field(
        None, description="its row in published_nsm.csv, if not of `network`'s name"
    )


class ScreenNetworksTable(ScreenTable):
    """Multiply-adds and weights of several networks."""

    kind: Literal["screen_networks"] = Field(description="`screen_networks`")
    networks: list[section_or(ScreenRow, "network")] = Field(
        min_length=1, description="in the table's order"
    )


class ScreenTrainedTable(AnyTable):
    """A table of trained networks on frames, each in a column or row that the paper has."""

    published: str | None = Field(
        None, pattern=r"^nsm\.(1|s1)$", description="`nsm.` and the paper's number of this table"
    )
    kind: Literal["screen_depth", "screen_features"] = Field(
        description="depths against widths of penumbrae, or sets of features"
    )
    frame_set: name_in("frame_sets") = Field(description="whose test frames they are asked about")
    columns: dict[Name, name_in("screen_experiments")] = Field(
        min_length=1, description="a name in `screen_experiments` for each name that the paper has"
    )

    @property
    def asked(self) -> list[str]:
        """Its networks."""
        return [*self.columns.values()]


class Step(Model):
    """A step on the way to a fast network."""

    network: name_in("screen_networks") = Field(description="a name in `screen_networks`: timed")
    precision: Literal["float32", "bfloat16"] = Field(
        description="of its weights, its time and its error"
    )
    experiment: name_in("screen_experiments") | None = Field(
        None, description="a name in `screen_experiments`: its error, in this precision"
    )


class ScreenStepsTable(AnyTable):
    """A table from a large network of whole frames to a fast one (Datta et al. 2022, 3.5)."""

    published: Literal["nsm.steps"] | None = Field(
        None, description="`nsm.steps`, the numbers that this paper prints of its steps"
    )
    kind: Literal["screen_steps"] = Field(description="`screen_steps`")
    frame_set: name_in("frame_sets") = Field(description="whose test frames they are asked about")
    steps: dict[Name, Step] = Field(min_length=1, description="by the paper's names, in order")

    @property
    def asked(self) -> list[str]:
        """Its networks."""
        return [step.experiment for step in self.steps.values() if step.experiment]


class ScreenErrorsTable(AnyTable):
    """A table of networks' errors, on what they learned from and on what not, or behind what."""

    kind: Literal["screen_errors", "screen_solids"] = Field(
        description="by scene and light, beside those on what they learned from, or by how many solids "
        "lie before the light"
    )
    frame_set: name_in("frame_sets") = Field(description="whose test frames they are asked about")
    networks: list[name_in("screen_experiments")] = Field(
        min_length=1, description="names in `screen_experiments`, in the table's order"
    )

    @property
    def asked(self) -> list[str]:
        """Its networks."""
        return self.networks


class ScreenTemporalTable(AnyTable):
    """A table of how much methods flicker on a frame set's sequences, with and without TAA."""

    kind: Literal["screen_temporal"] = Field(description="`screen_temporal`")
    frame_set: name_in("frame_sets") = Field(description="a name in `frame_sets`")
    methods: list[Name] = Field(
        min_length=1, description="as those of `soft_methods`, in the table's order"
    )

    @property
    def asked(self) -> list[str]:
        """Its methods."""
        return self.methods
