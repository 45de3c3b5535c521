"""Screen-space networks in the browser: visibility as by torch with the same half-precision weights."""

import numpy as np
import pytest
import torch
from built_networks import make_screen_network
from checkout import ROOT
from network_page import (
    EXECUTOR,
    HEADER,
    make,
    open_page,
    run,
    smooth_planes,
    with_random_statistics,
)
from shipped import shipped

from neural_shadows.networks.screen_space.screen_networks import load_screen_network
from neural_shadows.viewer.screen_arrays import screen_arrays, with_half_weights

SIZES = [(128, 256), (224, 192)]  # height, width
MOST_DRAWS, MOST_BYTES = 30, 20 << 10
# Largest differences: with maps in float32, and in halves.
EXACT = 1e-5
KERNELS, SQUARES = 2e-3, 4e-3
NETWORKS = {
    "kernels_basic": KERNELS,
    "kernels_enhanced": KERNELS,
    "kernels_rays": KERNELS,
    "nsm_layouts": SQUARES,
}
SHIPPED = ("kernels_enhanced", "kernels_rays")
TRIMMED = {"widths": [8, [6, 10], 12], "features": ["c_e", "ratio", "view"]}
OTHERS = {
    "half": TRIMMED | {"form": "half"},
    "full": TRIMMED | {"form": "full", "extraction": 5, "first_skip": True, "pool": "max"},
    "direct": {"form": "direct", "widths": [6, 8, 12], "features": ["c_e", "n", "behind"]},
}


def opened(name):
    """A network and its header: shipped weights, or ones before a training, with statistics."""
    if name in SHIPPED:
        return load_screen_network(ROOT / f"workflow/weights/{name}.safetensors")
    settings = shipped()["networks"].get(name) or OTHERS[name]
    network = with_random_statistics(make_screen_network(settings))
    if settings["form"] == "shuffle":
        # Its visibility has a deviation of 0.8 otherwise, more than any picture's.
        network.levels[0].decoder[-1].weight.data *= 0.4
    return network, HEADER | {"network": settings}


def expected(network, planes):
    with torch.inference_mode():
        return with_half_weights(network)(planes[None])[0, 0].numpy()


@pytest.fixture(scope="module")
def page(browser):
    """All networks share its programs."""
    page = open_page(browser)
    yield page
    page.close()


@pytest.mark.parametrize(
    ("name", "size"),
    [(name, size) for name in NETWORKS for size in SIZES] + [(name, (96, 64)) for name in OTHERS],
    ids=str,
)
def test_visibility_is_torchs(page, name, size):
    network, header = opened(name)
    data = screen_arrays(network, header)
    planes = smooth_planes(data["planes"], *size)
    visibility = expected(network, planes)
    assert visibility.std() > 0.05, "nothing to tell apart"
    for float, most in ((True, EXACT), (False, NETWORKS.get(name, SQUARES))):
        make(page, data, planes, float)
        result, draws = run(page)
        assert np.abs(result - visibility).max() <= most, f"float: {float}"
    assert draws == len(data["plan"]) <= MOST_DRAWS


def test_kernels_keep_to_a_surface(page):
    """Without the edge, taps beyond silhouettes would change the picture."""
    network, header = opened("kernels_rays")
    data = screen_arrays(network, header)
    planes = smooth_planes(data["planes"], *SIZES[0])
    make(page, data, planes)
    kept, _ = run(page)
    make(page, data | {"edge": None, "guide": None}, planes)
    across, _ = run(page)
    assert np.abs(kept - across).max() > 0.05


def test_networks_in_turn(page):
    """A layer of one, a layer of the other, and both again: no state is left behind."""
    visibility = {}
    for name in ("kernels_rays", "nsm_layouts"):
        network, header = opened(name)
        data = screen_arrays(network, header)
        planes = smooth_planes(data["planes"], 64, 128)
        visibility[name] = expected(network, planes)
        make(page, data, planes, name=name)
    page.evaluate(
        """(names) => {
          const runs = names.map((name) => networks[name].run());
          while (runs.map((run) => run.next()).some(({ done }) => !done));
        }""",
        list(visibility),
    )
    for name in visibility:
        result, _ = run(page, name)
        assert np.abs(result - visibility[name]).max() <= NETWORKS[name]


def test_another_size_compiles_nothing(page):
    network, header = opened("kernels_rays")
    data = screen_arrays(network, header)
    make(page, data, smooth_planes(data["planes"], 32, 64))
    run(page)
    page.evaluate(
        """() => {
          const { shaders, data } = networks[""];
          networks[""].free();
          gl.createProgram = () => { throw Error("compiles"); };
          const second = new ScreenNetwork(gl, shaders, data, 128, 96);
          for (const step of second.run());
          second.free();
          delete gl.createProgram;
          if (gl.getError()) throw Error("a WebGL error");
        }"""
    )


@pytest.mark.parametrize("size", [(128, 200), (100, 256)], ids=str)
def test_other_sizes_are_refused(page, size):
    data = screen_arrays(*opened("nsm_layouts"))
    with pytest.raises(Exception, match=f"{size[1]} × {size[0]}: .*Use multiples of 64 × 32"):
        make(page, data, torch.zeros(data["planes"], *size))


def test_a_lost_context_is_noticed(browser):
    page, data = open_page(browser), screen_arrays(*opened("kernels_rays"))
    make(page, data, smooth_planes(data["planes"], 32, 64))
    message = page.evaluate(
        """() => {
          const steps = networks[""].run();
          steps.next();
          gl.getExtension("WEBGL_lose_context").loseContext();
          try {
            while (!steps.next().done);
          } catch (error) {
            return error.message;
          }
        }"""
    )
    assert "Load the page again" in message


def test_executor_is_small():
    assert sum(path.stat().st_size for path in EXECUTOR) <= MOST_BYTES
