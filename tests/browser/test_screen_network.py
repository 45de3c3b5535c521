"""Screen-space networks in the browser: visibility as by torch with the same half-precision weights."""

import numpy as np
import pytest
import torch
from built_networks import make_screen_network
from network_page import (
    EXECUTOR,
    HEADER,
    count_draws,
    draw,
    make,
    open_page,
    opened,
    read,
    smooth_planes,
    with_random_statistics,
)

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
TRIMMED = {"widths": [8, [6, 10], 12], "features": ["c_e", "ratio", "view"]}
OTHERS = {
    "half": TRIMMED | {"form": "half"},
    "full": TRIMMED | {"form": "full", "extraction": 5, "first_skip": True, "pool": "max"},
    "direct": {"form": "direct", "widths": [6, 8, 12], "features": ["c_e", "n", "behind"]},
}


def expected(network, planes):
    with torch.inference_mode():
        return with_half_weights(network)(planes[None])[0, 0].numpy()


@pytest.fixture(scope="module")
def page(browser):
    """All networks share its programs."""
    page = open_page(browser)
    yield page
    page.close()


@pytest.mark.parametrize("size", SIZES, ids=str)
@pytest.mark.parametrize("name", NETWORKS)
def test_visibility_is_torchs(page, name, size):
    network, header = opened(name)
    data = check(page, network, header, size, NETWORKS[name])
    assert len(data["plan"]) <= MOST_DRAWS


@pytest.mark.parametrize("name", OTHERS)
def test_visibility_of_other_forms(page, name):
    network = with_random_statistics(make_screen_network(OTHERS[name]))
    check(page, network, HEADER | {"network": OTHERS[name]}, (96, 64), SQUARES)


def check(page, network, header, size, most):
    """The network's data, after comparing pictures with torch's."""
    data = screen_arrays(network, header)
    planes = smooth_planes(data["planes"], *size)
    if "base" in data:
        planes[data["base"]] = (planes[data["base"]] > 0.6).float()
    visibility = expected(network, planes)
    assert visibility.std() > 5 * most, "nothing to tell apart"
    for float, difference in ((True, EXACT), (False, most)):
        make(page, data, planes, float)
        draws = count_draws(page)
        assert np.abs(read(page) - visibility).max() <= difference, f"float: {float}"
    assert draws == len(data["plan"])
    return data


def test_kernels_keep_to_a_surface(page):
    """Without the edge, taps beyond silhouettes would change the picture."""
    network, header = opened("kernels_rays")
    data = screen_arrays(network, header)
    planes = smooth_planes(data["planes"], *SIZES[0])
    make(page, data, planes)
    draw(page)
    kept = read(page)
    make(page, data | {"edge": None, "guide": None}, planes)
    draw(page)
    assert np.abs(kept - read(page)).max() > 0.05


def test_networks_in_turn(page):
    """A layer of one, a layer of the other: neither leaves a state that the other needs."""
    visibility = {}
    for name in ("kernels_rays", "kernels_basic"):
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
        assert np.abs(read(page, name) - visibility[name]).max() <= NETWORKS[name]


def test_another_size_compiles_nothing(page):
    network, header = opened("kernels_rays")
    data = screen_arrays(network, header)
    make(page, data, smooth_planes(data["planes"], 32, 64))
    draw(page)
    page.evaluate(
        """() => {
          const { shaders, data } = networks[""];
          networks[""].free();
          gl.createProgram = () => { throw Error("compiles"); };
          const second = new ScreenNetwork(gl, shaders, data, 128, 96);
          const steps = second.run();
          let step = steps.next();
          while (!step.done) step = steps.next();
          if (step.value !== second.targets.at(-1).textures[0]) throw Error("not what was drawn last");
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
