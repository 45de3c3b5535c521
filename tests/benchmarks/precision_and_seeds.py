"""Whether bfloat16 products change where a training ends: three seeds in either format.

    python tests/benchmarks/precision_and_seeds.py results/rays/dragon/poisson_quadtree

Prints, for the thesis's network, the mean loss over fifths of the curve by format and seed, and
how far the formats' means lie apart beside the spread of the seeds.
"""

import argparse
import tempfile
from pathlib import Path

import numpy as np

from neural_shadows.training.loss_curve import read_loss
from neural_shadows.training.train import train

SEEDS = (1, 2, 3)
FIFTHS = 5


def loss_curve(rays: Path, folder: Path, steps: int, precision: str, seed: int) -> np.ndarray:
    """Mean loss in each fifth of a training at the desk scale's settings."""
    results = folder / "network"
    train(
        directions_npy=rays / "directions.npy",
        origins=sorted(rays.glob("origins.*.npy")),
        bounds=sorted(rays.glob("bounds.*.npy")),
        rays_json=rays / "rays.json",
        mesh_ply=None,
        weights=results / "weights.safetensors",
        loss_csv=results / "loss.csv",
        training_json=results / "training.json",
        network={"encoding": "frequency", "frequencies": 10, "width": 256, "hidden_layers": 8},
        training={
            "steps": steps,
            "batch_size": 1024,
            "learning_rate": 0.001,
            "schedule": "cosine",
            "loss": {},
        },
        seed=seed,
        experiment=f"{precision} {seed}",
        precision=precision,
        threads=2,
    )
    loss = read_loss(results / "loss.csv")["loss"].to_numpy()
    return np.array([part.mean() for part in np.array_split(loss, FIFTHS)])


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("rays", type=Path, help="folder of a ray set")
    parser.add_argument("--steps", type=int, default=5000)
    arguments = parser.parse_args()
    curves = {}
    for seed in SEEDS:
        for precision in ("bfloat16", "float32"):
            with tempfile.TemporaryDirectory() as folder:
                curve = loss_curve(arguments.rays, Path(folder), arguments.steps, precision, seed)
            curves.setdefault(precision, []).append(curve)
            print(f"{precision:8} seed {seed}: {'  '.join(f'{loss:.4f}' for loss in curve)}")
    ours, exact = (np.array(curves[precision]) for precision in ("bfloat16", "float32"))
    apart = np.abs(ours.mean(0) - exact.mean(0))
    spread = np.sqrt((ours.var(0, ddof=1) + exact.var(0, ddof=1)) / 2)
    print(f"apart:            {'  '.join(f'{value:.4f}' for value in apart)}")
    print(f"spread of seeds:  {'  '.join(f'{value:.4f}' for value in spread)}")


if __name__ == "__main__":
    main()
