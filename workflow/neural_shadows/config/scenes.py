"""`scenes`: a mesh, its ground and its light."""

from typing import Annotated, Any, Literal

from pydantic import Discriminator, Field, Tag

from neural_shadows.config.base import Model


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
