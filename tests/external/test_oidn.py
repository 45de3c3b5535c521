"""Our way to Open Image Denoise beside its own C functions, called one by one."""

import ctypes
from importlib.metadata import distribution

import numpy as np
import pytest

from neural_shadows.denoising.oidn import QUALITIES, open_image_denoise

pytest.importorskip("pyoidn", reason="no pyoidn for this machine")

HEIGHT, WIDTH = 120, 176
# Of its header oidn.h.
CPU, FLOAT3, QUALITY = 1, 3, {"fast": 4, "high": 6}
_POINTER, _SIZE, _TEXT = ctypes.c_void_p, ctypes.c_size_t, ctypes.c_char_p


def _library() -> ctypes.CDLL:
    (path,) = (
        one for one in distribution("pyoidn").files if one.name == "libOpenImageDenoise.so.2"
    )
    library = ctypes.CDLL(str(path.locate()))
    library.oidnNewDevice.restype = library.oidnNewFilter.restype = _POINTER
    library.oidnNewDevice.argtypes = [ctypes.c_int]
    library.oidnNewFilter.argtypes = [_POINTER, _TEXT]
    library.oidnSetDeviceInt.argtypes = [_POINTER, _TEXT, ctypes.c_int]
    library.oidnSetDeviceBool.argtypes = [_POINTER, _TEXT, ctypes.c_bool]
    library.oidnSetFilterInt.argtypes = [_POINTER, _TEXT, ctypes.c_int]
    library.oidnSetFilterBool.argtypes = [_POINTER, _TEXT, ctypes.c_bool]
    library.oidnSetSharedFilterImage.argtypes = [
        _POINTER, _TEXT, _POINTER, ctypes.c_int, *[_SIZE] * 5,
    ]  # fmt: skip
    library.oidnGetDeviceError.argtypes = [_POINTER, ctypes.POINTER(_TEXT)]
    for name in ("CommitDevice", "CommitFilter", "ExecuteFilter", "ReleaseFilter", "ReleaseDevice"):
        getattr(library, f"oidn{name}").argtypes = [_POINTER]
    return library


def denoised(colour, albedo, normal, quality: str, hdr: bool) -> np.ndarray:
    """A picture (H, W, 3) without its noise."""
    library = _library()
    device = library.oidnNewDevice(CPU)
    library.oidnSetDeviceInt(device, b"numThreads", 1)
    library.oidnSetDeviceBool(device, b"setAffinity", False)
    library.oidnCommitDevice(device)
    network, output = library.oidnNewFilter(device, b"RT"), np.empty_like(colour)
    images = {b"color": colour, b"albedo": albedo, b"normal": normal, b"output": output}
    for name, image in images.items():
        height, width, _ = image.shape
        library.oidnSetSharedFilterImage(
            network, name, image.ctypes.data, FLOAT3, width, height, 0, 0, 0
        )
    library.oidnSetFilterInt(network, b"quality", QUALITY[quality])
    library.oidnSetFilterBool(network, b"hdr", hdr)
    library.oidnCommitFilter(network)
    library.oidnExecuteFilter(network)
    message = _TEXT()
    assert library.oidnGetDeviceError(device, message) == 0, message.value
    library.oidnReleaseFilter(network)
    library.oidnReleaseDevice(device)
    return output


@pytest.mark.parametrize("hdr", [False, True])
@pytest.mark.parametrize("quality", QUALITIES)
def test_the_same_picture(quality, hdr, measured):
    rng = np.random.default_rng(0)
    row, column = np.mgrid[:HEIGHT, :WIDTH]
    truth = np.clip((column - 40 + 0.3 * row) / 90, 0, 1)
    visibility = (rng.random((2, HEIGHT, WIDTH)) < truth).mean(0, dtype=np.float32)
    normal = np.zeros((HEIGHT, WIDTH, 3), np.float32)
    normal[row > 30] = [0, 0, 1]  # above it nothing is seen
    normal[(row > 30) & (column > 100)] = [0.6, 0.8, 0]
    depth = np.float32(2.0 ** (1 + column / WIDTH))
    # As our way has it: logarithms of depth where it sees; half as bright where 1 would be taken for cut off.
    full = 1 if hdr else 0.5
    colour = np.repeat(visibility[..., None] * np.float32(full), 3, axis=2)
    seen = normal.any(2)
    albedo = np.repeat((seen * column / (WIDTH - 1))[..., None], 3, axis=2).astype(np.float32)
    expected = np.clip(denoised(colour, albedo, normal, quality, hdr).mean(2) / full, 0, 1)
    found = open_image_denoise(
        visibility, normal, depth, quality=quality, light=0.0 if hdr else full
    )
    off = found - expected
    measured(
        f"OIDN {quality}, hdr {hdr}, ours beside its C functions: mean "
        f"{off.mean():+.1e}, rms {np.sqrt(np.mean(off**2)):.1e}, largest {np.abs(off).max():.1e}"
    )
    assert np.abs(off).max() < 1e-5
    assert np.mean((found - truth) ** 2) < 0.2 * np.mean((visibility - truth) ** 2)
