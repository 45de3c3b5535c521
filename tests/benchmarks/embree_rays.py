"""Embree's packets of eight rays from C, by the library that embreex brings.

`EmbreePackets` fills the same packets in Numba, and sets Embree's flag ROBUST. This is Embree at its
fastest: `embree_rays.c`, built by gcc for this processor, without that flag.
"""

import ctypes
import shutil
import subprocess
from functools import cache
from importlib.metadata import distribution
from pathlib import Path
from tempfile import TemporaryDirectory

import numpy as np

from neural_shadows.errors import InputError

SOURCE = Path(__file__).with_suffix(".c")
PACKETS = "rtcOccluded8 from C"
# Of Embree 4's headers rtcore_common.h, rtcore_buffer.h and rtcore_geometry.h.
_TRIANGLES, _INDICES, _VERTICES, _UINT3, _FLOAT3 = 0, 0, 1, 0x5003, 0x9003
_ADDRESS = ctypes.c_size_t
_COUNTED = ctypes.CFUNCTYPE(ctypes.c_bool, ctypes.c_void_p, ctypes.c_ssize_t, ctypes.c_bool)


@cache
def _libraries() -> tuple[ctypes.CDLL, ctypes.CDLL]:
    """Embree, and `embree_rays.c` linked with it.

    Raises:
        InputError: no gcc, or a build that fails.
    """
    names = [path for path in distribution("embreex").files or () if "libembree4" in path.name]
    if not names or shutil.which("gcc") is None:
        missing = "libembree4 in embreex" if not names else "gcc"
        raise InputError(
            f"{missing}: not found: {SOURCE.name} sends rays to Embree as C does. Install gcc, and "
            "embreex from its wheel for Linux, or leave out the stage field (--only)."
        )
    path = Path(names[0].locate())
    with TemporaryDirectory() as folder:
        built = Path(folder) / "embree_rays.so"
        flags = ["-O3", "-march=native", "-shared", "-fPIC", f"-Wl,-rpath,{path.parent}"]
        command = ["gcc", *flags, SOURCE, path, "-Wl,--allow-shlib-undefined", "-o", built]
        done = subprocess.run(command, capture_output=True, text=True)
        if done.returncode:
            raise InputError(f"gcc: {SOURCE.name}: cannot be built: {done.stderr.strip()}")
        embree, rays = ctypes.CDLL(str(path)), ctypes.CDLL(str(built))
    for name in ("rtcNewDevice", "rtcNewScene", "rtcNewGeometry"):
        getattr(embree, name).restype = _ADDRESS
    addresses = {
        "rtcNewScene": 1, "rtcCommitScene": 1, "rtcReleaseScene": 1, "rtcReleaseDevice": 1,
        "rtcCommitGeometry": 1, "rtcReleaseGeometry": 1, "rtcAttachGeometry": 2,
        "rtcGetDeviceError": 1,
    }  # fmt: skip
    for name, count in addresses.items():
        getattr(embree, name).argtypes = [_ADDRESS] * count
    embree.rtcNewDevice.argtypes = [ctypes.c_char_p]
    embree.rtcNewGeometry.argtypes = [_ADDRESS, ctypes.c_int]
    embree.rtcSetSharedGeometryBuffer.argtypes = [
        _ADDRESS, ctypes.c_int, ctypes.c_uint, ctypes.c_int, *[_ADDRESS] * 4,
    ]  # fmt: skip
    embree.rtcSetDeviceMemoryMonitorFunction.argtypes = [_ADDRESS, _COUNTED, _ADDRESS]
    rays.occluded_8.argtypes = [
        _ADDRESS, ctypes.c_long, _ADDRESS, _ADDRESS, ctypes.c_long, ctypes.c_float, ctypes.c_int,
        _ADDRESS,
    ]  # fmt: skip
    return embree, rays


class EmbreeTriangles:
    """A tree over triangles, on a device of one thread whose memory is counted.

    Args:
        vertices: (V, 3). faces: (F, 3).
    """

    def __init__(self, vertices: np.ndarray, faces: np.ndarray):
        embree, self._rays = _libraries()
        self.vertices, self.faces, self.held = vertices, faces, 0
        self._count = _COUNTED(self._counted)
        self._device = embree.rtcNewDevice(b"threads=1")
        embree.rtcSetDeviceMemoryMonitorFunction(self._device, self._count, 0)
        self._scene = embree.rtcNewScene(self._device)
        # Embree reads 16 bytes of a vertex.
        kept = np.append(np.float32(vertices).ravel(), np.float32(0)), np.uint32(faces)
        self._kept, geometry = kept, embree.rtcNewGeometry(self._device, _TRIANGLES)
        buffers = (
            (_VERTICES, _FLOAT3, kept[0], len(vertices)),
            (_INDICES, _UINT3, kept[1], len(faces)),
        )
        for kind, form, data, count in buffers:
            embree.rtcSetSharedGeometryBuffer(
                geometry, kind, 0, form, data.ctypes.data, 0, 12, count
            )
        embree.rtcCommitGeometry(geometry)
        embree.rtcAttachGeometry(self._scene, geometry)
        embree.rtcReleaseGeometry(geometry)  # the scene holds it
        embree.rtcCommitScene(self._scene)
        assert embree.rtcGetDeviceError(self._device) == 0

    def _counted(self, user, size, after) -> bool:
        self.held += size
        return True

    @property
    def bytes(self) -> int:
        """In memory: what the device has allocated, and the triangles."""
        return self.held + sum(part.nbytes for part in self._kept)

    def occluded(
        self,
        points: np.ndarray,
        directions: np.ndarray,
        end: float = np.inf,
        *,
        coherent: bool = True,
    ) -> np.ndarray:
        """Occlusion of rays, (n,) bool.

        Args:
            points: (n, 3) float32. directions: the same, or (3,) for all.
            end: in lengths of the directions. coherent: Embree is to take the rays for alike.
        """
        occlusion = np.empty(len(points), bool)
        stride = 0 if directions.ndim == 1 else 3
        addresses = points.ctypes.data, directions.ctypes.data, stride, end, coherent
        self._rays.occluded_8(self._scene, len(points), *addresses, occlusion.ctypes.data)
        return occlusion

    def close(self) -> None:
        """Return the tree's memory."""
        embree, _ = _libraries()
        embree.rtcReleaseScene(self._scene)
        embree.rtcReleaseDevice(self._device)
