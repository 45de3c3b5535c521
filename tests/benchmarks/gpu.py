"""What a GPU does of this project in some minutes, a little further with each call.

    python tests/benchmarks/gpu.py --minutes 9 --out DIR --mesh dragon_vrip_res2.ply.gz
        [--overlay config/lab.yaml] [--views 12] [--trunk squeeze.backbone.pth] [--work FOLDER]

In this order, each part once, whatever is in DIR already left out:

1. `checks.json`: does the GPU compute what the CPU does, recorded steps what plain ones do?
2. `rates.csv`: steps and queries a second, with and without the recorded step.
3. The learning curves of config/lab.yaml, training by training in the order of its list, in the
   files that the pipeline would write of them, below DIR/results. A training that the time cuts
   short leaves its state, and the next call goes on from there: give it the same DIR and arguments.

What is done so far becomes tables of learning curves and the claims that it decides, in
DIR/reports:

    python tests/benchmarks/gpu_report.py DIR [--overlay config/lab.yaml]

Needs no network, no Snakemake and no GPU program but PyTorch's. Imports beside this checkout:
torch, numpy, scipy, pandas, numba, scikit-image, safetensors, tqdm, yaml, and (small wheels, to be
carried along where they are not installed) embreex, trimesh, pydantic, pydantic-core,
annotated-types, typing-inspection, typing-extensions; with `--trunk` also lpips and torchvision,
without it flip-evaluator.

Quality is measured on the first `--views` viewpoints of each view set, without a depth bias, in
PSNR, SSIM and shadow error, with `--trunk` in LPIPS (squeeze) and else in FLIP, beside the null predictor
`no_shadow`. Rays and frames are made anew by each call, but for what `--work` holds.
"""

import argparse
import hashlib
import json
import os
import sys
import tempfile
import time
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import yaml

ROOT = Path(__file__).parents[2]
sys.path[:0] = [str(ROOT / "workflow")]

import torch  # noqa: E402
from gpu_checks import agreement  # noqa: E402
from gpu_curves import IMAGE_METRICS, run_curves  # noqa: E402
from gpu_data import Data  # noqa: E402
from gpu_rates import rates  # noqa: E402

from neural_shadows.config.reading import read_config  # noqa: E402
from neural_shadows.config.resolved import resolved  # noqa: E402
from neural_shadows.files.whole_files import read_json, write_json, write_text  # noqa: E402
from neural_shadows.layout.layout import Layout  # noqa: E402
from neural_shadows.networks.compute import choose_device  # noqa: E402

# The checks' own rays: enough for a few steps, and made in seconds.
SMALL = {"directions": 200, "points_per_direction": 2000}


def settings_of(overlay: Path, mesh: Path) -> dict[str, Any]:
    """The configuration as the pipeline resolves it."""
    values: dict[str, Any] = {}
    for path in (*(ROOT / "config" / name for name in ("config.yaml", "reports.yaml")), overlay):
        values = merged(values, yaml.safe_load(path.read_text(encoding="utf-8")))
    return resolved(read_config({**values, "dragon": str(mesh)}))


def merged(values: Any, overlay: Any) -> Any:
    """Sections merged and all else replaced, as Snakemake merges configuration files."""
    if not isinstance(values, dict) or not isinstance(overlay, dict):
        return overlay
    return values | {key: merged(values.get(key), part) for key, part in overlay.items()}


def keep_to(folder: Path, settings: dict[str, Any], mesh: Path, **given: Any) -> None:
    """Refuse a folder whose files were made from anything else."""
    sections = ("compute", "scenes", "samplings", "experiments", "learning_curves", "rendering")
    # Wherever the mesh lies: what is in it counts.
    made_from = json.dumps([settings[name] for name in sections], sort_keys=True)
    made_from = made_from.replace(json.dumps(str(mesh)), "")
    made = {
        "settings": hashlib.sha256(made_from.encode()).hexdigest(),
        "mesh": hashlib.sha256(mesh.read_bytes()).hexdigest(),
        **given,
    }
    settings_json = folder / "settings.json"
    if settings_json.exists() and read_json(settings_json) != made:
        sys.exit(f"{folder}: was made with other settings or of another mesh; name another folder")
    write_json(settings_json, made)


def main(arguments: Sequence[str] | None = None) -> None:
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("--minutes", type=float, default=9)
    parser.add_argument("--out", type=Path, required=True, help="results; resumed from it")
    parser.add_argument("--mesh", type=Path, required=True, help="the dragon: a mesh file")
    parser.add_argument("--overlay", type=Path, default=ROOT / "config" / "lab.yaml")
    parser.add_argument("--views", type=int, default=12, help="of each view set")
    parser.add_argument("--trunk", type=Path, help="weights of LPIPS's squeeze trunk")
    parser.add_argument("--work", type=Path, help="where rays are kept between calls")
    parser.add_argument("--device", default="cuda", help="cpu: to try this out")
    given = parser.parse_args(arguments)
    deadline = time.monotonic() + 60 * given.minutes
    with tempfile.TemporaryDirectory() as folder:
        given.work = given.work or Path(folder)
        work(given, choose_device(given.device), deadline)


def work(given: argparse.Namespace, device: torch.device, deadline: float) -> None:
    """Do what is left until `deadline` on the monotonic clock, and print what came of it."""
    torch.set_num_threads(1)  # a training has threads of its own
    settings = settings_of(given.overlay, given.mesh)
    keep_to(given.out, settings, given.mesh, views=given.views, lpips=given.trunk is not None)
    keep_to(given.work / "whole", settings, given.mesh)
    data = Data(settings, given.work / "whole", os.cpu_count() or 1, given.views)
    checks_json, rates_csv = given.out / "checks.json", given.out / "rates.csv"
    name = torch.cuda.get_device_name() if device.type == "cuda" else "cpu"
    if not checks_json.exists():
        sampling = settings["samplings"]["poisson_quadtree"]
        few = settings | {"samplings": {"poisson_quadtree": sampling | SMALL}}
        small = Data(few, given.work / "small", data.threads, given.views)
        rays, _ = small.rays("dragon", "poisson_quadtree")
        checks = agreement(device, rays, small.mesh("dragon"))
        write_json(checks_json, checks)
        for check in checks:
            print(*(f"{key}: {value}" for key, value in check.items()), sep=", ", flush=True)
    if not rates_csv.exists() and time.monotonic() < deadline:
        found = rates(device, name, data.mesh("dragon"))
        write_text(rates_csv, found.to_csv(index=False, lineterminator="\n", float_format="%.6g"))
        print(found.to_string(index=False, float_format="{:,.4g}".format, na_rep=""), flush=True)
    metrics = dict(IMAGE_METRICS)
    if given.trunk:
        from neural_shadows.metrics.lpips_distance import make_lpips

        metrics["lpips"] = make_lpips("squeeze", given.trunk, device.type)
    else:
        from neural_shadows.metrics.flip import flip

        metrics["flip"] = flip
    reason = None if given.trunk else "gpu.py was given no trunk"
    found = {"net": "squeeze", "trunk": None, "available": not reason, "reason": reason}
    write_json(given.out / Layout(settings).paths.lpips, found)
    left = run_curves(given.out, device, data, deadline, metrics)
    print(f"{len(left)} trainings of the learning curves are left", *left[:3], sep="\n  ")


if __name__ == "__main__":
    main()
