"""Every reader of the project: a whole file of each kind, and what reads it."""

import hashlib
import io
import tarfile
import tempfile
from collections.abc import Callable
from copy import deepcopy
from functools import cache, partial
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
import pandas as pd
import torch
import torchvision
import trimesh
import yaml
from mesh_formats import WRITERS
from PIL import Image
from sample_records import COST, FRAME_TIMES, LPIPS, TRAINING

from neural_shadows.config.reading import check_duplicates, check_files, read_config
from neural_shadows.evaluation.depth_biases import read_depth_biases
from neural_shadows.evaluation.first_frames import read_first_frames
from neural_shadows.evaluation.frame_times import read_frame_times
from neural_shadows.evaluation.per_view_metrics import read_metrics
from neural_shadows.files import records
from neural_shadows.files.whole_files import write_json
from neural_shadows.layout.cluster_plan import read_measured
from neural_shadows.meshes.download_mesh import fetch_stanford_dragon
from neural_shadows.meshes.prepare_mesh import prepare_mesh
from neural_shadows.meshes.prepared_mesh import read_prepared
from neural_shadows.metrics.lpips_trunk import find_trunk
from neural_shadows.networks.kinds import make_network
from neural_shadows.networks.object_space.dead_zone_loss import DeadZone
from neural_shadows.networks.weight_file import load_network, save_network
from neural_shadows.rays.ray_set import RaySet
from neural_shadows.reports.figures.fronts import read_networks
from neural_shadows.reports.figures.widths import read_frame_time_table
from neural_shadows.reports.page import figure_block, table_block
from neural_shadows.reports.published import read_published
from neural_shadows.reports.run_facts import durations
from neural_shadows.reports.tables.comparison import METRICS
from neural_shadows.training.loss_curve import read_loss
from neural_shadows.training.training_run import TrainingRun

CONFIG = Path(__file__).parents[2] / "config"


class Reader(NamedTuple):
    """One kind of file."""

    file: str
    """The file that is broken."""
    make: Callable[[Path], None]
    """Write a whole one into a folder, with the files that belong to it."""
    read: Callable[[Path], None]
    """Read it from there."""


# --- meshes --------------------------------------------------------------------------------

BALL = trimesh.creation.icosphere(1)
OUT = "out"


def _make_mesh(file: str, folder: Path) -> None:
    (folder / file).write_bytes(WRITERS[file](BALL.vertices, BALL.faces))


def _read_mesh(file: str, folder: Path) -> None:
    out = folder / OUT
    prepare_mesh(folder / file, out / "mesh.ply", out / "mesh.json", name="thing")
    mesh = read_prepared(out / "mesh.ply")
    assert 0 <= mesh.faces.min() <= mesh.faces.max() < len(mesh.vertices)
    assert np.linalg.norm(mesh.vertices, axis=1).max() < 1 + 1e-4
    for normals in mesh.vertex_normals, mesh.face_normals:
        assert np.abs(np.linalg.norm(normals, axis=1) - 1).max() < 1e-5


def _make_prepared(folder: Path) -> None:
    _make_mesh("source.ply", folder)
    prepare_mesh(folder / "source.ply", folder / "mesh.ply", folder / "mesh.json", name="thing")
    (folder / "source.ply").unlink()


MEMBER = b"ply\n(not a real one)\n" * 100


def _make_archive(folder: Path) -> None:
    with tarfile.open(folder / "dragon_recon.tar.gz", "w:gz") as tar:
        for name, content in (("recon/README", b"about"), ("recon/dragon.ply", MEMBER)):
            info = tarfile.TarInfo(name)
            info.size = len(content)
            tar.addfile(info, io.BytesIO(content))


def _read_archive(folder: Path) -> None:
    fetch_stanford_dragon(
        folder / OUT / "dragon.ply",
        archive=folder / "dragon_recon.tar.gz",
        member="recon/dragon.ply",
        sha256=hashlib.sha256(MEMBER).hexdigest(),
    )


# --- rays, networks, trunk -----------------------------------------------------------------


def _make_rays(folder: Path) -> None:
    rng = np.random.default_rng(0)
    directions = rng.normal(size=(6, 3)).astype(np.float32)
    directions /= np.linalg.norm(directions, axis=1, keepdims=True)
    np.save(folder / "directions.npy", directions)
    np.save(folder / "origins.000.npy", np.repeat(-directions[:, None], 5, axis=1))
    np.save(folder / "bounds.000.npy", np.full((6, 5, 2), [2, np.inf], np.float32))


def _read_rays(folder: Path) -> None:
    rays = RaySet.in_folder(folder)
    assert rays.gather(np.arange(rays.count))[0].shape == (rays.count, 3)


NETWORKS = {
    "frequency": {"encoding": "frequency", "frequencies": 2, "width": 8, "hidden_layers": 2},
    "hash grid": {
        "encoding": "hash_grid",
        "points": 2,
        "grids": [4, 8],
        "channels": 2,
        "table_size": 256,
        "occupancy": 4,
        "width": 8,
        "hidden_layers": 1,
        "head": "depth",
        "stored": "int8",
    },
    "occupancy field": {
        "encoding": "occupancy_field",
        "resolution": 16,
        "surface": "solid",
        "stored": "int8",
    },
}


def _make_network(kind: str, folder: Path) -> None:
    network = make_network(NETWORKS[kind])
    if kind != "frequency":
        _make_prepared(folder)
        network.prepare(folder / "mesh.ply")
    network.initialise(0)
    header = {"name": "dragon", "network": NETWORKS[kind], "training": {}, "data": {}}
    save_network(folder / "weights.safetensors", network, header)


def _read_network(folder: Path) -> None:
    network, _ = load_network(folder / "weights.safetensors")
    origins = torch.tensor([[0.0, 0.0, 1.0]])
    with torch.inference_mode():
        assert network(origins, -origins, torch.float32).shape == (1,)


def _training_run() -> TrainingRun:
    return TrainingRun(make_network(NETWORKS["frequency"]), torch.device("cpu"), DeadZone(), 0)


def _make_state(folder: Path) -> None:
    run = _training_run()
    run.step.fill_(2)
    run.seconds, run.curve = 1.5, [[1, 0.1, 0.5], [2, 0.1, 0.25]]
    run.save(folder / "state.safetensors")


def _read_state(folder: Path) -> None:
    run = _training_run()
    run.restore(folder / "state.safetensors")
    run.curve_csv(64)


def _make_trunk(folder: Path) -> None:
    torch.manual_seed(0)
    model = torchvision.models.squeezenet1_1(weights=None)
    torch.save(model.features.state_dict(), folder / "trunk.pth")


def _read_trunk(folder: Path) -> None:
    weights = find_trunk("squeeze", folder / "trunk.pth", folder / "cache")
    with torch.device("meta"):
        model = torchvision.models.squeezenet1_1(weights=None)
    model.features.to_empty(device="cpu").load_state_dict(weights)


# --- tables and pictures -------------------------------------------------------------------


def _metrics() -> pd.DataFrame:
    return pd.DataFrame(
        [
            (view, "shadow", method, metric, 0.5)
            for view in (0, 1)
            for method in ("dragon", "shadow_map_256")
            for metric in METRICS
        ],
        columns=["view", "view_set", "method", "metric", "value"],
    )


def _make_csv(file: str, frame: Callable[[], pd.DataFrame], folder: Path) -> None:
    frame().to_csv(folder / file, index=False, lineterminator="\n")


def _loss() -> pd.DataFrame:
    columns = {"step": [1, 2], "samples": [64, 128], "learning_rate": [0.1, 0.1]}
    return pd.DataFrame(columns | {"loss": [0.5, 0.25]})


NUMBERS = dict.fromkeys(
    [
        *(f"{metric}{end}" for metric in ("lpips", "flip") for end in ("", "_low", "_high")),
        *("frame_ms", "frame_ms_q1", "frame_ms_q3", "thesis_lpips", "thesis_frame_ms"),
        *("bytes", "training_seconds"),
    ],
    [1.5, 2.5],
)


def _table() -> pd.DataFrame:
    texts = {"scene": ["dragon"] * 2, "method": ["Ours", "Map"], "encoding": ["frequency", ""]}
    return pd.DataFrame(texts | NUMBERS)


def _times() -> pd.DataFrame:
    jobs = ["dragon.poisson_quadtree.000", "dragon.poisson_quadtree.001"]
    return pd.DataFrame({"rule": ["sample_rays"] * 2, "job": jobs, "seconds": [1.5, 2.5]})


def _make_published(folder: Path) -> None:
    (folder / "published.csv").write_bytes((CONFIG / "published.csv").read_bytes())


def _make_frames(folder: Path) -> None:
    _make_csv("shadow.000.csv", _metrics, folder)
    frames = {name: np.full((8, 12), 128, np.uint8) for name in ("reference", "dragon")}
    np.savez_compressed(folder / "shadow.000.npz", **frames)


def _read_frames(folder: Path) -> None:
    (frame,) = read_first_frames([folder / "shadow.000.npz"], [folder / "shadow.000.csv"])
    for image in frame.images.values():
        Image.fromarray(image)


def _make_figure(folder: Path) -> None:
    (folder / "figure_4_8.svg").write_text("<svg>" + " " * 400_000 + "</svg>")  # the PNG is shown
    Image.new("L", (30, 20), 128).save(folder / "figure_4_8.png")


def _make_markdown(folder: Path) -> None:
    text = "# A table\n\n| method | LPIPS |\n| :--- | ---: |\n| ours | 0.1 |\n\n- A note.\n"
    (folder / "table_4_3.md").write_text(text)


def _make_benchmark(folder: Path) -> None:
    (folder / "benchmarks" / "train").mkdir(parents=True)
    (folder / "benchmarks" / "train" / "dragon.tsv").write_text("s\th:m:s\n12.5\t0:00:12\n")


# --- JSON, configuration -------------------------------------------------------------------

BIASES = {"dragon": {"depth_bias": 0.01, "errors": []}}

OVERLAY = {
    "scale": "mine",
    "networks": {"small": {"frequencies": 4, "width": 64, "hidden_layers": 2}},
    "trainings": {"short": {"steps": 20, "batch_size": 256, "learning_rate": 0.001}},
}


def _make_json(file: str, content: Any, folder: Path) -> None:
    write_json(folder / file, content)


def _make_overlay(folder: Path) -> None:
    (folder / "mine.yaml").write_text(yaml.safe_dump(OVERLAY))


def _read_overlay(folder: Path) -> None:
    from snakemake.utils import update_config  # as Snakemake merges them

    check_duplicates([folder / "mine.yaml"])
    values = deepcopy(_default_config())
    update_config(values, yaml.safe_load((folder / "mine.yaml").read_text()))
    check_files(read_config(values))


@cache
def _default_config() -> dict[str, Any]:
    return yaml.safe_load((CONFIG / "config.yaml").read_text())


def _reads(function: Callable, file: str) -> Callable[[Path], None]:
    return lambda folder: function(folder / file)


def _csv(file: str, frame: Callable[[], pd.DataFrame], function: Callable) -> Reader:
    return Reader(file, partial(_make_csv, file, frame), _reads(function, file))


def _json(file: str, content: Any, function: Callable) -> Reader:
    return Reader(file, partial(_make_json, file, content), _reads(function, file))


def _network_reader(kind: str) -> Reader:
    return Reader("weights.safetensors", partial(_make_network, kind), _read_network)


MESHES = {
    f"mesh {file}": Reader(file, partial(_make_mesh, file), partial(_read_mesh, file))
    for file in WRITERS
}
READERS = MESHES | {
    "prepared mesh": Reader("mesh.ply", _make_prepared, _reads(read_prepared, "mesh.ply")),
    "report on a mesh": Reader(
        "mesh.json", _make_prepared, _reads(records.read_mesh_report, "mesh.json")
    ),
    "archive": Reader("dragon_recon.tar.gz", _make_archive, _read_archive),
    **{
        f"rays: {name}": Reader(f"{name}.npy", _make_rays, _read_rays)
        for name in ("directions", "origins.000", "bounds.000")
    },
    **{f"network: {kind}": _network_reader(kind) for kind in NETWORKS},
    "training state": Reader("state.safetensors", _make_state, _read_state),
    "LPIPS trunk": Reader("trunk.pth", _make_trunk, _read_trunk),
    "metrics": _csv("shadow.000.csv", _metrics, lambda path: read_metrics([path])),
    "loss curve": _csv("loss.csv", _loss, read_loss),
    "table of frame times": _csv("table_4_6.csv", _table, read_frame_time_table),
    "table of networks": _csv(
        "beyond.csv", _table, lambda path: read_networks(path, "dragon", ["Ours", "Map"])
    ),
    "times for a plan": _csv("times.csv", _times, read_measured),
    "published numbers": Reader(
        "published.csv", _make_published, _reads(read_published, "published.csv")
    ),
    "Snakemake's benchmark": Reader(
        "benchmarks/train/dragon.tsv", _make_benchmark, _reads(durations, "benchmarks")
    ),
    "frames": Reader("shadow.000.npz", _make_frames, _read_frames),
    "figure": Reader(
        "figure_4_8.png",
        _make_figure,
        lambda folder: figure_block("A", folder / "figure_4_8.svg", folder / "figure_4_8.png"),
    ),
    "Markdown table": Reader("table_4_3.md", _make_markdown, _reads(table_block, "table_4_3.md")),
    "depth biases": _json("dragon.json", BIASES, read_depth_biases),
    "LPIPS choice": _json("lpips.json", LPIPS, records.read_lpips_choice),
    "record of a training": _json("training.json", TRAINING, records.read_training),
    "frame times": _json("times.json", FRAME_TIMES, lambda path: read_frame_times([path])),
    "costs": _json("cost.json", COST, records.read_cost),
    "config overlay": Reader("mine.yaml", _make_overlay, _read_overlay),
}


def load() -> None:
    """Read a whole file of each kind, so that all that readers import is loaded."""
    for name, reader in READERS.items():
        with tempfile.TemporaryDirectory() as folder:
            reader.make(Path(folder))
            try:
                reader.read(Path(folder))
            except Exception as error:
                raise RuntimeError(f"a whole file of {name} cannot be read") from error
