"""Packets of eight rays, by the Embree library of embreex.

embreex itself traces single rays, with the same results: both build scenes with
`RTC_SCENE_FLAG_ROBUST`, so that no ray slips between two triangles. Of 8.3 million rays to lights of three
sizes one differed: blocked by packets alone, though neither finds a first hit. Shadow rays of two frames and
lights of four sizes took 1.1 to 3.0 times as long with embreex, in the median 1.5.

Constants and layouts are those of Embree 4's headers rtcore_common.h, rtcore_buffer.h,
rtcore_scene.h and rtcore_ray.h.
"""

import ctypes
import weakref
from functools import cache
from importlib.metadata import distribution

import llvmlite.binding as llvm
import numpy as np
from numba import njit, types

_TRIANGLES, _ROBUST = 0, 4
_INDICES, _VERTICES = 0, 1
_UINT3, _FLOAT3 = 0x5003, 0x9003
_ADDRESS = ctypes.c_size_t

WIDTH = 8  # rays of a packet, each a column of its rows
_ORIGIN, _NEAR, _DIRECTION, _TIME, _FAR, _MASK, _ID, _FLAGS = 0, 3, 4, 7, 8, 9, 10, 11
_U, _V, _FACE, _MESH, _INSTANCE = 15, 16, 17, 18, 19  # outputs of a first hit
_ACTIVE, _ARGUMENTS, _ROWS = 21, 22, 24
# Rays no further apart than this share of their length are traversed together (`_COHERENT`): occlusion up to
# 1.5 times as fast with small lights, first hits of pixels and distances to blockers 1.7 to 2.8 times; random
# rays would take 1.7 times as long.
_NARROW = 0.2
_COHERENT = 1 << 16
_FOREVER = 1e37  # the constant of embreex


def _library() -> ctypes.CDLL | None:
    """Embree's library from embreex's wheel, or None if absent."""
    names = ("libembree4", "embree4")
    paths = [path for path in distribution("embreex").files or () if path.name.startswith(names)]
    if not paths:
        return None
    library = ctypes.CDLL(str(paths[0].locate()))
    for name in ("rtcNewDevice", "rtcNewScene", "rtcNewGeometry", "rtcSetNewGeometryBuffer"):
        getattr(library, name).restype = _ADDRESS
    library.rtcNewDevice.argtypes = [ctypes.c_char_p]
    for name in (
        "rtcNewScene", "rtcCommitScene", "rtcReleaseScene", "rtcCommitGeometry",
        "rtcReleaseGeometry", "rtcGetDeviceError", "rtcGetDeviceLastErrorMessage",
    ):  # fmt: skip
        getattr(library, name).argtypes = [_ADDRESS]
    library.rtcGetDeviceLastErrorMessage.restype = ctypes.c_char_p
    library.rtcNewGeometry.argtypes = [_ADDRESS, ctypes.c_int]
    library.rtcSetSceneFlags.argtypes = [_ADDRESS, ctypes.c_int]
    library.rtcAttachGeometry.argtypes = [_ADDRESS, _ADDRESS]
    library.rtcSetNewGeometryBuffer.argtypes = [
        _ADDRESS, ctypes.c_int, ctypes.c_uint, ctypes.c_int, _ADDRESS, _ADDRESS,
    ]  # fmt: skip
    # Calls by name, not by address, allow caching compiled loops on disk.
    for name in ("rtcOccluded8", "rtcIntersect8"):
        llvm.add_symbol(name, ctypes.cast(getattr(library, name), ctypes.c_void_p).value)
    return library


LIBRARY = _library()
_query = types.void(*[types.intp] * 4)  # active lanes, scene, packet, arguments
_occluded8 = types.ExternalFunction("rtcOccluded8", _query)
_intersect8 = types.ExternalFunction("rtcIntersect8", _query)


@cache
def _device() -> int:
    """Embree device of the process, shared by threads."""
    device = LIBRARY.rtcNewDevice(None)
    _check(device)
    return device


def _check(device: int) -> None:
    code = LIBRARY.rtcGetDeviceError(device)
    if code:
        message = LIBRARY.rtcGetDeviceLastErrorMessage(device) or b"no message"
        raise RuntimeError(f"Embree: error {code}: {message.decode(errors='replace')}")


class EmbreePackets:
    """Embree's tree over a mesh; safe to share between threads.

    Args:
        vertices: (V, 3) positions, float32.
        faces: (F, 3) vertex indices, int32.

    Raises:
        RuntimeError: Embree cannot build the tree, for example without memory.
    """

    def __init__(self, vertices: np.ndarray, faces: np.ndarray):
        device = _device()
        self._scene = LIBRARY.rtcNewScene(device)
        weakref.finalize(self, LIBRARY.rtcReleaseScene, self._scene)
        LIBRARY.rtcSetSceneFlags(self._scene, _ROBUST)
        geometry = LIBRARY.rtcNewGeometry(device, _TRIANGLES)
        _copy(geometry, _VERTICES, _FLOAT3, np.ascontiguousarray(vertices, np.float32))
        _copy(geometry, _INDICES, _UINT3, np.ascontiguousarray(faces, np.int32))
        LIBRARY.rtcCommitGeometry(geometry)
        LIBRARY.rtcAttachGeometry(self._scene, geometry)
        LIBRARY.rtcReleaseGeometry(geometry)  # the scene holds it
        LIBRARY.rtcCommitScene(self._scene)
        _check(device)

    def occluded(
        self, origins: np.ndarray, directions: np.ndarray, end: float = _FOREVER
    ) -> np.ndarray:
        """Occlusion of each ray o + t d, 0 < t < end.

        Takes (n, 3) arrays; returns (n,) bool."""
        rays = _as_rays(origins, directions)
        hit = np.empty(len(origins), bool)
        _fill_occluded(self._scene, *rays, np.float32(end), _packet(), hit)
        return hit

    def first_hit(self, origins: np.ndarray, directions: np.ndarray, end: float = _FOREVER):
        """Nearest hit of each ray before `end`.

        Of hits at equal distances, which of them varies with the neighbouring rays.

        Returns t, face, u, v, each (n,); face is −1 without a hit."""
        rays = _as_rays(origins, directions)
        face = np.empty(len(origins), np.int32)
        t, u, v = np.empty((3, len(origins)), np.float32)
        _fill_hits(self._scene, *rays, np.float32(end), _packet(), t, face, u, v)
        return t, face, u, v


def _copy(geometry: int, kind: int, form: int, rows: np.ndarray) -> None:
    """Copy rows to a new Embree buffer, padded for 16-byte reads."""
    buffer = LIBRARY.rtcSetNewGeometryBuffer(geometry, kind, 0, form, 12, len(rows))
    if buffer:
        ctypes.memmove(buffer, rows.ctypes.data, rows.nbytes)


def _as_rays(origins: np.ndarray, directions: np.ndarray) -> list[np.ndarray]:
    """Origins and directions as (n, 3) float32, read-only: one type, compiled once."""
    shape = len(origins), 3
    rays = [
        np.ascontiguousarray(np.broadcast_to(rows, shape), np.float32).view()
        for rows in (origins, directions)
    ]
    for rows in rays:
        rows.flags.writeable = False
    return rays


def _packet() -> np.ndarray:
    """Zeros (_ROWS, WIDTH) float32, aligned to 32-byte rows."""
    raw = np.zeros((_ROWS + 1) * WIDTH, np.float32)
    first = -raw.ctypes.data % (4 * WIDTH) // 4
    return raw[first : first + _ROWS * WIDTH].reshape(_ROWS, WIDTH)


@njit(cache=True, nogil=True)
def _fill_occluded(scene, origins, directions, end, packet, hit):
    bits = packet.view(np.int32)
    for first in range(0, len(origins), WIDTH):
        count, narrow = _fill_packet(packet, bits, origins, directions, first, end)
        bits[_ARGUMENTS, 0] = _COHERENT if narrow else 0
        _occluded8(
            bits[_ACTIVE].ctypes.data, scene, packet.ctypes.data, bits[_ARGUMENTS].ctypes.data
        )
        for k in range(count):
            hit[first + k] = packet[_FAR, k] < 0


@njit(cache=True, nogil=True)
def _fill_hits(scene, origins, directions, end, packet, t, face, u, v):
    bits = packet.view(np.int32)
    for first in range(0, len(origins), WIDTH):
        count, narrow = _fill_packet(packet, bits, origins, directions, first, end)
        bits[_ARGUMENTS, 0] = _COHERENT if narrow else 0
        for k in range(WIDTH):
            bits[_MESH, k] = bits[_INSTANCE, k] = -1
        _intersect8(
            bits[_ACTIVE].ctypes.data, scene, packet.ctypes.data, bits[_ARGUMENTS].ctypes.data
        )
        for k in range(count):
            i, is_hit = first + k, bits[_MESH, k] != -1
            t[i] = packet[_FAR, k] if is_hit else np.inf
            face[i] = bits[_FACE, k] if is_hit else -1
            u[i], v[i] = packet[_U, k], packet[_V, k]


@njit(cache=True, nogil=True)
def _fill_packet(packet, bits, origins, directions, first, end):
    """Fill a packet from `first` on; return count and coherence."""
    count = min(WIDTH, len(origins) - first)
    apart = np.float32(0)
    length = np.float32(0)
    narrow = True
    for j in range(3):
        length += directions[first, j] ** 2
    for k in range(count):
        apart = np.float32(0)
        for j in range(3):
            packet[_ORIGIN + j, k] = origins[first + k, j]
            packet[_DIRECTION + j, k] = directions[first + k, j]
            apart += (origins[first + k, j] - origins[first, j]) ** 2
            apart += (directions[first + k, j] - directions[first, j]) ** 2
        packet[_NEAR, k], packet[_TIME, k], packet[_FAR, k] = 0, 0, end
        bits[_MASK, k], bits[_ID, k], bits[_FLAGS, k] = -1, 0, 0
        # False for NaN, which would spoil the results of neighbouring rays.
        narrow = narrow and apart < np.float32(_NARROW**2) * length
    for k in range(WIDTH):
        bits[_ACTIVE, k] = -1 if k < count else 0
    bits[_ARGUMENTS, 1] = -1  # all features
    return count, narrow
