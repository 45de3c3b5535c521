"""The typed configuration: what every key means, its unit and its range.

`python -m neural_shadows.config` prints the JSON schema made from it
(workflow/schemas/config.schema.json).
"""

import json
import reprlib
from collections.abc import Iterable
from pathlib import Path
from typing import Annotated, Any, ClassVar, Literal

import yaml
from pydantic import (
    BaseModel,
    ConfigDict,
    Discriminator,
    Field,
    Tag,
    ValidationError,
    model_validator,
)

from neural_shadows.cost_sizes import STAGES
from neural_shadows.errors import InputError
from neural_shadows.methods import (
    BIASED_SUFFIX,
    RAY_TRACED,
    SHADOW_MAP_PREFIX,
    biased_key,
    experiment_of,
    is_shadow_map,
    shadow_map_key,
)

Name = Annotated[str, Field(pattern=r"^[a-z][a-z0-9_]*$")]

# Folders below results/ and reports/, where an overlay's own folder of this name would mix with
# the default's files.
RESERVED_SCALES = {
    *("scenes", "rays", "networks", "evaluations", "frame_times", "cost"),
    *("logs", "benchmarks", "reference"),
}


class Model(BaseModel):
    """Base of all sections: unknown keys are refused, values are not converted silently."""

    model_config = ConfigDict(extra="forbid", strict=True, frozen=True, allow_inf_nan=False)


def _check_power_of_two(value: int, key: str) -> None:
    if value & (value - 1):
        raise ValueError(f"{key} = {value}: must be a power of two")


class GeneratedMesh(Model):
    """A mesh that the pipeline makes."""

    generate: str


class Wyrm(GeneratedMesh):
    """The procedural stand-in dragon."""

    generate: Literal["wyrm"] = Field(description="`wyrm`: a creature, the stand-in dragon")
    cells: int = Field(
        220, ge=48, le=1024, description="marching-cubes cells along the longest axis"
    )


class Fence(GeneratedMesh):
    """A panel of woven wire in a frame, standing on the ground [4.1.1]."""

    generate: Literal["fence"] = Field(description="`fence`: diagonally crossing round wires")
    wires: int = Field(16, ge=2, le=200, description="diamonds along the panel's width")
    wire_radius: float = Field(
        0.006, gt=0, le=0.1, description="radius of a wire, in widths of the panel"
    )


class Landscape(GeneratedMesh):
    """A height field with extrusions, one open sheet [4.1.1]."""

    generate: Literal["landscape"] = Field(description="`landscape`: one sheet of low frequency")
    cells: int = Field(256, ge=16, le=2048, description="grid cells along a side")
    extrusions: int = Field(12, ge=0, le=200, description="plateaus raised from the relief")
    seed: int = Field(7, ge=0, lt=2**32, description="which landscape; places and heights")


class DownloadedMesh(Model):
    """A mesh that the pipeline fetches."""

    download: Literal["stanford_dragon"] = Field(
        description="`stanford_dragon`: dragon_vrip_res2.ply of the Stanford 3D Scanning Repository"
    )


class MeshFile(Model):
    """A mesh file of the user."""

    path: str = Field(
        min_length=1,
        description="a .ply, .obj, .stl or .glb file, also .gz; relative to the working directory",
    )


class SphereLight(Model):
    """Light from any direction of a cap of the sphere around the zenith."""

    domain: Literal["sphere"] = Field(description="`sphere`: uniform over the cap's area")
    min_elevation_deg: float = Field(
        20, ge=1, lt=90, description="lowest light above the horizon, in degrees"
    )


class SingleAxisLight(Model):
    """Light on an arc: the sun's path about one horizontal axis [4.1.1]."""

    domain: Literal["single_axis"] = Field(description="`single_axis`: uniform in the angle")
    axis: Literal["x", "y", "z"] = Field(description="horizontal axis that the light turns about")
    min_elevation_deg: float = Field(
        20, ge=1, lt=90, description="lowest light above the horizon, in degrees"
    )


GENERATED = ("wyrm", "fence", "landscape")


def _mesh_kind(value: Any) -> str | None:
    sources = ("generate", "download", "path")
    named = [key for key in sources if isinstance(value, dict) and key in value]
    if named == ["generate"]:
        made = value["generate"]
        return made if made in GENERATED else None
    return named[0] if len(named) == 1 else None


Mesh = Annotated[
    Annotated[Wyrm, Tag("wyrm")]
    | Annotated[Fence, Tag("fence")]
    | Annotated[Landscape, Tag("landscape")]
    | Annotated[DownloadedMesh, Tag("download")]
    | Annotated[MeshFile, Tag("path")],
    Discriminator(
        _mesh_kind,
        custom_error_type="mesh_kind",
        custom_error_message=(
            "should be one of {generate: wyrm, fence or landscape}, {download: stanford_dragon}, "
            "{path: FILE} "
            "(an overlay drops a key of the default by setting it to null)"
        ),
    ),
]


class Scene(Model):
    """A mesh, how it stands and how it is lit [4.1.1]."""

    mesh: Mesh = Field(
        description=(
            "one of {generate: wyrm, fence or landscape}, {download: stanford_dragon}, {path: FILE}"
        )
    )
    up: Literal["x", "y", "z"] = Field("y", description="the mesh's axis that points up")
    ground: bool = Field(True, description="whether it stands on a plane that receives its shadow")
    light: Annotated[SphereLight | SingleAxisLight, Field(discriminator="domain")] = Field(
        SphereLight(domain="sphere"), description="directions that viewpoints draw their light from"
    )
    seed: int | None = Field(
        None, ge=0, lt=2**32, description="seed of this scene alone; without it the config's `seed`"
    )


class Sampling(Model):
    """How training rays are drawn [3.4]."""

    sampler: Literal["poisson_quadtree", "uniform_quadtree", "uniform"] = Field(
        description="the sampling methods of table 4.1"
    )
    domain: Literal["sphere", "hemisphere", "light"] = Field(
        "sphere",
        description=(
            "view directions: the whole sphere, those of light above the horizon, or of the "
            "scene's light domain alone"
        ),
    )
    directions: int = Field(ge=1, le=1_000_000, description="view directions")
    points_per_direction: int = Field(
        ge=1, le=10_000_000, description="m, rays per view direction [3.4.2]"
    )
    silhouette_resolution: int = Field(
        128, ge=8, le=4096, description="texels along a silhouette's side, a power of two"
    )
    min_quad: int = Field(
        1, ge=1, le=4096, description="side of the smallest quad in texels, a power of two"
    )
    shards: int = Field(2, ge=1, le=10_000, description="files (and jobs) the rays are split into")

    @model_validator(mode="after")
    def _check(self):
        _check_power_of_two(self.silhouette_resolution, "silhouette_resolution")
        _check_power_of_two(self.min_quad, "min_quad")
        if self.min_quad > self.silhouette_resolution:
            raise ValueError(
                f"min_quad = {self.min_quad}: must not exceed silhouette_resolution "
                f"({self.silhouette_resolution})"
            )
        if self.shards > self.directions:
            raise ValueError(
                f"shards = {self.shards}: must not exceed directions ({self.directions})"
            )
        return self


class FrequencyNetwork(Model):
    """The thesis's fully connected network [3.3, 4.1]."""

    needs_mesh: ClassVar[bool] = False
    encoding: Literal["frequency"] = Field("frequency", description="`frequency`, the default")
    frequencies: int = Field(ge=0, le=30, description="L of the frequency encoding; 0 is identity")
    width: int = Field(ge=8, le=4096, description="neurons per layer")
    hidden_layers: int = Field(ge=1, le=64, description="width × width layers")


Stored = Literal["float32", "float16", "int8"]


class RayGrid(Model):
    """Features of points along the ray, from dense 3-D grids, into a small network."""

    needs_mesh: ClassVar[bool] = False
    encoding: Literal["ray_grid"] = Field(description="`ray_grid`: points on the whole chord")
    points: int = Field(8, ge=1, le=256, description="K, points along the ray")
    grids: list[Annotated[int, Field(ge=2, le=512)]] = Field(
        [16, 32, 60], min_length=1, description="vertices along an axis of each grid"
    )
    channels: int = Field(4, ge=1, le=64, description="trained features of a grid's vertex")
    width: int = Field(64, ge=8, le=4096, description="neurons per layer")
    hidden_layers: int = Field(3, ge=1, le=64, description="layers before the output")
    head: Literal["depth", "depth_confidence"] = Field(
        "depth_confidence", description="whether a second output tells hit from miss"
    )
    stored: Stored = Field("float16", description="how the weight file holds the weights")


class OccupancyRayGrid(RayGrid):
    """A ray grid whose points lie between the first and the last occupied cell on the ray."""

    needs_mesh: ClassVar[bool] = True
    encoding: Literal["occupancy_ray_grid"] = Field(
        description="`occupancy_ray_grid`: points where the ray is near the surface"
    )
    occupancy: int = Field(64, ge=2, le=512, description="cells along an axis of the occupancy")


class HashGrid(OccupancyRayGrid):
    """An occupancy-clipped ray grid whose large grids are hash tables (Instant-NGP)."""

    encoding: Literal["hash_grid"] = Field(description="`hash_grid`: multiresolution hash tables")
    table_size: int = Field(
        65536, ge=16, le=1 << 24, description="entries of a grid's hash table, a power of two"
    )

    @model_validator(mode="after")
    def _check(self):
        _check_power_of_two(self.table_size, "table_size")
        return self


class OccupancyField(Model):
    """One trained logit at each grid vertex near the surface; a ray marches through them."""

    needs_mesh: ClassVar[bool] = True
    encoding: Literal["occupancy_field"] = Field(
        description="`occupancy_field`: inside or outside, without a direction"
    )
    resolution: int = Field(256, ge=8, le=1024, description="cells along an axis, a multiple of 4")
    surface: Literal["solid", "sheet"] = Field(
        "solid", description="`solid`: the object has an inside; `sheet`: one open surface"
    )
    stored: Stored = Field("int8", description="how the weight file holds the logits")

    @model_validator(mode="after")
    def _check(self):
        if self.resolution % 4:
            raise ValueError(f"resolution = {self.resolution}: must be a multiple of 4")
        return self


ENCODINGS = ("frequency", "ray_grid", "occupancy_ray_grid", "hash_grid", "occupancy_field")


def _encoding(value: Any) -> str | None:
    name = value.get("encoding", "frequency") if isinstance(value, dict) else "frequency"
    return name if name in ENCODINGS else None


Network = Annotated[
    Annotated[FrequencyNetwork, Tag("frequency")]
    | Annotated[RayGrid, Tag("ray_grid")]
    | Annotated[OccupancyRayGrid, Tag("occupancy_ray_grid")]
    | Annotated[HashGrid, Tag("hash_grid")]
    | Annotated[OccupancyField, Tag("occupancy_field")],
    Discriminator(
        _encoding,
        custom_error_type="encoding",
        custom_error_message=f"`encoding` should be one of {', '.join(ENCODINGS)}",
    ),
]


class Loss(Model):
    """The dead-zone loss, and two changes to it [3.5, 5.1, 5.4.1]."""

    false_shadow: float = Field(
        1.0, ge=0, le=1000, description="weight of depths before the first hit (thesis: 1)"
    )
    light_leak: float = Field(
        1.0, ge=0, le=1000, description="weight of depths behind the second hit (thesis: 1)"
    )
    middle_pull: float = Field(
        0.0, ge=0, le=1000, description="weight of a pull to the middle between them (thesis: 0)"
    )


class Training(Model):
    """Adam on the network's loss [3.5, 4.1]."""

    steps: int = Field(ge=1, description="optimiser steps")
    # From 16: in a batch of a few rays, equal predictions do not yet mean a dead network.
    batch_size: int = Field(ge=16, le=1 << 24, description="samples per step")
    learning_rate: float = Field(gt=0, le=1, description="Adam's learning rate (at its start)")
    schedule: Literal["constant", "cosine"] = Field(
        "constant", description="learning rate over the run: constant (thesis) or cosine to zero"
    )
    loss: Loss = Field(
        Loss(), description="the loss of depths; an occupancy_field predicts none in training"
    )


class Experiment(Model):
    """One trained network: scene + sampling + network + training, by name."""

    scene: Name = Field(description="a name in `scenes`")
    sampling: Name = Field(description="a name in `samplings`")
    network: Name = Field(description="a name in `networks`")
    training: Name = Field(description="a name in `trainings`")
    seed: int | None = Field(
        None, ge=0, lt=2**32, description="seed of this training; without it the scene's"
    )


# Two types of one value; told apart beforehand, a mistake is told as one of its type alone.
DepthBias = Annotated[
    Annotated[float, Field(ge=0, le=1), Tag("number")]
    | Annotated[Literal["held_out"], Tag("word")],
    Discriminator(lambda value: "word" if isinstance(value, str) else "number"),
]


class Evaluation(Model):
    """Methods compared with the reference on the viewpoints of one scene [4.1]."""

    scene: Name = Field(description="a name in `scenes`")
    networks: list[Name] = Field(
        min_length=1, description="experiments whose networks are rendered"
    )
    shadow_maps: list[Annotated[int, Field(ge=2, le=32768)]] = Field(
        [2048, 1024, 512, 256, 128], description="resolutions of the shadow maps"
    )
    view_sets: list[Literal["shadow", "surface", "centre"]] = Field(
        ["shadow", "surface"],
        min_length=1,
        description="`shadow`: aimed at the cast shadow; `surface`: at the object; `centre`",
    )
    depth_bias: DepthBias = Field(
        0.0,
        description=(
            "added to t_pred in the query, in sphere radii (thesis: 0); `held_out`: each network's "
            "best on views that are in no table, where its method is called NAME_biased"
        ),
    )

    @model_validator(mode="after")
    def _check(self):
        for key in ("networks", "shadow_maps", "view_sets"):
            values = getattr(self, key)
            if len(set(values)) < len(values):
                raise ValueError(f"{key} = {values}: must name each only once")
        return self


class Rendering(Model):
    """Frames and viewpoints of all evaluations [4.1]."""

    width: int = Field(ge=64, le=8192, description="pixels")
    height: int = Field(ge=64, le=8192, description="pixels")
    views_per_set: int = Field(ge=1, le=1_000_000, description="viewpoints in each view set")
    batch: int = Field(ge=1, description="viewpoints of a set that one job renders")
    held_out_views: int = Field(
        8, ge=1, le=10_000, description="further viewpoints of a set, to find depth biases on"
    )
    reference: Literal["exact", "shadow_map"] = Field(
        "exact", description="a shadow ray per pixel, or the thesis's 32768² shadow map"
    )


class LpipsTrunk(Model):
    """The pretrained network inside LPIPS."""

    net: Literal["alex", "squeeze", "vgg"] = Field("alex", description="LPIPS's network")
    trunk: str | None = Field(
        None, description="local weights file of that network; without it torchvision's is fetched"
    )


class Metrics(Model):
    """Image metrics."""

    lpips: LpipsTrunk = Field(LpipsTrunk(), description="the learned perceptual metric")


class Row(Model):
    """A row of a table."""

    method: str = Field(
        description="`shadow_map_N`, or the name of an experiment of the table's evaluations"
    )
    label: str = Field(min_length=1, description="the row's name in the table")
    published: str | None = Field(
        None, description="the row's key in published.csv; without it the method's name"
    )


class TimedRow(Row):
    """A row of a table of frame times."""

    method: str = Field(
        description="an experiment of the table's evaluations, `shadow_map_N` or `ray_traced`"
    )
    scene: Name | None = Field(
        None, description="a name in `scenes`; needed for `shadow_map_N` and `ray_traced` alone"
    )


ON_REQUEST = Field(
    False, description="whether it is made only when asked for by name, and not by `all`"
)


class AnyTable(Model):
    """What all tables have."""

    title: str = Field(min_length=1, description="heading of the table")
    published: str | None = Field(
        None,
        pattern=r"^4\.[1-7]$",
        description="the thesis's number of this table; null for a table of your own",
    )


class Table(AnyTable):
    """A table of methods on the same viewpoints, beside the values that the thesis prints."""

    kind: Literal["comparison"] = Field("comparison", description="`comparison`, the default")
    evaluations: list[Name] = Field(
        min_length=1,
        description="names in `evaluations`, of one scene and the same view sets; rows are theirs",
    )
    rows: list[Row] = Field(min_length=1, description="methods, in the table's order")
    figures: list[Name] = Field(
        [], description="names in `figures` that are made and shown beside the table"
    )


class FrameTimesTable(AnyTable):
    """A table of frame time, LPIPS and size [4.4.1]."""

    kind: Literal["frame_times"] = Field(description="`frame_times`")
    evaluations: list[Name] = Field(
        min_length=1, description="names in `evaluations` that give the networks' LPIPS"
    )
    rows: list[TimedRow] = Field(min_length=1, description="methods, in the table's order")


class NetworksTable(AnyTable):
    """A table of networks beside shadow maps: quality, bytes, training, speed; by scene."""

    kind: Literal["networks"] = Field(description="`networks`")
    evaluations: list[Name] = Field(
        min_length=1, description="names in `evaluations`; rows are methods of theirs"
    )
    rows: list[TimedRow] = Field(min_length=1, description="methods, in the table's order")
    on_request: bool = ON_REQUEST


class MemoryTable(AnyTable):
    """A table of the memory that methods take [4.4.2]."""

    kind: Literal["memory"] = Field(description="`memory`")
    rows: list[Row] = Field(min_length=1, description="experiments and `shadow_map_N`")


class CostTable(AnyTable):
    """A table of what each stage costs while one size grows and the others stay."""

    kind: Literal["cost"] = Field(description="`cost`")
    subdivisions: list[Annotated[int, Field(ge=1, le=9)]] = Field(
        description="of a sphere's 20 triangles, each time into four: 6 gives 81,920"
    )
    samples: list[Annotated[int, Field(ge=10_000, le=10**9)]] = Field(
        description="rays of a ray set, 10,000 of each direction"
    )
    width: list[Annotated[int, Field(ge=1, le=4096)]] = Field(description="neurons per layer")
    views: list[Annotated[int, Field(ge=1, le=10_000)]] = Field(
        description="viewpoints of an evaluation"
    )
    frame_width: list[Annotated[int, Field(ge=48, le=8192)]] = Field(
        description="pixels; the height is two thirds of it"
    )
    on_request: bool = ON_REQUEST


def _table_kind(value: Any) -> str | None:
    kind = value.get("kind", "comparison") if isinstance(value, dict) else "comparison"
    return kind if kind in ("comparison", "frame_times", "networks", "memory", "cost") else None


AnyTableKind = Annotated[
    Annotated[Table, Tag("comparison")]
    | Annotated[FrameTimesTable, Tag("frame_times")]
    | Annotated[NetworksTable, Tag("networks")]
    | Annotated[MemoryTable, Tag("memory")]
    | Annotated[CostTable, Tag("cost")],
    Discriminator(
        _table_kind,
        custom_error_type="table_kind",
        custom_error_message="`kind` should be comparison (the default), frame_times, networks, memory or cost",
    ),
]


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


class AnyClaim(Model):
    """What all claims have."""

    section: str = Field(pattern=r"^[1-9](\.[1-9])*$", description="of the thesis, as 4.2.1")
    statement: str = Field(min_length=1, description="one sentence, as the thesis draws it")


Pair = Annotated[list[str], Field(min_length=2, max_length=2)]
Pairs = Annotated[
    list[Pair], Field(min_length=1, description="comparisons, the claimed winner first")
]


class BetterClaim(AnyClaim):
    """Methods compared by the mean over views of an image metric."""

    kind: Literal["better"] = Field(description="`better`")
    evaluations: list[Name] = Field(
        min_length=1, description="names in `evaluations`, each method in one of them"
    )
    pairs: Pairs
    metric: Literal["lpips", "psnr", "ssim", "flip", "shadow_error"] = Field(
        "lpips", description="an image metric; FLIP takes LPIPS's place where its trunk is missing"
    )


class MoreClaim(AnyClaim):
    """More of one kind of error than of another, for each method."""

    kind: Literal["more"] = Field(description="`more`")
    evaluations: list[Name] = Field(
        min_length=1, description="names in `evaluations`, each method in one of them"
    )
    methods: list[str] = Field(min_length=1, description="methods of the evaluations")
    more: Literal["false_shadow", "light_leak"] = Field(description="the larger error")
    less: Literal["false_shadow", "light_leak"] = Field(description="the smaller error")

    @model_validator(mode="after")
    def _check_errors(self):
        if self.more == self.less:
            raise ValueError(f"more = {self.more!r}: must be another error than `less`")
        return self


class LowerLossClaim(AnyClaim):
    """Networks compared by the end of their training loss."""

    kind: Literal["lower_loss"] = Field(description="`lower_loss`")
    pairs: Pairs


class FrameTimeClaim(AnyClaim):
    """The ratio of two methods' median frame times, within bounds."""

    kind: Literal["frame_time"] = Field(description="`frame_time`")
    table: str = Field(description="a table of `frame_times` in `tables`")
    pairs: Annotated[
        list[Pair],
        Field(min_length=1, description="methods of one scene; the first's time over the second's"),
    ]
    at_least: float | None = Field(None, gt=0, lt=1e6, description="least ratio")
    at_most: float | None = Field(None, gt=0, lt=1e6, description="largest ratio")

    @model_validator(mode="after")
    def _check_bounds(self):
        if self.at_least is None and self.at_most is None:
            raise ValueError("a claim on frame_time needs `at_least`, `at_most`, or both")
        if None not in (self.at_least, self.at_most) and self.at_least >= self.at_most:
            raise ValueError(
                f"at_least = {self.at_least:g}: must be less than at_most ({self.at_most:g})"
            )
        return self


Claim = Annotated[
    BetterClaim | MoreClaim | LowerLossClaim | FrameTimeClaim, Field(discriminator="kind")
]


class FrameTimes(Model):
    """How frame times are measured [4.4.1]."""

    width: int = Field(1200, ge=64, le=8192, description="pixels")
    height: int = Field(800, ge=64, le=8192, description="pixels")
    repeats: int = Field(15, ge=3, le=10_000, description="timed frames of each method")
    warm_up: int = Field(2, ge=0, le=1000, description="frames of each method before those")


class Compute(Model):
    """What the networks run on."""

    device: Literal["auto", "cpu", "cuda"] = Field(
        "auto", description="`auto`: a GPU if there is one"
    )
    precision: Literal["auto", "float32", "bfloat16"] = Field(
        "auto", description="of matrix products; `auto`: bfloat16 where the hardware has it"
    )
    threads: int = Field(2, ge=1, le=1024, description="CPU threads of a sampling or training job")


class Config(Model):
    """The whole configuration."""

    scale: Name = Field(description="name of this configuration; overlays write below it")
    seed: int = Field(ge=0, lt=2**32, description="seed of everything that is drawn")
    dragon: str | None = Field(
        None,
        min_length=1,
        description="short for scenes.dragon.mesh: `wyrm`, `stanford`, or a mesh file",
    )
    compute: Compute = Field(Compute(), description="what the networks run on")
    scenes: dict[Name, Scene] = Field(description="meshes, how they stand and are lit, by name")
    samplings: dict[Name, Sampling] = Field(description="ways to draw training rays, by name")
    networks: dict[Name, Network] = Field(description="network shapes, by name")
    trainings: dict[Name, Training] = Field(description="optimiser settings, by name")
    experiments: dict[Name, Experiment] = Field(description="networks to train, by name")
    evaluations: dict[Name, Evaluation] = Field(description="comparisons to render, by name")
    rendering: Rendering = Field(description="frames and viewpoints of all evaluations")
    metrics: Metrics = Field(Metrics(), description="settings of the image metrics")
    frame_times: FrameTimes = Field(FrameTimes(), description="how frame times are measured")
    tables: dict[Name, AnyTableKind] = Field(
        description="tables to write, by name: of the thesis's, `table_` and its number"
    )
    figures: dict[Annotated[str, Field(pattern=r"^figure_[a-z0-9_]+$")], Figure] = Field(
        {}, description="figures to draw, by name: `figure_` and the thesis's number"
    )
    claims: dict[Name, Claim] = Field({}, description="what the thesis concludes, by name")

    @model_validator(mode="after")
    def _check_names(self):
        def known(section: str, name: str, key: str) -> None:
            if name not in getattr(self, section):
                raise ValueError(
                    f"{key}: no such name in `{section}`: {name!r}; "
                    f"allowed: {', '.join(sorted(getattr(self, section)))}"
                )

        for name in self.tables:
            if name in ("claims", "index"):
                raise ValueError(
                    f"tables.{name}: a report has this name; allowed: any other than claims, index"
                )
        if self.scale in RESERVED_SCALES:
            raise ValueError(
                f"scale = {self.scale!r}: is the name of a folder of results or reports; "
                f"allowed: any other than {', '.join(sorted(RESERVED_SCALES))}"
            )
        settings: dict[tuple[str, ...], str] = {}
        for name, experiment in self.experiments.items():
            if name in ("reference", RAY_TRACED) or name.startswith(SHADOW_MAP_PREFIX):
                raise ValueError(
                    f"experiments.{name}: tables and pictures have a method of this name; allowed: "
                    f"any other than 'reference', '{RAY_TRACED}' and '{SHADOW_MAP_PREFIX}…'"
                )
            if name.endswith(BIASED_SUFFIX):
                raise ValueError(
                    f"experiments.{name}: tables call a network with its depth bias so; allowed: a "
                    f"name that does not end in '{BIASED_SUFFIX}'"
                )
            for key in ("scene", "sampling", "network", "training"):
                known(f"{key}s", getattr(experiment, key), f"experiments.{name}.{key}")
            same = settings.setdefault(tuple(experiment.model_dump().values()), name)
            if same != name:
                raise ValueError(
                    f"experiments.{name}: is the same as experiments.{same}, and would train the "
                    "same network twice; use that one, or change a name or the seed"
                )
        for name, evaluation in self.evaluations.items():
            known("scenes", evaluation.scene, f"evaluations.{name}.scene")
            for network in evaluation.networks:
                known("experiments", network, f"evaluations.{name}.networks")
                scene = self.experiments[network].scene
                if scene != evaluation.scene:
                    raise ValueError(
                        f"evaluations.{name}.networks: {network!r} belongs to the scene {scene!r}, "
                        f"not to {evaluation.scene!r}"
                    )
            if not self.scenes[evaluation.scene].ground and "shadow" in evaluation.view_sets:
                raise ValueError(
                    f"evaluations.{name}.view_sets: 'shadow' needs a scene with ground: true; "
                    "allowed here: 'surface', 'centre'"
                )
        for name, table in self.tables.items():
            for evaluation in getattr(table, "evaluations", []):
                known("evaluations", evaluation, f"tables.{name}.evaluations")
            for figure in getattr(table, "figures", []):
                known("figures", figure, f"tables.{name}.figures")
            self._check_table(name, table)
        for name, figure in self.figures.items():
            match figure:
                case PicturesFigure() | WidthsFigure() | FrontsFigure() | CostFigure():
                    known("tables", figure.table, f"figures.{name}.table")
                    wanted = {
                        "pictures": ("comparison", "networks"),
                        "widths": ("frame_times",),
                        "fronts": ("networks",),
                        "cost": ("cost",),
                    }[figure.kind]
                    if self.tables[figure.table].kind not in wanted:
                        raise ValueError(
                            f"figures.{name}.table: {figure.table!r} is a table of "
                            f"{self.tables[figure.table].kind}; "
                            f"allowed: one of {' or '.join(wanted)}"
                        )
                    if not isinstance(figure, CostFigure):
                        self._check_figure_scene(name, figure)
                case FieldSliceFigure():
                    known("experiments", figure.experiment, f"figures.{name}.experiment")
                    network = self.experiments[figure.experiment].network
                    if self.networks[network].encoding != "occupancy_field":
                        raise ValueError(
                            f"figures.{name}.experiment: {figure.experiment!r} is a network of "
                            f"{self.networks[network].encoding}; allowed: one of occupancy_field"
                        )
                case LossFigure():
                    for curve in figure.curves:
                        known("experiments", curve.experiment, f"figures.{name}.curves")
                case MethodFigure():
                    known("scenes", figure.scene, f"figures.{name}.scene")
                    known("samplings", figure.sampling, f"figures.{name}.sampling")
            if isinstance(figure, PicturesFigure):
                rows = [row.method for row in self.tables[figure.table].rows]
                for method in figure.methods or []:
                    if method not in rows or method == RAY_TRACED:
                        raise ValueError(
                            f"figures.{name}.methods: {method!r} has no pictures in "
                            f"{figure.table}; allowed: "
                            f"{', '.join(row for row in rows if row != RAY_TRACED)}"
                        )
                rendered = next(
                    evaluation.view_sets
                    for evaluation in map(
                        self.evaluations.get, self.tables[figure.table].evaluations
                    )
                    if figure.scene in (None, evaluation.scene)
                )
                missing = [view_set for view_set in figure.view_sets if view_set not in rendered]
                if missing:
                    raise ValueError(
                        f"figures.{name}.view_sets: {missing[0]!r} is not rendered for "
                        f"{figure.table}; allowed: {', '.join(rendered)}"
                    )
        for name, claim in self.claims.items():
            self._check_claim(name, claim)
        for name, scene in self.scenes.items():
            if isinstance(scene.light, SingleAxisLight) and scene.light.axis == scene.up:
                raise ValueError(
                    f"scenes.{name}.light.axis = {scene.light.axis!r}: must be horizontal, not `up`; "
                    f"allowed: {', '.join(sorted({'x', 'y', 'z'} - {scene.up}))}"
                )
        return self

    def _check_figure_scene(
        self, name: str, figure: "PicturesFigure | WidthsFigure | FrontsFigure"
    ) -> None:
        table = self.tables[figure.table]
        scene = getattr(figure, "scene", None)
        if table.kind == "networks":
            scenes = [self.evaluations[key].scene for key in table.evaluations]
            if scene not in scenes:
                raise ValueError(
                    f"figures.{name}.scene: {scene!r} is not in {figure.table}; "
                    f"allowed: {', '.join(dict.fromkeys(scenes))}"
                )
        elif scene is not None:
            raise ValueError(
                f"figures.{name}.scene: {figure.table!r} has one scene; leave `scene` out"
            )

    def _check_table(
        self, name: str, table: "Table | FrameTimesTable | NetworksTable | MemoryTable | CostTable"
    ) -> None:
        if isinstance(table, CostTable):
            self._check_sizes(name, table)
            return
        keys = [(row.method, getattr(row, "scene", None)) for row in table.rows]
        for key in keys:
            if keys.count(key) > 1:
                raise ValueError(f"tables.{name}.rows: {key[0]!r}: must name each method only once")
        match table:
            case Table():
                self._check_comparison(name, table)
            case FrameTimesTable() | NetworksTable():
                for row in table.rows:
                    self._check_timed_row(name, table, row)
                if isinstance(table, NetworksTable):
                    self._check_labels(name, table)
                    self._check_same_scene_views(f"tables.{name}.evaluations", table.evaluations)
            case MemoryTable():
                for row in table.rows:
                    if row.method not in self.experiments and not is_shadow_map(row.method):
                        raise ValueError(
                            f"tables.{name}.rows: no such method: {row.method!r}; "
                            f"allowed: shadow_map_N, {', '.join(self.experiments)}"
                        )

    def _check_sizes(self, name: str, table: CostTable) -> None:
        sizes = {key: getattr(table, key) for key in STAGES}
        for key, values in sizes.items():
            if values != sorted(set(values)):
                raise ValueError(f"tables.{name}.{key} = {values}: must grow from each to the next")
        if not any(sizes.values()):
            raise ValueError(f"tables.{name}: needs a size; give one of {', '.join(sizes)}")

    def _check_comparison(self, name: str, table: Table) -> None:
        first = self.evaluations[table.evaluations[0]]
        for evaluation in table.evaluations[1:]:
            for key in ("scene", "view_sets"):
                value, other = getattr(first, key), getattr(self.evaluations[evaluation], key)
                if value != other:
                    raise ValueError(
                        f"tables.{name}.evaluations: {table.evaluations[0]!r} and {evaluation!r} "
                        f"differ in `{key}`: {value!r} and {other!r}; allowed: the same"
                    )
        methods = self.methods(table.evaluations)
        twice = sorted({method for method in methods if methods.count(method) > 1})
        if twice:
            raise ValueError(
                f"tables.{name}.evaluations: {twice[0]!r} is in more than one of them; "
                "allowed: each method in one"
            )
        for row in table.rows:
            if row.method not in methods:
                raise ValueError(
                    f"tables.{name}.rows: no such method in the evaluations "
                    f"{', '.join(table.evaluations)}: {row.method!r}; allowed: {', '.join(methods)}"
                )

    def _check_timed_row(
        self, name: str, table: "FrameTimesTable | NetworksTable", row: TimedRow
    ) -> None:
        methods = self.methods(table.evaluations)
        networks = [method for method in methods if not is_shadow_map(method)]
        if row.method in networks:
            if row.scene is not None:
                raise ValueError(
                    f"tables.{name}.rows: {row.method!r} has its own scene; leave `scene` out"
                )
        elif row.method == RAY_TRACED or is_shadow_map(row.method):
            if row.scene not in self.scenes:
                raise ValueError(
                    f"tables.{name}.rows: {row.method!r} needs a `scene`, not {row.scene!r}; "
                    f"allowed: {', '.join(self.scenes)}"
                )
        else:
            raise ValueError(
                f"tables.{name}.rows: no such method: {row.method!r}; "
                f"allowed: {RAY_TRACED}, shadow_map_N, {', '.join(networks)}"
            )

    def _check_claim(
        self, name: str, claim: "BetterClaim | MoreClaim | LowerLossClaim | FrameTimeClaim"
    ) -> None:
        for evaluation in getattr(claim, "evaluations", []):
            if evaluation not in self.evaluations:
                raise ValueError(
                    f"claims.{name}.evaluations: no such name in `evaluations`: {evaluation!r}; "
                    f"allowed: {', '.join(self.evaluations)}"
                )
        match claim:
            case BetterClaim() | MoreClaim():
                allowed = self.methods(claim.evaluations)
            case LowerLossClaim():
                allowed = list(self.experiments)
            case FrameTimeClaim():
                table = self.tables.get(claim.table)
                if not isinstance(table, FrameTimesTable):
                    tables = [
                        key for key, value in self.tables.items() if value.kind == "frame_times"
                    ]
                    raise ValueError(
                        f"claims.{name}.table: {claim.table!r} is no table of frame_times; "
                        f"allowed: {', '.join(tables)}"
                    )
                allowed = [row.method for row in table.rows]
        named = getattr(claim, "methods", None) or [m for pair in claim.pairs for m in pair]
        for method in named:
            if method not in allowed:
                raise ValueError(
                    f"claims.{name}: no such method: {method!r}; allowed: {', '.join(allowed)}"
                )
            if isinstance(claim, BetterClaim | MoreClaim) and allowed.count(method) > 1:
                raise ValueError(
                    f"claims.{name}: {method!r} is in more than one of its evaluations; "
                    "allowed: each method in one"
                )
        for first, second in getattr(claim, "pairs", []):
            if first == second:
                raise ValueError(
                    f"claims.{name}.pairs: {first!r} is compared with itself; allowed: two methods"
                )
        if isinstance(claim, BetterClaim):
            self._check_same_scene_views(f"claims.{name}.evaluations", claim.evaluations)
        if isinstance(claim, FrameTimeClaim):
            for first, second in claim.pairs:
                shared = self._timed_scenes(claim.table, first) & self._timed_scenes(
                    claim.table, second
                )
                if len(shared) != 1:
                    raise ValueError(
                        f"claims.{name}.pairs: {first!r} and {second!r} are timed together in "
                        f"{len(shared)} scenes; allowed: two methods of one scene"
                    )

    def _check_labels(self, name: str, table: NetworksTable) -> None:
        scenes = [
            self.experiments[experiment_of(row.method)].scene if row.scene is None else row.scene
            for row in table.rows
        ]
        labels = [(scene, row.label) for scene, row in zip(scenes, table.rows)]
        for scene, label in labels:
            if labels.count((scene, label)) > 1:
                raise ValueError(
                    f"tables.{name}.rows: {scene} has two rows with the label {label!r}; "
                    "allowed: one of each"
                )

    def _check_same_scene_views(self, key: str, evaluations: Iterable[str]) -> None:
        settings = {name: self.evaluations[name] for name in evaluations}
        for name, one in settings.items():
            for other_name, other in settings.items():
                if one.scene == other.scene and set(one.view_sets) != set(other.view_sets):
                    raise ValueError(
                        f"{key}: {name!r} and {other_name!r} differ in `view_sets`: "
                        f"{one.view_sets!r} and {other.view_sets!r}; "
                        "allowed: the same for one scene"
                    )

    def _timed_scenes(self, table: str, method: str) -> set[str]:
        return {
            self.experiments[experiment_of(method)].scene if row.scene is None else row.scene
            for row in self.tables[table].rows
            if row.method == method
        }

    def methods(self, evaluations: Iterable[str]) -> list[str]:
        """Keys of the methods of evaluations: of each its shadow maps, then its networks."""
        return [
            method
            for settings in (self.evaluations[name] for name in evaluations)
            for method in (
                *map(shadow_map_key, settings.shadow_maps),
                *self.network_methods(settings),
            )
        ]

    def network_methods(self, evaluation: Evaluation) -> list[str]:
        """Keys of the networks of an evaluation, which tell whether it seeks their depth bias."""
        if evaluation.depth_bias == "held_out":
            return [biased_key(name) for name in evaluation.networks]
        return list(evaluation.networks)

    def scene_seed(self, scene: str) -> int:
        """The seed of everything drawn for a scene."""
        own = self.scenes[scene].seed
        return self.seed if own is None else own

    def mesh_name(self, scene: str) -> str:
        """What a scene's mesh is called in tables: what it is, not what it stands for."""
        mesh = self.scenes[scene].mesh
        match mesh:
            case GeneratedMesh():
                return mesh.generate
            case DownloadedMesh():
                return mesh.download
            case MeshFile():
                name = Path(mesh.path).name.removesuffix(".gz")
                return Path(name).stem


def _without_nulls(scene: Any) -> Any:
    """A scene whose `mesh` and `light` lack the keys that an overlay set to null to drop them."""
    if not isinstance(scene, dict):
        return scene
    return scene | {
        key: {name: value for name, value in scene[key].items() if value is not None}
        for key in ("mesh", "light")
        if isinstance(scene.get(key), dict)
    }


def _mesh_of_shorthand(value: str) -> dict[str, str]:
    match value:
        case "wyrm":
            return {"generate": "wyrm"}
        case "stanford":
            return {"download": "stanford_dragon"}
        case path:
            return {"path": path}


def _describe(error: ValidationError) -> str:
    """One line for the first problem: key, value, and what is allowed."""
    problem = error.errors()[0]
    key, allowed = _locate(problem["loc"])
    message = problem["msg"].removeprefix("Value error, ")
    if problem["type"] == "extra_forbidden":
        message = f"unknown key; allowed: {', '.join(allowed)}"
    elif problem["type"] == "missing":
        message = "this key is missing"
    elif problem["type"] in ("dict_type", "model_type", "model_attributes_type"):
        message = f"should be a section of keys, not {_shown(problem['input'])}"
    elif problem["type"] == "float_type" and _is_number(problem["input"]):
        key = f"{key} = {_shown(problem['input'])}"
        message = "is text to YAML; write a number with a point, as 0.001 or 1.0e-3"
    elif problem["type"] != "value_error":  # our own checks name key and value themselves
        key = f"{key} = {_shown(problem['input'])}"
    more = error.error_count() - 1
    return f"{key + ': ' if key else ''}{message}" + (f" (and {more} more)" if more else "")


def _shown(value: Any) -> str:
    """A value as a message shows it: aliases of aliases in YAML may unfold to gigabytes."""
    shown = reprlib.Repr()
    shown.maxstring = shown.maxother = shown.maxlong = 80
    return shown.repr(value)


def _is_number(text: Any) -> bool:
    try:
        float(text)
    except (TypeError, ValueError):
        return False
    return True


TAGS = (
    "domain",
    "generate",
    "kind",
    "encoding",
)  # keys whose value tells which section of a union it is


def _locate(location: tuple[str | int, ...]) -> tuple[str, list[str]]:
    """The config key of an error's location, and the keys allowed in its section.

    pydantic's location also holds the tags of unions (`sphere`, `generate`), which are no
    keys: the schema tells the two apart. `[key]` at its end means the key itself.
    """
    schema = Config.model_json_schema()

    def resolve(node: dict) -> dict:
        return schema["$defs"][node["$ref"].rsplit("/", 1)[1]] if "$ref" in node else node

    node: dict = schema
    keys, allowed = [], []
    for part in location:
        if part == "[key]":
            break
        node = resolve(node)
        if "oneOf" in node:
            kinds = [resolve(kind) for kind in node["oneOf"]]
            kinds = [kind for kind in kinds if "properties" in kind]  # not a number or a word
            tagged = [
                kind
                for kind in kinds
                if part in kind["properties"]
                or part in (kind["properties"].get(key, {}).get("const") for key in TAGS)
            ]
            node = tagged[0] if tagged else {}
            continue
        keys.append(str(part))
        allowed = list(node.get("properties", {}))
        if part in allowed:
            node = node["properties"][part]
        elif isinstance(part, int):
            node = node.get("items", {})
        else:
            values = list(node.get("patternProperties", {}).values())
            node = values[0] if values else {}
    return ".".join(keys), allowed


class _NoDuplicates(yaml.SafeLoader):
    """Reads YAML, but refuses a key that is given twice, of which YAML keeps the last."""

    def construct_mapping(self, node, deep=False):
        seen = set()
        for key, _ in node.value:
            if str(key.value) in seen:
                raise InputError(
                    f"config: {key.start_mark.name}, line {key.start_mark.line + 1}: "
                    f"{key.value!r} is there twice; give each name once"
                )
            seen.add(str(key.value))
        return super().construct_mapping(node, deep)


def check_duplicates(paths: Iterable[str | Path]) -> None:
    """Check that no section of these config files gives a name twice.

    Raises:
        InputError: one does; one line with the file, the line and the name. Or a file is no
            YAML, or has no sections.
    """
    for path in paths:
        try:
            with Path(path).open(encoding="utf-8") as file:
                sections = yaml.load(file, _NoDuplicates)
        except (OSError, ValueError, yaml.YAMLError, RecursionError) as error:
            reason = " ".join(str(error).split())[:300]
            raise InputError(f"config: {path}: cannot be read as YAML ({reason})") from error
        if not isinstance(sections, dict):
            raise InputError(f"config: {path}: holds no sections; write `section: ...` at its top")


def read_config(values: dict[str, Any]) -> Config:
    """Check a configuration as Snakemake merged it.

    Args:
        values: the merged config files and `--config` values.

    Raises:
        InputError: a key is unknown or missing, a value has the wrong type or range, or a
            name refers to nothing; one line that names key, value and what is allowed.
    """
    values = dict(values)
    scenes = values.get("scenes")
    if isinstance(scenes, dict):
        values["scenes"] = scenes = {name: _without_nulls(scene) for name, scene in scenes.items()}
    shorthand = values.get("dragon")
    if isinstance(shorthand, str) and shorthand:
        if not isinstance(scenes, dict) or not isinstance(scenes.get("dragon"), dict):
            raise InputError("config: dragon: there is no scene named `dragon` in `scenes`")
        mesh = _mesh_of_shorthand(shorthand)
        old = scenes["dragon"].get("mesh")
        # `--config dragon=wyrm` over a scene that is a wyrm already keeps its resolution.
        if not (isinstance(old, dict) and mesh.items() <= old.items()):
            scenes["dragon"] = scenes["dragon"] | {"mesh": mesh}
    try:
        return Config.model_validate(values)
    except ValidationError as error:
        raise InputError(f"config: {_describe(error)}") from error


def check_files(config: Config) -> None:
    """Check that the files that a configuration names are there.

    Snakemake does not, where an older result exists: it then takes that for up to date.

    Raises:
        InputError: a mesh file or LPIPS's trunk is missing; one line with its key.
    """
    named = {
        f"scenes.{name}.mesh.path": scene.mesh.path
        for name, scene in config.scenes.items()
        if isinstance(scene.mesh, MeshFile)
    }
    if config.metrics.lpips.trunk is not None:
        named["metrics.lpips.trunk"] = config.metrics.lpips.trunk
    for key, path in named.items():
        if not Path(path).is_file():
            raise InputError(
                f"config: {key} = {path!r}: no such file; "
                "give a path from the working directory, or an absolute one"
            )


def json_schema() -> str:
    """The JSON schema of the configuration, as checked in under workflow/schemas."""
    return json.dumps(Config.model_json_schema(), indent=2, ensure_ascii=False) + "\n"


if __name__ == "__main__":
    print(json_schema(), end="")
