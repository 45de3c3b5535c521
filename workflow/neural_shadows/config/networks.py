"""`networks`: what is trained, and what answers in its place without a training, by encoding."""

from typing import Annotated, ClassVar, Literal, get_args

from pydantic import Field, model_validator

from neural_shadows.config.base import Model, PowerOfTwo, by_kind


class NetworkModel(Model):
    """What the graph must know of a kind."""

    trained: ClassVar[bool] = True  # else an experiment of it has no sampling and no training
    needs_mesh: ClassVar[bool] = False
    of_scene: ClassVar[tuple[str, ...]] = ()  # settings that the network is given by its scene

    @property
    def hidden_matrices(self) -> int:
        """Matrices between two layers of neurons, which are what Muon is for."""
        return 0


class FrequencyNetwork(NetworkModel):
    """The thesis's fully connected network [3.3, 4.1]."""

    encoding: Literal["frequency"] = Field("frequency", description="`frequency`, the default")
    frequencies: int = Field(ge=0, le=30, description="L of the frequency encoding; 0 is identity")
    width: int = Field(ge=8, le=4096, description="neurons per layer")
    hidden_layers: int = Field(ge=1, le=64, description="width × width layers")

    @property
    def hidden_matrices(self) -> int:
        return self.hidden_layers


Stored = Literal["float32", "float16", "int8"]
Surface = Literal["auto", "solid", "sheet"]
SURFACE = (
    "`solid`: the object has an inside; `sheet`: one open surface; `auto`: a sheet where the mesh is "
    "open and thin, else a solid"
)


class RayGrid(NetworkModel):
    """Features of points along the ray, from dense 3-D grids, into a small network."""

    encoding: Literal["ray_grid"] = Field(description="`ray_grid`: points on the whole chord")
    points: int = Field(8, ge=1, le=256, description="K, points along the ray")
    grids: list[Annotated[int, Field(ge=2, le=512)]] = Field(
        [16, 32, 60], min_length=1, description="vertices of an axis"
    )
    channels: int = Field(4, ge=1, le=64, description="trained features of a grid's vertex")
    width: int = Field(64, ge=8, le=4096, description="neurons per layer")
    hidden_layers: int = Field(3, ge=1, le=64, description="layers before the output")
    head: Literal["depth", "depth_confidence"] = Field(
        "depth_confidence", description="whether a second output tells hit from miss"
    )
    stored: Stored = Field("float16", description="how the weight file holds the weights")

    @property
    def hidden_matrices(self) -> int:
        return self.hidden_layers - 1  # the first is behind the grids


class OccupancyRayGrid(RayGrid):
    """A ray grid whose points lie between the first and the last occupied cell on the ray."""

    needs_mesh: ClassVar[bool] = True
    encoding: Literal["occupancy_ray_grid"] = Field(description="points near the surface")
    occupancy: int = Field(64, ge=2, le=512, description="cells along an axis of the occupancy")


class HashGrid(OccupancyRayGrid):
    """An occupancy-clipped ray grid whose large grids are hash tables (Instant-NGP)."""

    encoding: Literal["hash_grid"] = Field(description="`hash_grid`: multiresolution hash tables")
    table_size: PowerOfTwo = Field(65536, ge=16, le=1 << 24, description="of a grid's, in entries")


class OccupancyField(NetworkModel):
    """One trained logit at each grid vertex near the surface; a ray marches through them."""

    needs_mesh: ClassVar[bool] = True
    encoding: Literal["occupancy_field"] = Field(
        description="inside or outside, without a direction"
    )
    resolution: int = Field(256, ge=8, le=1024, multiple_of=4, description="cells of an axis")
    surface: Surface = Field("auto", description=SURFACE)
    start: Literal["undecided", "distances", "fitted"] = Field(
        "undecided",
        description="the first logits: next to zero, or signed distances to the mesh, as they are or "
        "`fitted` to where its shadows end; both answer without a training too",
    )
    stored: Stored | Literal["coded", "sign"] = Field(
        "int8",
        description="how the weight file holds the logits; `coded`: of cells that the surface "
        "crosses, compressed; `sign`: a bit each",
    )
    corner_bits: Literal[4, 8] = Field(
        8,
        description="of a solid, what a CPU holds of each corner of a cell that the surface crosses; 4 "
        "take three fifths of the memory and cost the dragon at 256³ 0.6 dB",
    )

    @model_validator(mode="after")
    def _check_inside(self):
        if self.start != "undecided" and self.surface == "sheet":
            raise ValueError(
                f"start: {self.start} needs an inside, which surface: sheet has not; "
                "set start: undecided, or leave the surface out"
            )
        return self


class Mesh(NetworkModel):
    """The mesh itself, decimated and quantised, asked by a shadow ray a point."""

    trained: ClassVar[bool] = False
    needs_mesh: ClassVar[bool] = True
    encoding: Literal["mesh"] = Field(description="`mesh`: traced exactly, without a training")
    triangles: Annotated[int, Field(ge=4)] | None = Field(
        None, description="the most it is decimated to; all of them by default"
    )
    bits: int = Field(16, ge=4, le=24, description="of a vertex's coordinate")


class VoxelDag(NetworkModel):
    """Voxels of the object, as an octree whose equal parts are stored once; not trained."""

    trained: ClassVar[bool] = False
    needs_mesh: ClassVar[bool] = True
    encoding: Literal["voxel_dag"] = Field(description="`voxel_dag`: voxels, not trained")
    resolution: PowerOfTwo = Field(1024, ge=8, le=4096, description="voxels of an axis")
    surface: Surface = Field(
        "auto", description=f"{SURFACE}. Voxels inside the object, or those that a sheet touches"
    )


class HeightMap(NetworkModel):
    """Heights of a landscape over a grid; not trained."""

    trained: ClassVar[bool] = False
    needs_mesh: ClassVar[bool] = True
    of_scene: ClassVar[tuple[str, ...]] = ("up",)  # the axis of the heights
    encoding: Literal["height_map"] = Field(description="`height_map`: heights, not trained")
    resolution: int = Field(257, ge=2, le=4097, description="heights along a side")
    bits: int = Field(16, ge=8, le=16, multiple_of=8, description="of a height")


KINDS = (
    FrequencyNetwork,
    RayGrid,
    OccupancyRayGrid,
    HashGrid,
    OccupancyField,
    Mesh,
    VoxelDag,
    HeightMap,
)
Network = by_kind("encoding", *KINDS, default="frequency")


def kind_of(encoding: str) -> type[NetworkModel]:
    """The model of an encoding that there is."""
    found = {get_args(kind.model_fields["encoding"].annotation)[0]: kind for kind in KINDS}
    return found[encoding]
