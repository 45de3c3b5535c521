"""A checked configuration, the files of its run, and what each stage reads."""

import os
from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from functools import cached_property
from typing import Any

from pydantic import TypeAdapter

from neural_shadows.config.base import not_among
from neural_shadows.config.networks import Network
from neural_shadows.errors import InputError
from neural_shadows.evaluation.method_names import experiment_of, is_shadow_map
from neural_shadows.layout.parts import HELD_OUT, batches, part_range, view_range
from neural_shadows.layout.paths import Paths

_NETWORK = TypeAdapter(Network)


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
        rendering = self.settings["rendering"]
        kept = {key: rendering[key] for key in ("width", "height", "reference")}
        return {"scale": self.settings["scale"], "seed": self.settings["seed"], **kept}

    def scenes(self, names: Iterable[str]) -> dict[str, dict[str, Any]]:
        """What a report says of some scenes."""
        found = {}
        for name in dict.fromkeys(names):
            scene = self.entry("scenes", name)
            found[name] = {
                "mesh_name": scene["mesh_name"],
                "procedural": "generate" in scene["mesh"],
                "seed": scene["seed"],
            }
        return found

    # Meshes and rays

    def mesh_source(self, scene: str) -> str:
        """The file that a scene's mesh is read from: the user's own, or one that a rule makes."""
        mesh = self.entry("scenes", scene)["mesh"]
        if "path" in mesh:
            return mesh["path"]
        made = "generated" if "generate" in mesh else "downloaded"
        return self.paths.scene(f"{made}.ply", scene)

    def direction_light(self, scene: str, sampling: str) -> Mapping[str, Any] | None:
        """The light domain that view directions are drawn from; None for the whole sphere."""
        match self.entry("samplings", sampling)["domain"]:
            case "light":
                return self.entry("scenes", scene)["light"]
            case "hemisphere":
                return {"domain": "sphere", "min_elevation_deg": 0}
        return None

    def first_direction(self, sampling: str, shard: str) -> int:
        """The first view direction of a shard."""
        return self._directions(sampling, shard)[0]

    def last_direction(self, sampling: str, shard: str) -> int:
        """The last view direction of a shard, exclusive."""
        return self._directions(sampling, shard)[1]

    def _directions(self, sampling: str, shard: str) -> tuple[int, int]:
        settings = self.entry("samplings", sampling)
        return part_range(settings["directions"], settings["shards"], int(shard))

    def shards(self, scene: str, sampling: str) -> dict[str, list[str]]:
        """All shards of a ray set."""
        count = self.entry("samplings", sampling)["shards"]
        return {
            stem: self.paths.ray_shards(stem, scene, sampling, count)
            for stem in ("origins", "bounds")
        }

    # Networks

    def training_files(self, experiment: str) -> dict[str, Any]:
        """What an experiment trains on: a ray set, and the mesh if its network is laid out by it."""
        settings = self.entry("experiments", experiment)
        names = settings["scene"], settings["sampling"]
        needs_mesh = _NETWORK.validate_python(settings["network"]).needs_mesh
        return {
            "directions_npy": self.paths.rays("directions.npy", *names),
            "rays_json": self.paths.rays("rays.json", *names),
            "mesh_ply": [self.paths.scene("mesh.ply", names[0])] * needs_mesh,
            **self.shards(*names),
        }

    def experiment_mesh_json(self, experiment: str) -> str:
        """What is known of the mesh of an experiment's scene."""
        return self.paths.scene("mesh.json", self.entry("experiments", experiment)["scene"])

    def experiment_bias(self, experiment: str) -> list[str]:
        """The file of an experiment's depth bias, if it is one that is found."""
        found = self.entry("experiments", experiment)["bias"] == HELD_OUT
        return [self.paths.depth_bias(experiment)] * found

    def held_out_views(self, experiment: str) -> str:
        """The references of the viewpoints that an experiment's depth bias is found on."""
        scene = self.entry("experiments", experiment)["scene"]
        return self.paths.reference("safetensors", scene, HELD_OUT)

    def encodings(self, experiments: Iterable[str]) -> set[str]:
        """The kinds of networks of some experiments."""
        return {self.entry("experiments", name)["network"]["encoding"] for name in experiments}

    # Methods, evaluated batch by batch

    def first_view(self, batch: str) -> int:
        """The first viewpoint of a batch in each view set."""
        return view_range(self.settings["rendering"], batch)[0]

    def last_view(self, batch: str) -> int:
        """The last viewpoint of a batch in each view set, exclusive."""
        return view_range(self.settings["rendering"], batch)[1]

    def bias(self, method: str) -> float | str | None:
        """The depth bias of a method that is a network: a number, or `held_out`."""
        if is_shadow_map(method):
            return None
        experiment = experiment_of(method)
        return self.entry("experiments", experiment)["bias"] if method == experiment else HELD_OUT

    def weights(self, method: str) -> list[str]:
        """The weights of a method that is a network."""
        name = experiment_of(method)
        return [] if is_shadow_map(method) else [self.paths.network("weights.safetensors", name)]

    def method_encodings(self, method: str) -> set[str]:
        """The kind of network of a method that is one."""
        return set() if is_shadow_map(method) else self.encodings([experiment_of(method)])

    def method_bias(self, method: str) -> list[str]:
        """The file of a method's depth bias, if it is one that is found."""
        return [self.paths.depth_bias(experiment_of(method))] * (self.bias(method) == HELD_OUT)

    def evaluations(self, scene: str, method: str, ending: str) -> list[str]:
        """A method's files of all batches: metrics (`csv`) or pictures (`npz`)."""
        parts = batches(self.settings["rendering"])
        return [self.paths.evaluation(ending, scene, method, part) for part in parts]
