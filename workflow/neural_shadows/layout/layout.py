"""Files and settings of a run, by configured names."""

import os
from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from functools import cached_property
from typing import Any

from neural_shadows.errors import InputError
from neural_shadows.evaluation.method_names import is_classic, unbiased
from neural_shadows.layout.parts import HELD_OUT, part_names, part_range, view_range
from neural_shadows.layout.paths import Paths
from neural_shadows.networks.kind_module import ENCODINGS
from neural_shadows.networks.settings.object_space import NetworkModel
from neural_shadows.settings.base import not_among
from neural_shadows.settings.kinds import kinds


@dataclass(frozen=True)
class Layout:
    """Files and settings of a run, by configured names.

    Args:
        settings: result of `config.resolved`.
        root: the checkout's folder, relative to the working directory.
    """

    settings: Mapping[str, Any]
    root: str = "."

    @cached_property
    def paths(self) -> Paths:
        """Paths of the run's files."""
        return Paths(self.settings["scale"])

    def source(self, name: str) -> str:
        """Path of a data file in the checkout."""
        return os.path.normpath(f"{self.root}/{name}")

    def entry(self, section: str, name: str) -> Mapping[str, Any]:
        """A named entry of a section.

        Raises:
            InputError: no such name; lists the allowed ones.
        """
        entries = self.settings[section]
        if name not in entries:
            raise InputError(f"{section}: {not_among(name, entries)}")
        return entries[name]

    def run(self) -> dict[str, Any]:
        """Description of the run in reports."""
        keys = ("width", "height", "reference")
        rendering = {key: self.settings["rendering"][key] for key in keys}
        return {"scale": self.settings["scale"], "seed": self.settings["seed"], **rendering}

    def scenes(self, names: Iterable[str]) -> dict[str, dict[str, Any]]:
        """Descriptions of scenes in reports."""
        about = {}
        for name in names:
            scene = self.entry("scenes", name)
            generated = "generate" in scene["mesh"]
            about[name] = {"mesh_name": scene["mesh_name"], "procedural": generated}
            about[name]["seed"] = scene["seed"]
        return about

    def mesh_source(self, scene: str) -> str:
        """Source file of a scene's mesh: the user's, or a generated one."""
        mesh = self.entry("scenes", scene)["mesh"]
        file = "generated.ply" if "generate" in mesh else "downloaded.ply"
        return mesh["path"] if "path" in mesh else self.paths.scene(file, scene)

    def direction_light(self, scene: str, sampling: str) -> Mapping[str, Any] | None:
        """Domain of view directions; None for the whole sphere."""
        match self.entry("samplings", sampling)["domain"]:
            case "light":
                return self.entry("scenes", scene)["light"]
            case "hemisphere":
                return {"domain": "sphere", "min_elevation_deg": 0}
        return None

    def shard_range(self, sampling: str, shard: str) -> dict[str, int]:
        """First and last (exclusive) view direction of a shard."""
        settings = self.entry("samplings", sampling)
        first, last = part_range(settings["directions"], settings["shards"], int(shard))
        return {"first": first, "last": last}

    def shards(self, scene: str, sampling: str) -> dict[str, list[str]]:
        """All shards of a ray set."""
        parts = part_names(self.entry("samplings", sampling)["shards"])
        return {
            stem: [self.paths.rays(f"{stem}.{part}.npy", scene, sampling) for part in parts]
            for stem in ("origins", "bounds")
        }

    def training_files(self, experiment: str) -> dict[str, Any]:
        """Training rays of an experiment, and the mesh if needed."""
        settings = self.entry("experiments", experiment)
        names = settings["scene"], settings["sampling"]
        rays = dict.fromkeys(("directions_npy", "rays_json", "origins", "bounds"), [])
        if settings["training"] is not None:
            rays = {
                "directions_npy": self.paths.rays("directions.npy", *names),
                "rays_json": self.paths.rays("rays.json", *names),
                **self.shards(*names),
            }
        needed = self.kind(experiment).needs_mesh
        return {
            "mesh_ply": [self.paths.scene("mesh.ply", names[0])] * needed,
            "mesh_json": [self.paths.scene("mesh.json", names[0])] * needed,
            **rays,
        }

    def kind(self, experiment: str) -> type[NetworkModel]:
        """Settings class of an experiment's network."""
        encoding = self.entry("experiments", experiment)["network"]["encoding"]
        return kinds(ENCODINGS)[encoding].Settings

    def is_trained(self, experiment: str) -> bool:
        """Check for a training."""
        return self.entry("experiments", experiment)["training"] is not None

    def can_use_gpu(self, method: str) -> bool:
        """Check for a trained network."""
        return _is_network(method) and self.kind(unbiased(method)).trained

    def export_files(self, experiment: str) -> dict[str, Any]:
        """Files with a network's sphere and its depth bias, if held out."""
        scene = self.entry("experiments", experiment)["scene"]
        mesh_json = self.paths.scene("mesh.json", scene)
        return {"mesh_json": mesh_json, "depth_bias_json": self.bias_file(scene, experiment)}

    def encodings(self, experiments: Iterable[str]) -> set[str]:
        """Kinds of networks of experiments."""
        return {self.entry("experiments", name)["network"]["encoding"] for name in experiments}

    def view_range(self, batch: str) -> dict[str, int]:
        """First and last (exclusive) viewpoint of a batch, per view set."""
        first, last = view_range(self.settings["rendering"], batch)
        return {"first": first, "last": last}

    def held_out_views(self, scene: str) -> str:
        """References of a scene's held-out viewpoints, for depth biases."""
        return self.paths.reference(scene, HELD_OUT)

    def bias(self, method: str) -> float | str | None:
        """A method's depth bias: a number, `held_out`, or None."""
        if method != unbiased(method):
            return HELD_OUT
        return None if is_classic(method) else self.entry("experiments", method)["bias"]

    def bias_file(self, scene: str, method: str) -> list[str]:
        """File of a method's depth bias, if held out."""
        held_out = self.bias(method) == HELD_OUT
        return [self.paths.depth_bias(scene, unbiased(method))] * held_out

    def weights(self, method: str) -> list[str]:
        """File of a method's weights; empty without a network."""
        file = self.paths.network("weights.safetensors", unbiased(method))
        return [file] * _is_network(method)

    def evaluated_files(self, scene: str, method: str, batch: str) -> dict[str, Any]:
        """Inputs of a method's visibility: predictions, or mesh and bias."""
        if _is_network(method):
            answers = self.paths.answers(scene, method, batch)
            return {"answers": answers, "mesh_ply": [], "depth_bias_json": []}
        mesh_ply = self.paths.scene("mesh.ply", scene)
        bias = self.bias_file(scene, method)
        return {"answers": [], "mesh_ply": mesh_ply, "depth_bias_json": bias}

    def method_encodings(self, method: str) -> set[str]:
        """Kind of a method's network; empty without a network."""
        return self.encodings([unbiased(method)] * _is_network(method))


def _is_network(method: str) -> bool:
    return not is_classic(unbiased(method))
