"""`scenes`: a mesh, its ground and its light."""

from pathlib import Path
from typing import Annotated, Any, Literal

from pydantic import Discriminator, Field, Tag

from neural_shadows.settings.base import Model, Seed, by_kind


class Wyrm(Model):
    """The procedural stand-in dragon."""

    generate: Literal["wyrm"] = Field(description="`wyrm`: a creature, the stand-in dragon")
    cells: int = Field(220, ge=48, le=1024, description="marching-cubes cells of the longest axis")


class Fence(Model):
    """A panel of woven wire in a frame, standing on the ground [4.1.1]."""

    generate: Literal["fence"] = Field(description="`fence`: diagonally crossing round wires")
    wires: int = Field(16, ge=2, le=200, description="diamonds along the panel's width")
    wire_radius: float = Field(0.006, gt=0, le=0.1, description="in widths of the panel")


class Landscape(Model):
    """A height field with extrusions, one open sheet [4.1.1]."""

    generate: Literal["landscape"] = Field(description="`landscape`: one sheet of low frequency")
    cells: int = Field(256, ge=16, le=2048, description="grid cells along a side")


class DownloadedMesh(Model):
    """A mesh that the pipeline downloads from the Stanford 3D Scanning Repository."""

    download: Literal["stanford_dragon"] = Field(description="its dragon_vrip_res2.ply")


class MeshFile(Model):
    """A mesh file of the user."""

    path: str = Field(
        min_length=1, description="a .ply, .obj, .stl or .glb, also .gz; from the working directory"
    )


# Tags that no key is called: messages leave out what is no key from the place of an error.
_TAGS = {"generate": "Generated", "download": "Downloaded", "path": "File"}


def _tag(mesh: Any) -> str | None:
    has = mesh.__contains__ if isinstance(mesh, dict) else lambda key: hasattr(mesh, key)
    tags = [tag for key, tag in _TAGS.items() if has(key)]
    return tags[0] if len(tags) == 1 else None


WHERE_FROM = (
    "one of {generate: wyrm, fence or landscape}, {download: stanford_dragon}, {path: FILE}"
)
Mesh = Annotated[
    Annotated[by_kind("generate", Wyrm, Fence, Landscape), Tag("Generated")]
    | Annotated[DownloadedMesh, Tag("Downloaded")]
    | Annotated[MeshFile, Tag("File")],
    Discriminator(
        _tag,
        custom_error_type="mesh",
        custom_error_message=(
            f"should be {WHERE_FROM} (an overlay drops a key of the default by setting it to null)"
        ),
    ),
]


Elevation = Annotated[
    float, Field(ge=1, lt=90, description="lowest light above the horizon, in degrees")
]


class SphereLight(Model):
    """Light from any direction of a cap of the sphere around the zenith."""

    domain: Literal["sphere"] = Field(description="`sphere`: uniform over the cap's area")
    min_elevation_deg: Elevation = 20


class SingleAxisLight(Model):
    """Light on an arc: the sun's path about one horizontal axis [4.1.1]."""

    domain: Literal["single_axis"] = Field(description="`single_axis`: uniform in the angle")
    axis: Literal["x", "y", "z"] = Field(description="horizontal axis that the light turns about")
    min_elevation_deg: Elevation = 20


ViewSet = Literal["shadow", "surface", "centre"]


class Scene(Model):
    """A mesh, how it stands and how it is lit and seen [4.1, 4.1.1]."""

    mesh: Mesh = Field(description=WHERE_FROM)
    up: Literal["x", "y", "z"] = Field("y", description="the mesh's axis that points up")
    ground: bool = Field(True, description="whether it stands on a plane that receives its shadow")
    light: by_kind("domain", SphereLight, SingleAxisLight) = Field(
        SphereLight(domain="sphere"), description="where viewpoints' lights are"
    )
    view_sets: list[ViewSet] = Field(
        min_length=1,
        default_factory=lambda scene: ["shadow", "surface"] if scene["ground"] else ["centre"],
        description="where cameras look: by default [shadow, surface] on a ground, else [centre]",
    )
    least_shadow: float = Field(
        0.0, ge=0, le=0.5, description="of each viewpoint's surface, that is in cast shadow"
    )
    seed: Seed | None = Field(None, description="without it the configuration's")


def mesh_name(scene: Scene) -> str:
    """What a scene's mesh is called in tables: what it is, not what it stands for."""
    if isinstance(scene.mesh, MeshFile):
        return Path(Path(scene.mesh.path).name.removesuffix(".gz")).stem
    return getattr(scene.mesh, "generate", None) or scene.mesh.download
