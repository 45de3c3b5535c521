"""`figures`: the figures of a run, by kind."""

from typing import Annotated, Literal

from pydantic import Field

from neural_shadows.config.base import Model, Name


class PicturesFigure(Model):
    """The same viewpoints by every method, whole and as crops [figures 4.4 to 4.7]."""

    kind: Literal["pictures"] = Field(description="`pictures`")
    title: str = Field(min_length=1, description="heading of the figure")
    table: str = Field(
        description="a table of `comparison` or `networks` in `tables`; its rows are drawn"
    )
    scene: Name | None = Field(
        None, description="which scene of a table of `networks`; needed there alone"
    )
    methods: list[str] | None = Field(
        None, min_length=1, description="which of the table's methods; without it all are drawn"
    )
    view_sets: list[Literal["shadow", "surface", "centre"]] = Field(
        min_length=1, description="view sets of the table's evaluations; the first view of each"
    )


class Curve(Model):
    """A curve of a figure of training losses."""

    experiment: Name = Field(description="a name in `experiments`")
    label: str = Field(min_length=1, description="the curve's name in the figure")


class LossFigure(Model):
    """Training loss over steps [figures 4.1 to 4.3]."""

    kind: Literal["loss"] = Field(description="`loss`")
    title: str = Field(min_length=1, description="heading of the figure")
    curves: list[Curve] = Field(min_length=1, description="curves, in the legend's order")


class WidthsFigure(Model):
    """LPIPS and frame time over layer width [figure 4.8]."""

    kind: Literal["widths"] = Field(description="`widths`")
    title: str = Field(min_length=1, description="heading of the figure")
    table: str = Field(description="a table of `frame_times` in `tables`")


class MethodFigure(Model):
    """A picture of how the method works, from real data [figures 3.1 to 3.6]."""

    kind: Literal[
        "overview",
        "shadow_boundary",
        "view_directions",
        "quadtree",
        "dual_bounds",
        "dead_zone_loss",
    ] = Field(description="what is drawn")
    title: str = Field(min_length=1, description="heading of the figure")
    scene: Name = Field(description="a name in `scenes`")
    sampling: Name = Field(description="a name in `samplings`")


class FrontsFigure(Model):
    """LPIPS over bytes, frame time and training time, with the best of each trade-off joined."""

    kind: Literal["fronts"] = Field(description="`fronts`")
    title: str = Field(min_length=1, description="heading of the figure")
    table: str = Field(description="a table of `networks` in `tables`")
    scene: Name = Field(description="a scene of that table")


class CostFigure(Model):
    """Time and memory of each stage over each size."""

    kind: Literal["cost"] = Field(description="`cost`")
    title: str = Field(min_length=1, description="heading of the figure")
    table: str = Field(description="a table of `cost` in `tables`")


class FieldSliceFigure(Model):
    """A slice through an occupancy field's logits, beside the mesh that it learned."""

    kind: Literal["field_slice"] = Field(description="`field_slice`")
    title: str = Field(min_length=1, description="heading of the figure")
    experiment: Name = Field(description="an experiment whose network is an `occupancy_field`")


Figure = Annotated[
    PicturesFigure
    | LossFigure
    | WidthsFigure
    | FrontsFigure
    | CostFigure
    | FieldSliceFigure
    | MethodFigure,
    Field(discriminator="kind"),
]
