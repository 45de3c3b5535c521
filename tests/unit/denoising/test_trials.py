"""Filters that share their work among the settings of a search."""

import numpy as np
import pytest
from plate_frames import RADIUS, plate_frame

from neural_shadows.denoising.ffx import FfxTrials
from neural_shadows.denoising.sigma_ffx import SigmaFfxTrials
from neural_shadows.denoising.svgf import SvgfTrials

SETTINGS = {
    SvgfTrials: [
        {"sigma_luminance": sigma, "passes": passes}
        for sigma, passes in [(1, 5), (1, 2), (16, 2), (16, 3), (1, 3), (1, 0)]
    ],
    FfxTrials: [
        {"sigma": sigma, "passes": passes}
        for sigma, passes in [(1, 4), (1, 2), (2, 2), (2, 3), (1, 3), (1, 0)]
    ],
    SigmaFfxTrials: [
        {"sigma": sigma, "passes": passes, "reach": reach}
        for sigma, passes, reach in [(1, 3, 0.5), (4, 3, 0.5), (4, 1, 0), (4, 2, 0.5), (1, 3, 0.5)]
    ],
}


@pytest.mark.parametrize("kind", SETTINGS)
def test_settings_tried_one_after_another_are_each_as_alone(kind):
    surface = plate_frame().surface
    size, rng = (surface.height, surface.width), np.random.default_rng(6)
    first, second = (rng.random((2, *size)) < 0.5).astype(np.float32)
    together, answers = kind(*size), []
    for picture in (first, second, first.copy()):
        given = [picture]
        if kind is SigmaFfxTrials:
            given.append(np.where(picture < 1, np.float32(RADIUS / 2), np.float32(-1)))
        for setting in SETTINGS[kind]:
            answers.append(together.single(*given, surface, **setting).copy())
            assert np.array_equal(kind(*size).single(*given, surface, **setting), answers[-1])
    count = len(SETTINGS[kind])
    assert np.array_equal(answers[:count], answers[2 * count :])
    assert not np.array_equal(answers[0], answers[count])
    assert not np.array_equal(answers[0], answers[2])
