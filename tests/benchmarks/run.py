"""Every stage's rate beside its ceiling and its peers, as one table.

    python tests/benchmarks/run.py [--quick]
        [--only rays field labels training queries viewpoint calls soft screen viewer gpu default]
        [--mesh dragon_vrip_res2.ply.gz] [--trunk squeeze.backbone.pth]
        [--weights results/networks/*/weights.safetensors]

Prints the table and writes it to reports/benchmarks.csv. `--quick` takes fewer rounds and leaves the
default main job out: under five minutes on two cores.
"""

import argparse
import sys
import tempfile
from collections.abc import Iterator
from pathlib import Path

sys.path.append(str(Path(__file__).parents[1]))  # what benchmarks share with tests

import bench_default
import bench_field
import bench_gpu
import bench_queries
import bench_rays
import bench_screen
import bench_screen_training
import bench_shadow_field
import bench_soft
import bench_training
import bench_viewer
import bench_viewpoint
from measurement import Row, table

from neural_shadows.errors import InputError
from neural_shadows.files.whole_files import write_text
from neural_shadows.meshes.get_mesh import get_mesh
from neural_shadows.meshes.prepare_mesh import prepare_mesh
from neural_shadows.running.hardware import describe_machine

STAGES = (
    "rays",
    "field",
    "labels",
    "training",
    "queries",
    "viewpoint",
    "calls",
    "soft",
    "screen",
    "viewer",
    "gpu",
    "default",
)
TABLE = Path("reports/benchmarks.csv")


def measure(arguments: argparse.Namespace, mesh_ply: Path) -> Iterator[list[Row]]:
    """The rows of each chosen stage, of a prepared mesh."""
    quick = arguments.quick
    measured = {
        "rays": lambda: bench_rays.packet_rows(quick),
        "field": lambda: bench_field.rows(mesh_ply, quick),
        "labels": lambda: bench_rays.label_rows(mesh_ply, quick),
        "training": lambda: bench_training.rows(quick),
        "queries": lambda: bench_queries.rows(mesh_ply, arguments.weights, quick),
        "viewpoint": lambda: bench_viewpoint.rows(mesh_ply, arguments.trunk, quick),
        "calls": lambda: bench_shadow_field.rows(mesh_ply, quick),
        "soft": lambda: bench_soft.rows(quick),
        "screen": lambda: bench_screen.rows(quick) + bench_screen_training.rows(quick),
        "viewer": lambda: bench_viewer.rows(quick),
        "gpu": lambda: bench_gpu.rows(quick),
        "default": bench_default.rows,
    }
    for stage in arguments.only:
        print(f"{stage} …", flush=True)
        yield measured[stage]()


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--quick", action="store_true")
    parser.add_argument("--only", nargs="+", choices=STAGES)
    parser.add_argument(
        "--mesh", type=Path, help="of any format; the default config's dragon if none"
    )
    parser.add_argument("--trunk", type=Path, help="of LPIPS; without it LPIPS is left out")
    parser.add_argument("--weights", type=Path, nargs="+", default=[], help="trained networks")
    arguments = parser.parse_args()
    if arguments.only is None:
        arguments.only = [stage for stage in STAGES if stage != "default" or not arguments.quick]
    print(", ".join(f"{key}: {value}" for key, value in describe_machine().items()))
    with tempfile.TemporaryDirectory() as folder:
        source, mesh_ply = arguments.mesh, Path(folder) / "mesh.ply"
        mesh = {"generate": "wyrm", "cells": 256}
        if source is None:
            source = Path(folder) / "made.ply"
            get_mesh(source, mesh)
        prepare_mesh(source, mesh_ply, Path(folder) / "mesh.json", mesh, "mesh")
        stages = measure(arguments, mesh_ply)
        rates = table([row for rows in stages for row in rows])
    print(rates.to_string(index=False, float_format="{:,.4g}".format, na_rep=""))
    write_text(TABLE, rates.to_csv(index=False, lineterminator="\n", float_format="%.6g"))


if __name__ == "__main__":
    try:
        main()
    except InputError as error:
        raise SystemExit(str(error)) from None
