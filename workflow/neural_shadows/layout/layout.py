"""A checked configuration, the files of its run, and what each stage is given."""

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
    """Files and settings by the names in a configuration.

    Args:
        settings: what `config.resolved` gives.
        root: the checkout's folder, as seen from the working directory.
    """

    settings: Mapping[str, Any]
    root: str = "."

    @cached_property
    def paths(self) -> Paths:
        """Where the files of the run lie."""
        return Paths(self.settings["scale"])

    def source(self, name: str) -> str:
        """A file of the checkout that is neither configuration nor code."""
        return os.path.normpath(f"{self.root}/{name}")

    def entry(self, section: str, name: str) -> Mapping[str, Any]:
        """A named entry of a section.

        Raises:
            InputError: no such name; says which there are.
        """
        entries = self.settings[section]
        if name not in entries:
            raise InputError(f"{section}: {not_among(name, entries)}")
        return entries[name]

    def run(self) -> dict[str, Any]:
        """What a report says of the run that it was made in."""
        kept = ("width", "height", "reference")
        rendering = {key: self.settings["rendering"][key] for key in kept}
        return {"scale": self.settings["scale"], "seed": self.settings["seed"], **rendering}

    def scenes(self, names: Iterable[str]) -> dict[str, dict[str, Any]]:
        """What a report says of some scenes."""
        about = {}
        for name in names:
            scene = self.entry("scenes", name)
            generated = "generate" in scene["mesh"]
            about[name] = {"mesh_name": scene["mesh_name"], "procedural": generated}
            about[name]["seed"] = scene["seed"]
        return about

    def mesh_source(self, scene: str) -> str:
        """The file that a scene's mesh is read from: the user's own, or one that a rule makes."""
        mesh = self.entry("scenes", scene)["mesh"]
        made = "generated.ply" if "generate" in mesh else "downloaded.ply"
        return mesh["path"] if "path" in mesh else self.paths.scene(made, scene)

    def direction_light(self, scene: str, sampling: str) -> Mapping[str, Any] | None:
        """The light domain that view directions are drawn from; None for the whole sphere."""
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
        """What an experiment trains on, if it does, a ray set; and the mesh that its network is
        laid out by.
        """
        settings = self.entry("experiments", experiment)
        names = settings["scene"], settings["sampling"]
        found = dict.fromkeys(("directions_npy", "rays_json", "origins", "bounds"), [])
        if settings["training"] is not None:
            found = {
                "directions_npy": self.paths.rays("directions.npy", *names),
                "rays_json": self.paths.rays("rays.json", *names),
                **self.shards(*names),
            }
        needed = self.kind(experiment).needs_mesh
        return {
            "mesh_ply": [self.paths.scene("mesh.ply", names[0])] * needed,
            "mesh_json": [self.paths.scene("mesh.json", names[0])] * needed,
            **found,
        }

    def kind(self, experiment: str) -> type[NetworkModel]:
        """What the graph must know of an experiment's kind of network."""
        encoding = self.entry("experiments", experiment)["network"]["encoding"]
        return kinds(ENCODINGS)[encoding].Settings

    def is_trained(self, experiment: str) -> bool:
        """Whether an experiment's network is not only built."""
        return self.entry("experiments", experiment)["training"] is not None

    def can_use_gpu(self, method: str) -> bool:
        """Whether a method is a network of a kind that does; those without weights do not."""
        return _is_network(method) and self.kind(unbiased(method)).trained

    def export_files(self, experiment: str) -> dict[str, Any]:
        """What an export says of its network: the mesh's sphere, and the depth bias if found."""
        scene = self.entry("experiments", experiment)["scene"]
        mesh_json = self.paths.scene("mesh.json", scene)
        return {"mesh_json": mesh_json, "depth_bias_json": self.bias_file(scene, experiment)}

    def encodings(self, experiments: Iterable[str]) -> set[str]:
        """The kinds of networks of some experiments."""
        return {self.entry("experiments", name)["network"]["encoding"] for name in experiments}

    def view_range(self, batch: str) -> dict[str, int]:
        """First and last (exclusive) viewpoint of a batch in each view set."""
        first, last = view_range(self.settings["rendering"], batch)
        return {"first": first, "last": last}

    def held_out_views(self, scene: str) -> str:
        """The references of the viewpoints that the depth biases of a scene are found on."""
        return self.paths.reference(scene, HELD_OUT)

    def bias(self, method: str) -> float | str | None:
        """A method's depth bias: a number, `held_out`, or None if it has none."""
        if method != unbiased(method):
            return HELD_OUT
        return None if is_classic(method) else self.entry("experiments", method)["bias"]

    def bias_file(self, scene: str, method: str) -> list[str]:
        """The file of a method's depth bias, if it is one that is found."""
        found = self.bias(method) == HELD_OUT
        return [self.paths.depth_bias(scene, unbiased(method))] * found

    def weights(self, method: str) -> list[str]:
        """The weights of a method that is a network."""
        file = self.paths.network("weights.safetensors", unbiased(method))
        return [file] * _is_network(method)

    def evaluated_files(self, scene: str, method: str, batch: str) -> dict[str, Any]:
        """What a method's visibility comes from: a network's answers, or the mesh and a bias."""
        if _is_network(method):
            answers = self.paths.answers(scene, method, batch)
            return {"answers": answers, "mesh_ply": [], "depth_bias_json": []}
        mesh_ply = self.paths.scene("mesh.ply", scene)
        bias = self.bias_file(scene, method)
        return {"answers": [], "mesh_ply": mesh_ply, "depth_bias_json": bias}

    def method_encodings(self, method: str) -> set[str]:
        """The kind of network of a method that is one."""
        return self.encodings([unbiased(method)] * _is_network(method))


def _is_network(method: str) -> bool:
    return not is_classic(unbiased(method))
