"""Each stage whose cost is measured, run once in a process of its own.

python -m neural_shadows.evaluation.cost_stages '{"stage": "rays", "folder": …}'
"""

import json
import sys
import tempfile
import time
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from functools import partial
from pathlib import Path
from typing import Any

from neural_shadows.files.whole_files import write_json
from neural_shadows.running.process_memory import held_bytes, peak_bytes

POINTS_PER_DIRECTION = 10_000  # the thesis's [4.1]

SCENE = {"up": "y", "ground": True, "light": {"domain": "sphere", "min_elevation_deg": 20}}
SAMPLING = {
    "sampler": "poisson_quadtree",
    "points_per_direction": POINTS_PER_DIRECTION,
    "silhouette_resolution": 128,
    "min_quad": 1,
}
TRAINING = dict(optimiser="adam", steps=200, batch_size=1024, loss={})
TRAINING |= dict(learning_rate=1e-4, schedule="constant")

# Sizes of the run that warms a stage up: libraries loaded, kernels compiled.
TINY = dict(subdivisions=2, samples=POINTS_PER_DIRECTION, width=16, views=1, frame_width=48)

# The stages whose files each needs, and itself.
NEEDED = {
    "mesh": ("mesh",),
    "rays": ("mesh", "rays"),
    "labels": ("mesh", "rays", "labels"),
    "training": ("mesh", "rays", "labels", "training"),
    "evaluation": ("mesh", "evaluation"),
}

Work = Callable[[], object]


def bumpy_sphere(subdivisions: int):
    """A sphere with waves, which shadow each other, as a mesh of 20 · 4^subdivisions triangles."""
    import numpy as np
    import trimesh

    ball = trimesh.creation.icosphere(subdivisions)
    waves = np.sin(7 * ball.vertices).prod(axis=1, keepdims=True)
    return trimesh.Trimesh(ball.vertices * (1 + 0.3 * waves), ball.faces, process=False)


@dataclass(frozen=True)
class Stages:
    """By stage: lays out what the work is given on files in a folder, and gives the work itself."""

    folder: Path
    sizes: Mapping[str, int]
    settings: Mapping[str, Any]  # `seed`, `device` and `threads`

    def mesh(self) -> Work:
        from neural_shadows.meshes.prepare_mesh import prepare_mesh

        files = [self.folder / name for name in ("source.ply", "mesh.ply", "mesh.json")]
        bumpy_sphere(self.sizes["subdivisions"]).export(files[0])
        return partial(prepare_mesh, *files, mesh={}, name="bumpy sphere")

    def rays(self) -> Work:
        from neural_shadows.rays.draw_directions import draw_directions
        from neural_shadows.rays.sample_rays import sample_rays

        shard = self._shard()
        sampling = SAMPLING | {"directions": shard["last"]}
        given = {key: shard[key] for key in ("directions_npy", "seed")}
        draw_directions(**given, sampling=sampling)
        return partial(sample_rays, sampling=sampling, **shard)

    def labels(self) -> Work:
        from neural_shadows.rays.label_rays import label_rays

        return partial(label_rays, bounds_npy=self.folder / "bounds.npy", **self._shard())

    def _shard(self) -> dict[str, Any]:
        """What `sample_rays` and `label_rays` both take."""
        files = ("mesh.ply", "directions.npy", "origins.npy")
        given = {name.replace(".", "_"): self.folder / name for name in files}
        given |= {key: self.settings[key] for key in ("seed", "threads")}
        return given | {"first": 0, "last": self.sizes["samples"] // POINTS_PER_DIRECTION}

    def training(self) -> Work:
        from neural_shadows.training.train import train

        write_json(self.folder / "rays.json", {})
        return partial(
            train,
            directions_npy=self.folder / "directions.npy",
            origins=[self.folder / "origins.npy"],
            bounds=[self.folder / "bounds.npy"],
            rays_json=self.folder / "rays.json",
            mesh_ply=None,
            weights=self.folder / "trained" / "weights.safetensors",
            loss_csv=self.folder / "loss.csv",
            training_json=self.folder / "training.json",
            network=self._network(),
            training=TRAINING,
            experiment="cost",
            **self.settings,
        )

    def _network(self) -> dict[str, Any]:
        width = self.sizes["width"]
        return {"encoding": "frequency", "frequencies": 10, "width": width, "hidden_layers": 8}

    def evaluation(self) -> Work:
        """The reference, a shadow map and an untrained network on one thread, as each job has."""
        from neural_shadows.evaluation.evaluate import evaluate
        from neural_shadows.evaluation.query_network import query_network
        from neural_shadows.evaluation.render_references import render_references
        from neural_shadows.networks.kinds import make_network
        from neural_shadows.networks.weight_file import save_network

        names = ("mesh.ply", "references.safetensors", "untrained.safetensors", "lpips.json")
        mesh_ply, references, weights, lpips_json = (self.folder / name for name in names)
        network = make_network(self._network())
        network.initialise(self.settings["seed"])
        save_network(weights, network, {"network": self._network()})
        write_json(lpips_json, {"available": False})
        width = self.sizes["frame_width"]
        frames = {"width": width, "height": width * 2 // 3, "view_sets": ["surface"]}
        frames["seed"] = self.settings["seed"]
        batch = {"scene": SCENE, "frames": frames, "first": 0, "last": self.sizes["views"]}
        answers, device = self.folder / "answers.npz", self.settings["device"]
        queried = references, weights, None, mesh_ply, answers

        def work() -> None:
            render_references(mesh_ply, references, **batch)
            query_network(*queried, method="network", device=device)
            for method, file in {"shadow_map_512": None, "network": answers}.items():
                outputs = (self.folder / f"{method}.{ending}" for ending in ("csv", "npz"))
                inputs = references, file, mesh_ply, None, lpips_json
                evaluate(*inputs, *outputs, method=method, scene=SCENE)

        return work


def run_alone(
    stage: str, folder: Path, sizes: Mapping[str, int], settings: Mapping[str, Any]
) -> dict[str, float]:
    """Warm a stage up and run it: seconds, and memory in bytes. Arguments as of `Stages`."""
    with tempfile.TemporaryDirectory(dir=folder) as small:
        for needed in NEEDED[stage]:
            getattr(Stages(Path(small), TINY, settings), needed)()()
    work = getattr(Stages(folder, sizes, settings), stage)()
    before = held_bytes()
    started = time.perf_counter()
    work()
    seconds = time.perf_counter() - started
    peak = peak_bytes()
    return {"seconds": seconds, "bytes": max(0, peak - before), "peak_bytes": peak}


if __name__ == "__main__":
    job = json.loads(sys.argv[1])
    print(json.dumps(run_alone(**job | {"folder": Path(job["folder"])})))
