"""Shadow queries by an oracle, against a ball's exact shadow."""

import numpy as np
import pytest
import torch

from neural_shadows.networks.object_space import sphere_rays
from neural_shadows.networks.object_space.shadow_network import ShadowNetwork
from neural_shadows.networks.object_space.shadow_query import on_device

BALL = 0.5  # radius of the occluder about the origin
BORDER = 1e-5  # points this near to a border of the shadow may go either way: float32 at |p| = 8


class Oracle(ShadowNetwork):
    """Stands in for a network."""

    device = torch.device("cpu")

    def initialise(self, seed):
        raise NotImplementedError


class BallOracle(Oracle):
    """The exact t_lb of rays at the ball.

    A ray that misses gets ℓ, what training asks for. The 5e-6 on top are what float32 costs
    ℓ = −2 o·d at |p| = 8; a network is as good with anything above ℓ.
    """

    def forward(self, origins, directions, dtype):
        b = (origins.double() * directions.double()).sum(1)
        discriminant = b**2 - (1 - BALL**2)
        hit = -b - discriminant.clamp(min=0).sqrt()
        return torch.where(discriminant > 0, hit, -2 * b + 5e-6).float()


class Constant(Oracle):
    """A network that predicts one depth."""

    def __init__(self, t: float):
        super().__init__()
        self.t = t

    def forward(self, origins, directions, dtype):
        return torch.full((len(origins),), self.t)


def lit(network, p, light, depth_bias=0.0) -> np.ndarray:
    return network.points_lit(*tensors(p, light), torch.float32)(depth_bias).numpy()


def tensors(p: np.ndarray, light: np.ndarray) -> tuple[torch.Tensor, torch.Tensor]:
    return on_device(p, light, torch.device("cpu"))


def points_at(light, radius, height) -> np.ndarray:
    """Points at distances `radius` from the line through 0 along the light, and at heights."""
    u = np.cross(light, [0.3, -0.5, 0.8])
    u /= np.linalg.norm(u)
    v = np.cross(light, u)
    angle = np.random.default_rng(2).uniform(0, 2 * np.pi, len(radius))
    across = radius * np.cos(angle) * u[:, None] + radius * np.sin(angle) * v[:, None]
    return (across + height * light[:, None]).T.astype(np.float32)


def exact(p, light) -> tuple[np.ndarray, np.ndarray]:
    """Lit by the ball, and whether the point is farther than `BORDER` from where that changes."""
    p = p.astype(float)
    along = p @ light
    squared = np.sum((p - along[:, None] * light) ** 2, axis=1)
    inside = np.sqrt(np.maximum(BALL**2 - squared, 0))
    shadowed = (squared < BALL**2) & (along < inside)
    # On the lit side of the ball the border is its surface, seen from the light.
    clear = np.abs(np.sqrt(squared) - BALL) > BORDER
    clear &= (squared > BALL**2) | (np.abs(along - inside) > BORDER)
    return ~shadowed, clear


LIGHTS = [(0.0, 1.0, 0.0), (0.48, 0.6, -0.64), (-0.8, 0.36, 0.48)]

REGIONS = {  # radius from the line through the centre along the light, height along the light
    "inside": ((0, 0.6), (-0.7, 0.7)),
    "behind": ((0, 0.99), (-3, -1)),
    "beside": ((1.01, 3), (-3, 3)),
    "in front": ((0, 0.99), (1, 3)),
    "around": ((0, 1.2), (-1.5, 1.5)),
}


def points_of(region: str, light: np.ndarray) -> np.ndarray:
    rng = np.random.default_rng(1)
    if region != "ground":
        radii, heights = REGIONS[region]
        return points_at(light, rng.uniform(*radii, 20_000), rng.uniform(*heights, 20_000))
    # A plane under the sphere, up to |p| = 8 away, and half of it in and about the shadow.
    p = rng.uniform(-8, 8, (40_000, 3))
    p[::2] = -light / light[1] + rng.uniform(-1.5, 1.5, (20_000, 3)) / light[1]
    p[:, 1] = -1
    return p[np.linalg.norm(p, axis=1) < 8].astype(np.float32)


@pytest.mark.parametrize("light", LIGHTS)
@pytest.mark.parametrize("region", [*REGIONS, "ground"])
def test_against_the_exact_shadow(region, light):
    """Behind the sphere also that s is clamped: rays that miss the ball are lit."""
    light = np.array(light)
    p = points_of(region, light)
    expected, clear = exact(p, light)
    assert clear.mean() > 0.999
    assert (lit(BallOracle(), p, light) == expected)[clear].all()
    share = (~expected).mean()
    assert share == 0 if region in ("beside", "in front") else 0.01 < share < 0.9


def test_depth_bias():
    """On the axis behind the front s is 1 + depth: lit as far as t_pred + depth_bias goes."""
    light = np.array([0.0, 1.0, 0.0])
    depth = np.linspace(-0.95, 3, 400)
    p = (-depth[:, None] * light).astype(np.float32)
    s = np.minimum(1 + depth, 2)
    for bias in (0.0, 0.1, 0.5):
        assert np.array_equal(lit(Constant(0.7), p, light, depth_bias=bias), s <= 0.7 + bias)
    # From 2 on, the chord, everything is lit.
    assert not lit(Constant(1.9), p, light).all()
    assert lit(Constant(1.9), p, light, depth_bias=0.1 + 1e-6).all()


@pytest.mark.parametrize("light", LIGHTS)
def test_loop_and_tensors_give_the_same_rays(light):
    """On a CPU and a GPU: as many, in the same order, of points up to the ground's rim."""
    light = np.array(light)
    p = np.concatenate([points_of(region, light) for region in REGIONS])
    p = torch.from_numpy(np.concatenate([p, 20 * p]))
    light = torch.from_numpy(light.astype(np.float32))
    on_cpu, by_tensors_rays = sphere_rays._in_one_pass(p, light), sphere_rays._by_tensors(p, light)
    assert 0.1 * len(p) < len(on_cpu.index) < 0.9 * len(p)
    assert torch.equal(on_cpu.index, by_tensors_rays.index)
    for part in ("origins", "s", "chord"):
        a, b = getattr(on_cpu, part), getattr(by_tensors_rays, part)
        assert a.dtype == b.dtype == torch.float32
        # Two roundings of |p| = 84, whose last bit is 8e-6; the shorter a chord, the more is left of it.
        away = (a - b).abs() if a.ndim == 1 else (a - b).abs().amax(1)
        assert (away * by_tensors_rays.chord).max() <= 4e-5
