"""Measured values with a given truth, for claims' tests."""

import numpy as np
import pandas as pd
from report_samples import PUBLISHED, row

from neural_shadows.evaluation.violations import RANDOM
from neural_shadows.reports.claims.gates import judge
from neural_shadows.reports.claims.kinds.violations import COUNTS, LOWER, UPPER
from neural_shadows.reports.claims.measured import Measured
from neural_shadows.reports.data.learned import margins
from neural_shadows.reports.data.published import read_published
from neural_shadows.reports.data.trained import THESIS_SAMPLES

VIEWS = 24
# What views have in common is far larger than what methods differ by.
VIEW_LEVEL = np.random.default_rng(5).permutation(np.linspace(-0.05, 0.05, VIEWS))
INDEX = pd.MultiIndex.from_arrays(
    [np.arange(VIEWS) // 2, ["shadow", "surface"] * (VIEWS // 2)], names=["view", "view_set"]
).swaplevel()
PRINTED = pd.read_csv(PUBLISHED, dtype={"table": str})
MARGINS = margins(read_published(PUBLISHED))
# Of drawing no shadow, and of a method without values of its own.
WORST = {"lpips": 0.3, "psnr": 10.0, "ssim": 0.5}
FAIR = {"lpips": 0.1, "psnr": 30.0, "ssim": 0.9}


def views(mean, spread=0.002, seed=0):
    """Values of a metric by view (V,) with this mean."""
    noise = np.random.default_rng(seed).normal(0, spread, VIEWS)
    return mean + VIEW_LEVEL + noise - noise.mean()


def scene(methods, null=WORST):
    """Metrics of a scene.

    `methods`: {method: {metric: a mean, or values by view}}. Of the thesis's metrics each has `FAIR`
    values by default, no shadow the `WORST`.
    """
    methods = {method: FAIR | means for method, means in methods.items()}
    values = {
        (method, metric): value if np.ndim(value) else views(value, seed=(i, j))
        for i, (method, means) in enumerate({**methods, "no_shadow": WORST | null}.items())
        for j, (metric, value) in enumerate(means.items())
    }
    return pd.DataFrame(values, index=INDEX)


def loss_curve(end, start=1.0, points=100):
    """A loss curve, flat in its last tenth."""
    return pd.DataFrame({"loss": np.interp(np.arange(points), [0, 0.9 * points], [start, end])})


def record(samples=THESIS_SAMPLES, seed=0, **changes):
    """The part of a training.json for claims."""
    training = {"steps": samples // 1000, "batch_size": 1000, "seed": seed}
    defaults = {
        "samples": samples,
        "training": training,
        "no_shadow_loss": 0.5,
        "died_at_step": None,
    }
    return defaults | changes


def points(name, budgets, seeds):
    """The points of a learning curve."""
    return [
        {"experiment": f"{name}_{i}_{seed}", "samples": samples, "seed": seed}
        for i, samples in enumerate(budgets)
        for seed in range(seeds)
    ]


def measured(scenes=None, curves=None, **changes):
    """All measured values; the experiments are the curves' and `trainings`."""
    curves = curves or {}
    trainings = {point["experiment"]: record() for curve in curves.values() for point in curve}
    values = {
        "metrics": scenes or {},
        "losses": {},
        "trainings": trainings | changes.pop("trainings", {}),
        "times": {},
        "meshes": dict.fromkeys(scenes or (), {"thesis_mesh": True}),
        "scenes": dict.fromkeys(scenes or (), {"procedural": False}),
        "published": PRINTED,
        "margins": MARGINS,
        "curves": curves,
        "seed": 1,
    }
    return Measured(**values | changes)


def violated(false, leak, of_random=(20, 20)):
    """Counts of violated bounds by view.

    At 100 lit points and at 500 others; `false` and `leak`: at how many of each 100 that shows;
    `of_random`: both of random depths.
    """
    rng = np.random.default_rng(4)
    counts = {}
    for start, (of_lower, of_upper) in (("", (false, leak)), (RANDOM, of_random)):
        named = dict(zip(COUNTS, (200, 100, 0, 5000, 500, 0)))
        counts |= {start + name: np.full(VIEWS, float(count)) for name, count in named.items()}
        for name, share in ((LOWER[-1], of_lower), (UPPER[-1], 5 * of_upper)):
            counts[start + name] = rng.permutation(share + np.arange(VIEWS) % 3 - 1.0)
    return counts


def pairs(*named, scenes=None, built=()):
    """Pairs of rows.

    `scenes`: by method where not the dragon; `built`: those without training.
    """
    scenes = scenes or {}
    return [
        [row(name, scene=scenes.get(name, "dragon"), trained=name not in built) for name in pair]
        for pair in named
    ]


def better(*named, metrics=("lpips",), scenes=None, built=(), **needs):
    """A claim on pairs of methods."""
    rows = pairs(*named, scenes=scenes, built=built)
    return {"kind": "better", "rows": rows, "metrics": list(metrics), "needs": needs}


def verdict(claim, data):
    """The verdict of a claim alone."""
    return judge(claim, data)["verdict"]
