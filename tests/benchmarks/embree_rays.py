"""Embree without a wrapper: its own library, sent rays from C, singly and in packets.

embreex sends single rays, from Python. What it brings is asked here as a C program would:
`embree_rays.c` is built with gcc against it.
"""

import ctypes
import shutil
import subprocess
from collections.abc import Callable, Mapping
from functools import cache, partial
from pathlib import Path
from tempfile import TemporaryDirectory

import embreex
import numpy as np

from neural_shadows.errors import InputError

SOURCE = Path(__file__).with_suffix(".c")
SINGLE, PACKETS, WIDE = (f"rtcOccluded{width} from C" for width in (1, 8, 16))
# Of Embree 4's headers rtcore_common.h, rtcore_buffer.h, rtcore_scene.h and
# rtcore_geometry.h.
TRIANGLES = 0
INDICES, VERTICES = 0, 1
UINT3, FLOAT3 = 0x5003, 0x9003
ROBUST = 4
ADDRESS = ctypes.c_size_t
INCOHERENT = ", not coherent"
_COUNTED = ctypes.CFUNCTYPE(ctypes.c_bool, ctypes.c_void_p, ctypes.c_ssize_t, ctypes.c_bool)


@cache
def embree() -> ctypes.CDLL:
    """The library that embreex brings, with the types of its functions.

    Raises:
        InputError: it brings none.
    """
    library = ctypes.CDLL(str(_path()))
    for name in ("rtcNewDevice", "rtcNewScene", "rtcNewGeometry"):
        getattr(library, name).restype = ADDRESS
    library.rtcNewDevice.argtypes = [ctypes.c_char_p]
    library.rtcNewScene.argtypes = library.rtcCommitScene.argtypes = [ADDRESS]
    library.rtcReleaseScene.argtypes = library.rtcReleaseGeometry.argtypes = [ADDRESS]
    library.rtcReleaseDevice.argtypes = library.rtcCommitGeometry.argtypes = [ADDRESS]
    library.rtcGetDeviceError.argtypes = [ADDRESS]
    library.rtcNewGeometry.argtypes = [ADDRESS, ctypes.c_int]
    library.rtcAttachGeometry.argtypes = [ADDRESS, ADDRESS]
    library.rtcSetSceneFlags.argtypes = [ADDRESS, ctypes.c_int]
    library.rtcSetSharedGeometryBuffer.argtypes = [
        ADDRESS, ctypes.c_int, ctypes.c_uint, ctypes.c_int, *[ADDRESS] * 4,
    ]  # fmt: skip
    library.rtcSetDeviceMemoryMonitorFunction.argtypes = [ADDRESS, _COUNTED, ADDRESS]
    return library


def _path() -> Path:
    places = list(Path(embreex.__file__).parents[1].glob("embreex.libs/libembree4*"))
    if len(places) != 1:
        raise InputError(
            f"embreex: {len(places)} files embreex.libs/libembree4* beside it, and not one: rays "
            "are sent to that library from C. Install embreex from its wheel for Linux"
        )
    return places[0]


@cache
def _compiled() -> ctypes.CDLL:
    """`embree_rays.c`, built for this processor.

    Raises:
        InputError: there is no gcc, or it fails.
    """
    if shutil.which("gcc") is None:
        raise InputError(
            f"gcc: not found: {SOURCE.name} is built with it, which sends rays to Embree as C does. "
            "Install it, or leave out the stages field and peers (--only)"
        )
    with TemporaryDirectory() as folder:
        built, path = Path(folder) / "embree_rays.so", _path()
        flags = ["-O3", "-march=native", "-shared", "-fPIC", "-Wall", "-Werror"]
        linked = [str(path), f"-Wl,-rpath,{path.parent}", "-o", str(built)]
        done = subprocess.run(["gcc", *flags, str(SOURCE), *linked], capture_output=True, text=True)
        if done.returncode:
            raise InputError(f"gcc: {SOURCE.name}: cannot be built: {done.stderr.strip()}. Mend it")
        embree()
        library = ctypes.CDLL(str(built))
    rays = [ADDRESS, ctypes.c_long, ADDRESS, ADDRESS, ctypes.c_long, ctypes.c_float]
    library.occluded_1.argtypes = [*rays, ADDRESS]
    for packets in (library.occluded_8, library.occluded_16):
        packets.argtypes = [*rays, ctypes.c_int, ADDRESS]
    return library


class EmbreeScene:
    """What rays are sent to: a device of one thread, whose memory is counted, and a scene."""

    def __init__(self):
        self.held = 0
        self._count = _COUNTED(self._counted)
        self.device = embree().rtcNewDevice(b"threads=1")
        embree().rtcSetDeviceMemoryMonitorFunction(self.device, self._count, 0)
        self.scene = embree().rtcNewScene(self.device)
        self._kept: list[np.ndarray] = []  # which the library reads

    def new_triangles(self, vertices: np.ndarray, faces: np.ndarray) -> int:
        """A geometry of the device: vertices (V, 3) and faces (F, 3), committed."""
        vertices = np.append(np.asarray(vertices, np.float32).ravel(), np.float32(0))  # reads by 16
        faces = np.ascontiguousarray(faces, np.uint32)
        self._kept += [vertices, faces]
        geometry = embree().rtcNewGeometry(self.device, TRIANGLES)
        for kind, form, data, count in (
            (VERTICES, FLOAT3, vertices, len(vertices) // 3),
            (INDICES, UINT3, faces, len(faces)),
        ):
            embree().rtcSetSharedGeometryBuffer(
                geometry, kind, 0, form, data.ctypes.data, 0, 12, count
            )
        embree().rtcCommitGeometry(geometry)
        return geometry

    def commit(self) -> None:
        """Build the scene's tree."""
        embree().rtcCommitScene(self.scene)
        assert embree().rtcGetDeviceError(self.device) == 0

    def _counted(self, user, size, after) -> bool:
        self.held += size
        return True

    @property
    def bytes(self) -> int:
        """In memory: what the device has allocated, and the triangles."""
        return self.held + sum(part.nbytes for part in self._kept)

    def single(self, points: np.ndarray, ways: np.ndarray, end: float = np.inf) -> np.ndarray:
        """Whether each ray meets anything before `end` of its way, (n,) bool; ray by ray.

        Args:
            points: (n, 3) float32. ways: the same, or (3,) for all.
        """
        occluded, rays = self._rays(points, ways, end)
        _compiled().occluded_1(*rays, occluded.ctypes.data)
        return occluded

    def packets(
        self,
        points: np.ndarray,
        ways: np.ndarray,
        end: float = np.inf,
        *,
        coherent: bool = True,
        width: int = 8,
    ) -> np.ndarray:
        """The same by 8 or 16 rays at a time, in their order.

        Args:
            coherent: whether Embree is to take them for alike.
        """
        occluded, rays = self._rays(points, ways, end)
        send = _compiled().occluded_8 if width == 8 else _compiled().occluded_16
        send(*rays, coherent, occluded.ctypes.data)
        return occluded

    def packet_forms(self, *rays) -> dict[str, Callable[[], np.ndarray]]:
        """Packets of 8 and 16, coherent or not, see `best_of_forms`; `rays` are as of `packets`."""
        return {
            name + note: partial(self.packets, *rays, coherent=coherent, width=width)
            for name, width in ((PACKETS, 8), (WIDE, 16))
            for note, coherent in (("", True), (INCOHERENT, False))
        }

    def _rays(self, points, ways, end) -> tuple[np.ndarray, tuple]:
        for rays in (points, ways):
            assert rays.dtype == np.float32 and rays.flags.c_contiguous
        assert ways.shape in (points.shape, (3,))
        stride = 0 if ways.ndim == 1 else 3
        addresses = points.ctypes.data, ways.ctypes.data
        return np.empty(len(points), bool), (self.scene, len(points), *addresses, stride, end)

    def close(self) -> None:
        """Give the scene's and the device's memory back."""
        embree().rtcReleaseScene(self.scene)
        embree().rtcReleaseDevice(self.device)


class EmbreeTriangles(EmbreeScene):
    """A tree over triangles.

    Args:
        vertices: (V, 3). faces: (F, 3).
        robust: whether no ray may slip between two triangles; embreex sets it, Embree does not.
    """

    def __init__(self, vertices: np.ndarray, faces: np.ndarray, *, robust: bool = False):
        super().__init__()
        embree().rtcSetSceneFlags(self.scene, ROBUST if robust else 0)
        geometry = self.new_triangles(vertices, faces)
        embree().rtcAttachGeometry(self.scene, geometry)
        embree().rtcReleaseGeometry(geometry)  # the scene holds it
        self.commit()


def best_of_forms(seconds: Mapping[str, float]) -> dict[str, float]:
    """Seconds by name, where of `packet_forms` the better one, coherent or not, stands for both."""
    return {
        name: min(value, seconds.get(name + INCOHERENT, value))
        for name, value in seconds.items()
        if not name.endswith(INCOHERENT)
    }


def check_compiled() -> None:
    """Build what sends rays before anything is measured; see `_compiled`."""
    _compiled()
