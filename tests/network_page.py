"""A page with the viewer's executor of screen-space networks, and networks and planes for it."""

import base64

import numpy as np
import torch
from built_networks import make_screen_network
from checkout import ROOT
from scipy.ndimage import gaussian_filter
from shipped import shipped

from neural_shadows.networks.screen_space.screen_network import ScreenNetwork
from neural_shadows.networks.screen_space.screen_networks import load_screen_network

REPORT = ROOT / "workflow/report"
EXECUTOR = [
    REPORT / "soft_viewer/screen_network.js",
    REPORT / "viewer/shaders/floats.glsl",
    *sorted((REPORT / "soft_viewer/shaders").glob("network_*")),
    *sorted((REPORT / "soft_viewer/shaders").glob("kernel_*")),
]
SHADERS = [REPORT / "viewer/shaders/screen.vert", *EXECUTOR[1:]]
SCRIPTS = [REPORT / "viewer/webgl.js", REPORT / "viewer/arrays.js", EXECUTOR[0]]
HEADER = {"radii": [0.0, 0.01], "radius_unit": "scene_sizes"}
# A network, its planes filled with numbers (layers, height, width, 4); all of a page share a context.
MAKE = """async ([name, data, shaders, planes, width, height, float]) => {
  window.gl ??= openWebgl(document.createElement("canvas"));
  window.networks ??= {};
  const arrays = { weights: await unpack(data.arrays.weights) };
  const network = new ScreenNetwork(gl, shaders, { ...data, arrays }, width, height, { float });
  networks[name]?.free();
  networks[name] = network;
  const bits = new Uint32Array(Uint8Array.from(atob(planes), (letter) => letter.charCodeAt(0)).buffer);
  gl.bindTexture(network.planes.kind, network.planes.texture);
  gl.texSubImage3D(network.planes.kind, 0, 0, 0, 0, width, height, bits.length / width / height / 4,
    gl.RGBA_INTEGER, gl.UNSIGNED_INT, bits);
}"""
DRAW = """(name) => {
  for (const step of networks[name].run());
  readFloats(gl, 1, 1); // waits for it
}"""
COUNT_DRAWS = "(name) => [...networks[name].run()].length"
READ = """(name) => {
  const { width, height, targets } = networks[name];
  gl.bindFramebuffer(gl.FRAMEBUFFER, targets.at(-1).framebuffer);
  const bytes = new Uint8Array(readFloats(gl, width, height).filter((_, i) => i % 4 === 0).buffer);
  let text = "";
  for (let i = 0; i < bytes.length; i += 4096) text += String.fromCharCode(...bytes.subarray(i, i + 4096));
  return { visibility: btoa(text), size: [height, width], error: gl.getError() };
}"""


def open_page(browser):
    """A page with the scripts and nothing else."""
    page = browser.new_page()
    page.add_script_tag(content="\n".join(path.read_text("utf-8") for path in SCRIPTS))
    return page


def make(page, data: dict, planes: torch.Tensor, float: bool = False, name: str = "") -> None:
    """Make a network of the page from its `screen_arrays` and planes (C, H, W)."""
    channels, height, width = planes.shape
    layers = np.zeros((-(-channels // 4), 4, height, width), np.float32)
    layers.reshape(-1, height, width)[:channels] = planes
    numbers = base64.b64encode(layers.transpose(0, 2, 3, 1).tobytes()).decode()
    page.evaluate(MAKE, [name, data, _shaders(), numbers, width, height, float])


def draw(page, name: str = "") -> None:
    """Draw all layers of a network of the page."""
    page.evaluate(DRAW, name)


def count_draws(page, name: str = "") -> int:
    """Draw all layers, and count them."""
    return page.evaluate(COUNT_DRAWS, name)


def read(page, name: str = "") -> np.ndarray:
    """Visibility (H, W) that a network of the page has drawn."""
    result = page.evaluate(READ, name)
    assert result["error"] == 0
    visibility = np.frombuffer(base64.b64decode(result["visibility"]), np.float32)
    return visibility.reshape(result["size"])


def opened(name: str) -> tuple[ScreenNetwork, dict]:
    """A network of the default configuration, and its header.

    Of shipped weights, or as before a training, with statistics by chance."""
    if (path := ROOT / f"workflow/weights/{name}.safetensors").exists():
        return load_screen_network(path)
    settings = shipped()["networks"][name]
    return with_random_statistics(make_screen_network(settings)), HEADER | {"network": settings}


def smooth_planes(count: int, height: int, width: int, seed: int = 0) -> torch.Tensor:
    """Planes (C, H, W) like features: smooth, between 0 and 1.4, with steps at silhouettes."""
    noise = np.random.default_rng(seed).normal(size=(count + 1, height, width))
    smooth = gaussian_filter(noise, (0, 6, 6), mode="nearest")
    smooth -= smooth.min((1, 2), keepdims=True)
    smooth /= smooth.max((1, 2), keepdims=True)
    nearer = smooth[-1] > 0.5
    return torch.from_numpy((smooth[:-1] + 0.4 * nearer).astype(np.float32))


def with_random_statistics(network: ScreenNetwork, seed: int = 0) -> ScreenNetwork:
    """The network as if trained: statistics of its input and its norms, and biases, by chance."""
    generator = torch.Generator().manual_seed(seed)
    for name, tensor in network.state_dict().items():
        chance = torch.rand(tensor.shape, generator=generator)
        if name.rpartition(".")[2] in ("running_var", "spreads"):
            tensor.copy_(0.5 + chance)
        elif name.rpartition(".")[2] in ("bias", "running_mean", "centres"):
            tensor.add_(0.4 * (chance - 0.5))
    return network


def _shaders() -> dict[str, str]:
    endings = {".glsl": "", ".frag": "_frag", ".vert": "_vert"}
    return {path.stem + endings[path.suffix]: path.read_text("utf-8") for path in SHADERS}
