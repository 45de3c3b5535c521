"""A frame's shadow rays of one light, through a field and, in three forms, through triangles.

The same points for all, on one thread, from points in memory to a bool for each. Of the field also
the query alone: the rays' way to the unit sphere, which it needs and triangles do not, is found
before. From C Embree is without its flag ROBUST, which embreex sets, and faster for it, see
`bench_ray_peers.py`; of these frames all answers are the same.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from functools import partial

import numpy as np
import torch
from embree_rays import PACKETS, SINGLE, WIDE, EmbreeTriangles, best_of_forms
from measurement import Row, median_seconds

from neural_shadows.networks.object_space.occupancy_field_network import OccupancyFieldNetwork
from neural_shadows.networks.object_space.shadow_query import network_lit, on_device
from neural_shadows.networks.object_space.sphere_rays import SphereRays, sphere_rays
from neural_shadows.rendering.gbuffer import GBuffer
from neural_shadows.scenes.tracing import EmbreeSingly

FIELD, QUERY, EMBREEX = "field, from points to answers", "field, query alone", "embreex"
TRIANGLES = (EMBREEX, SINGLE, PACKETS, WIDE)


@dataclass(frozen=True, eq=False)
class ShadowRays:
    """A frame's points whose rays pass the unit sphere, and the light."""

    points: np.ndarray  # (k, 3) float32
    light: np.ndarray  # (3,) float32
    to_light: np.ndarray  # (k, 3), it for each
    entering: SphereRays
    pixels: int  # of the frame

    @classmethod
    def of_frame(cls, frame: GBuffer) -> "ShadowRays":
        """Those of its points that face the light."""
        points, light = on_device(frame.p, frame.view.light, torch.device("cpu"))
        points = points[sphere_rays(points, light).index]
        to_light = np.tile(light.numpy(), (len(points), 1))
        entering = sphere_rays(points, light)
        pixels = frame.width * frame.height
        return cls(points.numpy(), light.numpy(), to_light, entering, pixels)

    def field(self, network: OccupancyFieldNetwork) -> np.ndarray:
        """Whether each point is in shadow, (k,) bool, as `network_lit` has it of any points."""
        points, light = torch.from_numpy(self.points), torch.from_numpy(self.light)
        return ~network_lit(network, points, light, dtype=torch.float32)(0.0).numpy()

    def query(self, network: OccupancyFieldNetwork) -> np.ndarray:
        """The same of rays that are at the sphere already."""
        d = -torch.from_numpy(self.light)
        return ~network.lit(self.entering, d, torch.float32)(0.0).numpy()


class Triangles:
    """A mesh as embreex has it and as C has it."""

    def __init__(self, vertices: np.ndarray, faces: np.ndarray):
        self.vertices, self.faces, self.count = vertices, faces, len(faces)
        self.embreex = EmbreeSingly(vertices, faces)
        self.scene = EmbreeTriangles(vertices, faces)

    def occluded(self, frame: ShadowRays) -> np.ndarray:
        """Whether each of its points is in shadow, (k,) bool."""
        return self.embreex.occluded(frame.points, frame.to_light)

    def unlike(self, frames: Sequence[ShadowRays]) -> dict[str, int]:
        """How many answers to C are not embreex's."""
        differ = dict.fromkeys((SINGLE, PACKETS, WIDE), 0)
        for frame in frames:
            rays, exact = (frame.points, frame.light), self.occluded(frame)
            works = {SINGLE: partial(self.scene.single, *rays), **self.scene.packet_forms(*rays)}
            for name in differ:
                differ[name] += int((exact != works[name]()).sum())
        return differ


def rates(
    network: OccupancyFieldNetwork, triangles: Triangles, frame: ShadowRays, rounds: int
) -> dict[str, float]:
    """Rays a second by the field and through triangles; see `best_of_forms`."""
    rays, scene = (frame.points, frame.light), triangles.scene
    works = {
        FIELD: lambda: frame.field(network),
        QUERY: lambda: frame.query(network),
        EMBREEX: lambda: triangles.occluded(frame),
        SINGLE: lambda: scene.single(*rays),
        **scene.packet_forms(*rays),
    }
    seconds = best_of_forms(median_seconds(works, rounds, "thread_time"))
    return {name: len(frame.points) / value for name, value in seconds.items()}


def rate_rows(stage: str, rate: dict[str, float]) -> list[Row]:
    """All rates, beside that of packets."""
    return [
        Row(f"{stage}: {name}", "cpu x1", value, "rays/s", peer=PACKETS, peer_rate=rate[PACKETS])
        for name, value in rate.items()
    ]


def median_rows(stage: str, by_frame: Sequence[dict[str, float]]) -> list[Row]:
    """The field's rate over those through triangles: medians over frames."""
    return [
        Row(
            f"{stage}: {part}, over {rival}, median of {len(by_frame)} frames",
            "cpu x1",
            float(np.median([rate[part] / rate[rival] for rate in by_frame])),
            "×",
        )
        for part in (FIELD, QUERY)
        for rival in TRIANGLES
    ]


def total_rates(
    frames: Sequence[ShadowRays], by_frame: Sequence[dict[str, float]]
) -> dict[str, float]:
    """All frames' rays over all their seconds."""
    counts = np.array([len(frame.points) for frame in frames])
    return {
        name: counts.sum() / (counts / [rate[name] for rate in by_frame]).sum()
        for name in by_frame[0]
    }


def wrong_shares(
    network: OccupancyFieldNetwork, triangles: Triangles, frames: Sequence[ShadowRays]
) -> tuple[float, float]:
    """False shadow and leak of a field: the mean over frames, in per cent of their pixels."""
    shares = []
    for frame in frames:
        shadowed, exact = frame.field(network), triangles.occluded(frame)
        wrong = (shadowed & ~exact).sum(), (~shadowed & exact).sum()
        shares.append([100 * count / frame.pixels for count in wrong])
    return tuple(np.mean(shares, axis=0))
