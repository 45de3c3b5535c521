"""`scenes`: meshes in their unit sphere, and arrangements in metres."""

from pathlib import Path
from typing import Annotated, Any, Literal

from pydantic import Discriminator, Field, Tag

from neural_shadows.scenes.generated import generator_names
from neural_shadows.settings.base import EntryKind, Model, Seed, by_kind, has_key, name_in


class Wyrm(Model):
    """The procedural stand-in dragon."""

    generate: Literal["wyrm"] = Field(description="`wyrm`: a creature, the stand-in dragon")
    cells: int = Field(220, ge=48, le=1024, description="marching-cubes cells, longest axis")


class Fence(Model):
    """A panel of woven wire in a frame, standing on the ground [4.1.1]."""

    generate: Literal["fence"] = Field(description="`fence`: diagonally crossing round wires")
    wires: int = Field(16, ge=2, le=200, description="diamonds along the panel's width")
    wire_radius: float = Field(0.006, gt=0, le=0.1, description="in widths of the panel")


class Landscape(Model):
    """Height field with extrusions, one open sheet [4.1.1]."""

    generate: Literal["landscape"] = Field(description="`landscape`: one sheet of low frequency")
    cells: int = Field(256, ge=16, le=2048, description="grid cells along a side")


class City(Model):
    """Blocks of a city with courtyards, towers, a church and trees."""

    generate: Literal["city"] = Field(description="`city`: houses, a church and trees on a ground")
    blocks: int = Field(3, ge=1, le=12, description="along each side")
    seed: Seed = Field(5, description="of the houses and trees")


class Terrain(Model):
    """Eroded terrain with boulders, noisy as scans are: one open sheet."""

    generate: Literal["terrain"] = Field(
        description="`terrain`: a height field of ridges and valleys"
    )
    cells: int = Field(1024, ge=16, le=4096, description="grid cells along a side")
    seed: Seed = Field(5, description="of the land")


class DownloadedMesh(Model):
    """Mesh downloaded from the Stanford 3D Scanning Repository."""

    download: Literal["stanford_dragon"] = Field(
        description="`stanford_dragon`: dragon_vrip_res2.ply of its archive"
    )


class MeshFile(Model):
    """A mesh file of the user."""

    path: str = Field(
        min_length=1,
        description="a .ply, .obj, .stl or .glb file, also with .gz; relative to the working directory",
    )


# No key has these names: messages omit path elements that are not keys.
_TAGS = {"generate": "Generated", "download": "Downloaded", "path": "File"}


def _tag(mesh: Any) -> str | None:
    tags = [tag for key, tag in _TAGS.items() if has_key(mesh, key)]
    return tags[0] if len(tags) == 1 else None


WHERE_FROM = "one of {generate: wyrm, fence, landscape, city or terrain}, {download: stanford_dragon}, {path: FILE}"
Mesh = Annotated[
    Annotated[by_kind("generate", Wyrm, Fence, Landscape, City, Terrain), Tag("Generated")]
    | Annotated[DownloadedMesh, Tag("Downloaded")]
    | Annotated[MeshFile, Tag("File")],
    Discriminator(
        _tag,
        custom_error_type="mesh",
        custom_error_message=(
            f"should be {WHERE_FROM} (an overlay removes a key of the default by setting it to null)"
        ),
    ),
]


Elevation = Annotated[
    float, Field(ge=1, lt=90, description="least elevation of the light above the horizon, degrees")
]


class SphereLight(Model):
    """Light directions of a spherical cap around the zenith."""

    domain: Literal["sphere"] = Field(description="`sphere`: uniform over the cap's area")
    min_elevation_deg: Elevation = 20


class SingleAxisLight(Model):
    """Light directions on an arc: the sun's path [4.1.1]."""

    domain: Literal["single_axis"] = Field(description="`single_axis`: uniform in the angle")
    axis: Literal["x", "y", "z"] = Field(description="horizontal axis of the light's rotation")
    min_elevation_deg: Elevation = 20


ViewSet = Literal["shadow", "surface", "centre"]


class MeshScene(Model):
    """Mesh in its unit sphere, with ground, lights and views [4.1, 4.1.1].

    Named in a rendered frame set, it stands alone on the ground of a generated arrangement.
    """

    mesh: Mesh = Field(description=WHERE_FROM)
    up: Literal["x", "y", "z"] = Field("y", description="vertical axis of the mesh, pointing up")
    ground: bool = Field(True, description="ground plane below the mesh, receiving its shadow")
    light: by_kind("domain", SphereLight, SingleAxisLight) = Field(
        SphereLight(domain="sphere"), description="domain of light directions"
    )
    view_sets: list[ViewSet] = Field(
        min_length=1,
        default_factory=lambda scene: ["shadow", "surface"] if scene["ground"] else ["centre"],
        description="targets of cameras; default: [shadow, surface] with a ground, else [centre]",
    )
    least_shadow: float = Field(
        0.0, ge=0, le=0.5, description="least share of a viewpoint's visible surface in cast shadow"
    )
    seed: Seed | None = Field(
        None, description="of viewpoints and trainings; default: the global seed"
    )


MESH = EntryKind("a mesh (an entry with `mesh`)", lambda entry: has_key(entry, "mesh"))
MeshName = name_in("scenes", MESH)
STAGE = "stage"  # the generator for a mesh alone


class Arrangement(Model):
    """Generated arrangement in metres, with inserted meshes, lit by a sphere."""

    generate: Literal[tuple(generator_names())] = Field(
        description="generator of the scene, a file in workflow/neural_shadows/scenes/generators/"
    )
    inserted: list[MeshName] = Field(
        [],
        description="names of meshes in `scenes`, placed on the scene's spots in this order",
    )
    seed: int | None = Field(None, ge=0, description="seed of the layout; default: the global seed")
    new_layouts: bool = Field(
        False,
        description="a layout of its own for each part of its frames: of `shard` frames for training, of two "
        "for validation and tests. Interiors, courts, groves and passages differ wholly, others a little",
    )
    penumbra: float | None = Field(
        None,
        gt=0,
        le=1000,
        description="for `plate` only: sets the object's height by the 95th percentile of penumbra widths, in "
        "pixels of a 512² frame at 45° under a light of 0.25 m, by Neural Shadow Mapping's model",
    )


def _scene_tag(scene: Any) -> str | None:
    tags = [tag for key, tag in (("mesh", "Mesh"), ("generate", "Metres")) if has_key(scene, key)]
    return tags[0] if len(tags) == 1 else None


Scene = Annotated[
    Annotated[MeshScene, Tag("Mesh")] | Annotated[Arrangement, Tag("Metres")],
    Discriminator(
        _scene_tag,
        custom_error_type="scene",
        custom_error_message=(
            "needs either `mesh` (a mesh in its unit sphere) or `generate` (an arrangement in metres)"
        ),
    ),
]


def mesh_name(scene: MeshScene) -> str:
    """Name of a scene's mesh in tables."""
    if isinstance(scene.mesh, MeshFile):
        return Path(Path(scene.mesh.path).name.removesuffix(".gz")).stem
    return getattr(scene.mesh, "generate", None) or scene.mesh.download
