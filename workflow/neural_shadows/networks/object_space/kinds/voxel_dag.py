"""Voxels as an octree with equal parts stored once; untrained."""

from typing import ClassVar, Literal

from pydantic import Field

from neural_shadows.networks.settings.object_space import SURFACE, NetworkModel, Surface
from neural_shadows.settings.base import PowerOfTwo


class Settings(NetworkModel):
    """Voxels as an octree with equal parts stored once; untrained."""

    trained: ClassVar[bool] = False
    needs_mesh: ClassVar[bool] = True
    encoding: Literal["voxel_dag"] = Field(description="`voxel_dag`: voxels, not trained")
    resolution: PowerOfTwo = Field(1024, ge=8, le=4096, description="voxels of an axis")
    surface: Surface = Field(
        "auto", description=f"{SURFACE}. Voxels inside the object, or those that a sheet touches"
    )


def network_class() -> type:
    from neural_shadows.networks.untrained.voxel_dag_network import VoxelDagNetwork

    return VoxelDagNetwork
