"""Measured values whose truth is known, for the tests of claims."""

import numpy as np
import pandas as pd
from report_samples import PUBLISHED, row

from neural_shadows.reports.claims.gates import judge
from neural_shadows.reports.claims.measured import THESIS_SAMPLES, Measured
from neural_shadows.reports.learned import margins
from neural_shadows.reports.published import read_published

VIEWS = 24
# What views have in common is far larger than what methods differ by.
VIEW_LEVEL = np.random.default_rng(5).permutation(np.linspace(-0.05, 0.05, VIEWS))
INDEX = pd.MultiIndex.from_arrays(
    [np.arange(VIEWS) // 2, ["shadow", "surface"] * (VIEWS // 2)], names=["view", "view_set"]
).swaplevel()
PRINTED = pd.read_csv(PUBLISHED, dtype={"table": str})
MARGINS = margins(read_published(PUBLISHED))
WORST = {"lpips": 0.3, "psnr": 10.0, "ssim": 0.5, "flip": 0.3}  # of drawing no shadow


def views(mean, spread=0.002, seed=0):
    """Values of a metric by view (V,), with this mean exactly."""
    noise = np.random.default_rng(seed).normal(0, spread, VIEWS)
    return mean + VIEW_LEVEL + noise - noise.mean()


def scene(methods, null=WORST):
    """Metrics of a scene from {method: {metric: a mean, or values by view}}."""
    values = {
        (method, metric): given if np.ndim(given) else views(given, seed=(i, j))
        for i, (method, means) in enumerate({**methods, "no_shadow": null}.items())
        for j, (metric, given) in enumerate(means.items())
    }
    return pd.DataFrame(values, index=INDEX)


def loss_curve(end, start=1.0, points=100):
    """A loss that falls to its end at nine tenths of the training, and stays there."""
    return pd.DataFrame({"loss": np.interp(np.arange(points), [0, 0.9 * points], [start, end])})


def record(samples=THESIS_SAMPLES, seed=0, **changes):
    """What claims read of a training.json."""
    known = {"samples": samples, "training": {"seed": seed}, "no_shadow_loss": 0.5}
    return {**known, **changes}


def points(name, budgets, seeds):
    """The points of a learning curve."""
    return [
        {"experiment": f"{name}_{i}_{seed}", "samples": samples, "seed": seed}
        for i, samples in enumerate(budgets)
        for seed in range(seeds)
    ]


def measured(scenes=None, curves=None, **changes):
    """Everything that claims are tested on; the experiments are the curves' and `trainings`."""
    curves = curves or {}
    known = {point["experiment"]: record() for some in curves.values() for point in some}
    given = {
        "metrics": scenes or {},
        "losses": {},
        "trainings": known | changes.pop("trainings", {}),
        "times": {},
        "meshes": dict.fromkeys(scenes or (), {"thesis_mesh": True}),
        "scenes": dict.fromkeys(scenes or (), {"procedural": False}),
        "published": PRINTED,
        "margins": MARGINS,
        "curves": curves,
        "seed": 1,
    }
    return Measured(**given | changes)


def pairs(*named, scenes=None):
    """Pairs of rows; `scenes` by method where not the dragon."""
    scenes = scenes or {}
    return [[row(name, scene=scenes.get(name, "dragon")) for name in pair] for pair in named]


def better(*named, metrics=("lpips",), scenes=None, **needs):
    """A claim on pairs of methods."""
    found = pairs(*named, scenes=scenes)
    return {"kind": "better", "pairs": found, "metrics": list(metrics), "needs": needs}


def verdict(claim, data):
    """The verdict of a claim alone."""
    return judge(claim, data)["verdict"]
