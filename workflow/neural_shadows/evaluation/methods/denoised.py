"""Ray tracing with few rays a pixel, then a denoiser."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from functools import partial

from neural_shadows.evaluation.look import BLUE, ORANGE, PINK, SKY, YELLOW, Look
from neural_shadows.evaluation.method import Method, rays_label


@dataclass(frozen=True)
class Denoiser:
    """A denoiser of `method_parts.denoisers`, with its ray counts.

    Args:
        tried, joint, of_history: its constants, see `Method`. history: uses previous frames of
            sequences.
    """

    label: str
    look: Look
    counts: Sequence[int] = (1, 2, 4)
    tried: Mapping[str, Sequence[float]] = field(default_factory=dict)
    joint: bool = False
    history: bool = True
    of_history: Mapping[str, Sequence[float]] = field(default_factory=dict)
    package: str | None = None


def _look(filter_: str, colour: str, marker: str, symbol: str, rays_are: str) -> Look:
    return Look(f"rays, {filter_}", colour, marker, symbol, f"Rays, {rays_are}", joined=True)


# x86-64 only. Which of its networks leaves less, and at which value of full light, depends on rays and
# light; 0 is the network of any range. Under suns 0.85 and 1 left half of what 0.5 does.
_OIDN = {
    "tried": {"light": (0.0, 0.25, 0.5, 0.7, 0.85, 1.0)},
    "history": False,
    "package": "pyoidn",
}
# Steps of √2: by three passes of 4 to 8 rays 0.7 leaves 6 to 8 % less than 0.5 and 1. The least are of use with
# a history, the largest with one pass, and with one ray under a large light.
_SIGMA = (0.25, 0.35, 0.5, 0.7, 1.0, 1.4, 2.0, 2.8, 4.0, 5.6, 8.0, 11.3)
# In print three passes, of one ray with a history; of eight rays without one two or one leave up to 30 % less.
_PASSES = (0, 1, 2, 3, 4)
# In print 0.05 and 0.5. Where lights, cameras and objects move by 0.4 % of the scene's size a frame that clamp
# left 5 times what 0.03 leaves (one ray, validation sequences). The clamp is chosen first: at the middle
# clamp the best share was 1, which is no history, and then no clamp has an effect.
_FFX_HISTORY = {
    "clamp": (0.0, 0.03, 0.06, 0.125, 0.25, 0.5, 1.0, 2.0),
    "share": (0.0, 0.05, 0.1, 0.2, 0.4, 0.7, 1.0),
}
DENOISERS = {
    "svgf": Denoiser(
        "SVGF-like",
        _look("SVGF-like filter", PINK, "v", "▼", "smoothed within surfaces."),
        (1, 2, 4, 5, 30),  # NSM has 5, kernel prediction 30
        # In print σ is 4 and passes are five [4.3, 4.4]; of visibility fewer left 10 to 44 % less, by σ_z of 1.
        # One after the other, the two left up to 1.8 times what they leave together. σ of 64 and 128 leave 1.6 and
        # 2.2 % less than 32 at most (four rays, validation frames): the weight is all but gone at 64.
        {"sigma_luminance": (0.5, 1.0, 2.0, 4.0, 8.0, 16.0, 32.0, 64.0), "passes": (0, 1, 2, 3, 5)},
        joint=True,
        of_history={"share": (0.1, 0.2, 0.4, 0.7, 0.85, 1.0)},
    ),
    "ffx": Denoiser(
        "FFX-like",
        _look("FFX-like filter", SKY, ">", "►", "smoothed within surfaces by the fewest taps."),
        (1, 2, 3, 4, 6, 8, 12),
        tried={"sigma": _SIGMA, "passes": _PASSES},
        joint=True,
        of_history=_FFX_HISTORY,
    ),
    "sigma": Denoiser(
        "SIGMA-like",
        _look("SIGMA-like filter", BLUE, "d", "♦", "blurred by the distances to occluders."),
        tried={"reach": (0.12, 0.25, 0.5, 0.7, 1.0, 1.4, 2.0)},
        of_history={"clamp": (0.25, 0.5, 1.0, 2.0, 3.0), "share": (0.125, 0.25, 0.5, 0.75, 1.0)},
    ),
    "sigma_ffx": Denoiser(
        "SIGMA- and FFX-like",
        _look(
            "SIGMA- and FFX-like filters",
            YELLOW,
            "H",
            "⬣",
            "blurred by distances, then smoothed within surfaces.",
        ),
        # One after the other, in two rounds, they left up to 18 % more of one ray (`frames`), with sigma and
        # passes together and then the reach still 13 %.
        tried={
            "reach": (0.0, 0.03, 0.06, 0.12, 0.25, 0.5),
            "sigma": (
                *_SIGMA[2:],
                16.0,
                32.0,
            ),  # up to 11.3, that was the best of four rays on `nsm`
            "passes": _PASSES,
        },
        joint=True,
        of_history=_FFX_HISTORY,
    ),
    "oidn_fast": Denoiser(
        "OIDN fast",
        _look("Open Image Denoise fast", ORANGE, "x", "✕", "denoised by a smaller network."),
        **_OIDN,
    ),
    "oidn": Denoiser(
        "OIDN",
        _look("Open Image Denoise", ORANGE, "X", "✖", "denoised by a network."),
        **_OIDN,
    ),
}


def _visibility(*of_frame, **settings):
    from neural_shadows.evaluation.method_parts.denoisers import denoised

    return denoised(*of_frame, **settings)


def _sequence(radius, **settings):
    from neural_shadows.evaluation.method_parts.denoisers import sequence_denoiser

    return sequence_denoiser(radius, **settings)


METHODS = {
    f"rt_{count}_{key}": Method(
        partial(_visibility, samples=count, denoiser=key),
        denoiser.tried,
        joint=denoiser.joint,
        of_history=denoiser.of_history,
        label=f"{rays_label(count)}, {denoiser.label}",
        package=denoiser.package,
        look=denoiser.look,
        sequence=partial(_sequence, samples=count, denoiser=key) if denoiser.history else None,
        texel_floats=0,
        by_rays=True,
    )
    for key, denoiser in DENOISERS.items()
    for count in denoiser.counts
}
