"""Embree's own instances, which embreex does not bind: its library is asked as C is, by numba.

One thread, single rays, as embreex asks them. Every allocation of the device is counted.
"""

import ctypes
from collections.abc import Sequence
from pathlib import Path

import embreex
import numpy as np
from numba import njit

from neural_shadows.scenes.tracing import NEARLY_ALL

# Of Embree 4's headers rtcore_common.h, rtcore_buffer.h and rtcore_geometry.h.
TRIANGLES, INSTANCE = 0, 121
INDICES, VERTICES = 0, 1
UINT3, FLOAT3, ROWS_OF_4 = 0x5003, 0x9003, 0x9134
_ADDRESS = ctypes.c_size_t
_COUNTED = ctypes.CFUNCTYPE(ctypes.c_bool, ctypes.c_void_p, ctypes.c_ssize_t, ctypes.c_bool)
_RAY_FLOATS, _ALIGNED = 12, 16  # of a ray in the library, and to how many bytes


def _library() -> ctypes.CDLL:
    """That which embreex brings."""
    (path,) = Path(embreex.__file__).parents[1].glob("embreex.libs/libembree4*")
    library = ctypes.CDLL(str(path))
    for name in ("rtcNewDevice", "rtcNewScene", "rtcNewGeometry"):
        getattr(library, name).restype = _ADDRESS
    library.rtcNewDevice.argtypes = [ctypes.c_char_p]
    library.rtcNewScene.argtypes = library.rtcCommitScene.argtypes = [_ADDRESS]
    library.rtcReleaseScene.argtypes = library.rtcReleaseGeometry.argtypes = [_ADDRESS]
    library.rtcReleaseDevice.argtypes = library.rtcCommitGeometry.argtypes = [_ADDRESS]
    library.rtcGetDeviceError.argtypes = [_ADDRESS]
    library.rtcNewGeometry.argtypes = [_ADDRESS, ctypes.c_int]
    library.rtcAttachGeometry.argtypes = [_ADDRESS, _ADDRESS]
    library.rtcSetGeometryInstancedScene.argtypes = [_ADDRESS, _ADDRESS]
    library.rtcSetGeometryTransform.argtypes = [_ADDRESS, ctypes.c_uint, ctypes.c_int, _ADDRESS]
    library.rtcSetSharedGeometryBuffer.argtypes = [
        _ADDRESS, ctypes.c_int, ctypes.c_uint, ctypes.c_int, *[_ADDRESS] * 4,
    ]  # fmt: skip
    library.rtcSetDeviceMemoryMonitorFunction.argtypes = [_ADDRESS, _COUNTED, _ADDRESS]
    library.rtcOccluded1.argtypes, library.rtcOccluded1.restype = [_ADDRESS] * 3, None
    return library


LIBRARY = _library()
_occluded = LIBRARY.rtcOccluded1


class EmbreeInstances:
    """A tree over each object's triangles, and one over all instances.

    Args:
        meshes: vertices (V, 3) float32 and faces (F, 3) of each object.
        kinds: (n,) which of the meshes each instance is of. placements: (n, 4, 4).
    """

    def __init__(self, meshes: Sequence[tuple[np.ndarray, np.ndarray]], kinds, placements):
        self.held = 0
        self._count = _COUNTED(self._counted)
        self._device = LIBRARY.rtcNewDevice(b"threads=1")
        LIBRARY.rtcSetDeviceMemoryMonitorFunction(self._device, self._count, 0)
        self._kept = []  # arrays that the library reads
        self._objects = [self._object(*mesh) for mesh in meshes]
        self.scene = LIBRARY.rtcNewScene(self._device)
        self._instances = []
        for kind in kinds:
            one = LIBRARY.rtcNewGeometry(self._device, INSTANCE)
            LIBRARY.rtcSetGeometryInstancedScene(one, self._objects[kind][0])
            LIBRARY.rtcAttachGeometry(self.scene, one)
            self._instances.append(one)
        self.place(placements)

    def _object(self, vertices, faces) -> tuple[int, int]:
        vertices = np.append(np.asarray(vertices, np.float32).ravel(), np.float32(0))  # reads by 16
        faces = np.ascontiguousarray(faces, np.uint32)
        self._kept += [vertices, faces]
        geometry = LIBRARY.rtcNewGeometry(self._device, TRIANGLES)
        for kind, form, data, count in (
            (VERTICES, FLOAT3, vertices, len(vertices) // 3),
            (INDICES, UINT3, faces, len(faces)),
        ):
            told = data.ctypes.data, 0, 12, count
            LIBRARY.rtcSetSharedGeometryBuffer(geometry, kind, 0, form, *told)
        LIBRARY.rtcCommitGeometry(geometry)
        scene = LIBRARY.rtcNewScene(self._device)
        LIBRARY.rtcAttachGeometry(scene, geometry)
        LIBRARY.rtcCommitScene(scene)
        return scene, geometry

    def _counted(self, user, size, after) -> bool:
        self.held += size
        return True

    @property
    def bytes(self) -> int:
        """In memory: what the device has allocated, and the triangles."""
        return self.held + sum(one.nbytes for one in self._kept)

    def place(self, placements: np.ndarray) -> None:
        """Move the instances, and build the tree over them anew."""
        rows = np.ascontiguousarray(placements[:, :3], np.float32)
        for one, instance in enumerate(self._instances):
            LIBRARY.rtcSetGeometryTransform(instance, 0, ROWS_OF_4, rows[one].ctypes.data)
            LIBRARY.rtcCommitGeometry(instance)
        LIBRARY.rtcCommitScene(self.scene)
        assert LIBRARY.rtcGetDeviceError(self._device) == 0

    def occluded(self, points: np.ndarray, towards: np.ndarray) -> np.ndarray:
        """See `Tracer.occluded`."""
        return self._asked(points, towards, np.inf)

    def blocked(self, points: np.ndarray, ways: np.ndarray) -> np.ndarray:
        """See `Tracer.blocked`."""
        return self._asked(points, ways, NEARLY_ALL)

    def _asked(self, points, ways, end: float) -> np.ndarray:
        found = np.zeros(len(points), bool)
        held = np.zeros(_RAY_FLOATS + _ALIGNED // 4, np.float32)
        first = -held.ctypes.data % _ALIGNED // 4
        _ask(self.scene, points, ways, np.float32(end), held[first : first + _RAY_FLOATS], found)
        return found

    def close(self) -> None:
        """Give all memory back."""
        for one in self._instances:
            LIBRARY.rtcReleaseGeometry(one)
        LIBRARY.rtcReleaseScene(self.scene)
        for scene, geometry in self._objects:
            LIBRARY.rtcReleaseGeometry(geometry)
            LIBRARY.rtcReleaseScene(scene)
        LIBRARY.rtcReleaseDevice(self._device)


@njit(nogil=True)
def _ask(scene, points, ways, end, ray, found):
    """Fill in `found`; `ray` is the library's, (12,) float32."""
    address, whole = ray.ctypes.data, ray.view(np.uint32)
    for one in range(len(points)):
        ray[0], ray[1], ray[2] = points[one, 0], points[one, 1], points[one, 2]
        ray[4], ray[5], ray[6] = ways[one, 0], ways[one, 1], ways[one, 2]
        ray[3], ray[7], ray[8] = 0, 0, end
        whole[9], whole[10], whole[11] = 0xFFFFFFFF, 0, 0
        _occluded(scene, address, 0)
        found[one] = ray[8] < 0
