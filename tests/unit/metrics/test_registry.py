"""Metrics are found by walking their folder; what they compute is what they declare."""

import subprocess
import sys
from types import ModuleType

import numpy as np
import pytest
from images import random_image

from neural_shadows.metrics import registry
from neural_shadows.metrics.metric import Metric, Pixels
from neural_shadows.settings.kinds import PACKAGE

SHAPE = random_image(0).shape
VISIBILITY, TARGET = 0.5 * random_image(0), random_image(1)
VALID = np.ones(SHAPE, bool)
PIXELS = Pixels(VALID, (TARGET > 0.5).astype(np.float32), VALID)
SOLIDS, WIDTHS = np.ones(SHAPE, np.float32), np.ones(SHAPE, np.float32)
ARGUMENTS = {
    "of_visibility": (VISIBILITY, TARGET, PIXELS),
    "of_occluders": (VISIBILITY, TARGET, VALID, SOLIDS, WIDTHS),
    "of_changes": ([np.full(5, 0.1)], 10),
}


@pytest.mark.parametrize("light", ["hard", "soft"])
def test_families_compute_the_metrics_that_they_declare(light):
    measured = dict(registry.image_metrics(light)(VISIBILITY, TARGET))
    for inputs, arguments in ARGUMENTS.items():
        measured |= registry.measure(inputs, light, *arguments)
    declared = {key for key, metric in registry.metrics().items() if light in metric.lights}
    assert measured.keys() == declared - {"lpips"}
    assert np.isfinite(measured["ssim"])


def test_a_key_is_of_one_family():
    keys = [key for family in registry.kinds(registry.FOLDER).values() for key in family.METRICS]
    assert len(keys) == len(set(keys)) == len(registry.metrics())


def test_slow_metrics_are_left_out():
    assert [*registry.image_metrics("soft", slow=False)(VISIBILITY, TARGET)] == ["ssim"]


def test_a_frames_points_have_errors_without_their_places():
    """As of hard shadows: (n,) points, no edges known."""
    points = Pixels(np.ones(3, bool))
    errors = registry.measure(
        "of_visibility", "hard", np.float32([1, 0, 1]), np.float32([1, 1, 1]), points
    )
    assert errors == {"shadow_error": 1 / 3, "false_shadow": 1 / 3, "light_leak": 0}


@pytest.fixture
def own(monkeypatch):
    """A module of the folder, for the while of a test."""
    module = ModuleType("worst")
    module.METRICS = {"worst": Metric("worst %", unit="%", factor=100, digits=1)}
    module.of_images = lambda image, reference: {"worst": float(np.abs(image - reference).max())}
    walked = {**registry.kinds(registry.FOLDER), "worst": module}
    monkeypatch.setattr(registry, "kinds", lambda folder: walked)
    caches = registry.families, registry.metrics
    for cached in caches:
        cached.cache_clear()
    yield module
    for cached in caches:
        cached.cache_clear()


def test_an_own_metric_is_measured_and_may_be_named(own):
    assert "worst" in registry.frame_metrics("hard") and "worst" in registry.frame_metrics("soft")
    values = registry.image_metrics("soft", slow=False)(VISIBILITY, TARGET)
    assert values["worst"] == pytest.approx(np.abs(VISIBILITY - TARGET).max())
    assert registry.error_of("worst", 0.3) == 0.3


def test_texts():
    metrics = registry.metrics()
    assert metrics["mse_off_edges"].text == "MSE × 10⁻⁴ off edges"
    assert metrics["l1"].text == "L1 in %" and metrics["l1"].heading == "L1 % ↓"
    assert metrics["mse"].score(3.14e-4) == "MSE 3.1 × 10⁻⁴"
    assert metrics["psnr"].score(27.386) == "PSNR 27.39 dB"


def test_reading_them_computes_nothing():
    """Snakemake reads the folder at each start."""
    code = "from neural_shadows.metrics import registry; registry.metrics(); import sys;"
    code += "print({*sys.modules} & {'torch', 'scipy.ndimage', 'skimage', 'onnxruntime'})"
    read = subprocess.check_output([sys.executable, "-c", code], cwd=PACKAGE.parent, text=True)
    assert read.strip() == "set()"
