"""Few rays a pixel to the light, from centre or spread."""

from functools import partial

from neural_shadows.evaluation.look import GREEN, Look
from neural_shadows.evaluation.method import Method, rays_label

LOOK = Look("rays", GREEN, "o", "●", "Sends a few rays from each pixel to the light.", joined=True)
_SPREAD = Look(
    "rays, spread",
    GREEN,
    (8, 1, 0),
    "✴",
    "Sends each ray from another place of the pixel.",
    joined=True,
)


def _from_centres(*of_frame, samples: int):
    from neural_shadows.frames.ray_tracing import ray_traced

    return ray_traced(*of_frame, samples=samples)


def _from_spread(*of_frame, samples: int):
    from neural_shadows.frames.ray_tracing import spread

    return spread(*of_frame, samples=samples)


_BY_RAYS = {"texel_floats": 0, "by_rays": True}
METHODS = {
    **{
        f"rt_{count}": Method(
            partial(_from_centres, samples=count), label=rays_label(count), **_BY_RAYS
        )
        for count in (1, 2, 3, 4, 6, 8, 12, 16, 24, 32, 40, 64)
    },
    **{
        f"rt_{count}_spread": Method(
            partial(_from_spread, samples=count),
            label=f"{rays_label(count)}, spread",
            look=_SPREAD,
            **_BY_RAYS,
        )
        for count in (2, 4, 8)
    },
}
