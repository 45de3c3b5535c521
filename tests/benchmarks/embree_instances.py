"""Embree's own instances, which embreex does not bind."""

import ctypes
from collections.abc import Sequence

import numpy as np
from embree_rays import ADDRESS, EmbreeScene, embree

# Of Embree 4's headers rtcore_common.h and rtcore_geometry.h.
INSTANCE = 121
ROWS_OF_4 = 0x9134


class EmbreeInstances(EmbreeScene):
    """A tree over each object's triangles, and one over all instances.

    Args:
        meshes: vertices (V, 3) float32 and faces (F, 3) of each object.
        kinds: (n,) which of the meshes each instance is of. placements: (n, 4, 4).
    """

    def __init__(self, meshes: Sequence[tuple[np.ndarray, np.ndarray]], kinds, placements):
        super().__init__()
        library = embree()
        library.rtcSetGeometryInstancedScene.argtypes = [ADDRESS, ADDRESS]
        library.rtcSetGeometryTransform.argtypes = [ADDRESS, ctypes.c_uint, ctypes.c_int, ADDRESS]
        self._objects = [self._object(*mesh) for mesh in meshes]
        self._instances = []
        for kind in kinds:
            instance = library.rtcNewGeometry(self.device, INSTANCE)
            library.rtcSetGeometryInstancedScene(instance, self._objects[kind])
            library.rtcAttachGeometry(self.scene, instance)
            self._instances.append(instance)
        self.place(placements)

    def _object(self, vertices, faces) -> int:
        geometry = self.new_triangles(vertices, faces)
        scene = embree().rtcNewScene(self.device)
        embree().rtcAttachGeometry(scene, geometry)
        embree().rtcReleaseGeometry(geometry)  # the scene holds it
        embree().rtcCommitScene(scene)
        return scene

    def place(self, placements: np.ndarray) -> None:
        """Move the instances, and build the tree over them anew."""
        rows = np.ascontiguousarray(placements[:, :3], np.float32)
        for number, instance in enumerate(self._instances):
            embree().rtcSetGeometryTransform(instance, 0, ROWS_OF_4, rows[number].ctypes.data)
            embree().rtcCommitGeometry(instance)
        self.commit()

    def close(self) -> None:
        """Give all memory back."""
        for instance in self._instances:
            embree().rtcReleaseGeometry(instance)
        for scene in self._objects:
            embree().rtcReleaseScene(scene)
        super().close()
