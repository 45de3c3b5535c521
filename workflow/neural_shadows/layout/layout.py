"""Files and settings of a run, by configured names."""

import os
from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from typing import Any

from neural_shadows.errors import InputError
from neural_shadows.evaluation.registry import is_classic, is_network, unbiased
from neural_shadows.layout.parts import HELD_OUT, part_names, part_range, view_range
from neural_shadows.layout.paths import Paths
from neural_shadows.networks.kind_module import ENCODINGS, form_module, kind_module
from neural_shadows.networks.settings.object_space import NetworkModel
from neural_shadows.sections.frame_sets import VIEWS
from neural_shadows.sections.views import Views
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

    def entry(self, section: str, name: str, key: str | None = None) -> Mapping[str, Any]:
        """A named entry of a section, of those with a key.

        Raises:
            InputError: no such name, or its entry lacks the key; lists the allowed ones.
        """
        entries = self.settings[section]
        if name in entries and (key is None or key in entries[name]):
            return entries[name]
        allowed = [n for n, entry in entries.items() if key is None or key in entry]
        if name in entries:
            names = ", ".join(allowed[:20])
            raise InputError(f"{section}: {name!r} has no `{key}`. Choose another, such as {names}")
        raise InputError(f"{section}: {not_among(name, allowed)}")

    def mesh_scene(self, scene: str) -> Mapping[str, Any]:
        """An entry of `scenes` with a mesh."""
        return self.entry("scenes", scene, "mesh")

    def on_rays(self, experiment: str) -> Mapping[str, Any]:
        """An experiment on rays."""
        return self.entry("experiments", experiment, "scene")

    def on_frames(self, experiment: str) -> Mapping[str, Any]:
        """An experiment on frames."""
        return self.entry("experiments", experiment, "frame_set")

    def frames(self, frame_set: str) -> Mapping[str, Any]:
        """A frame set of frames, not views."""
        return self.entry("frame_sets", frame_set, "path")

    @cached_property
    def mesh_scenes(self) -> list[str]:
        """Names of the scenes with a mesh."""
        return [name for name, scene in self.settings["scenes"].items() if "mesh" in scene]

    @cached_property
    def views(self) -> Views:
        """Views of meshes under a sun."""
        return Views.model_validate(self.settings["frame_sets"][VIEWS])

    def run(self) -> dict[str, Any]:
        """Description of the run in reports."""
        views = self.views.model_dump(include={"width", "height", "reference"})
        return {"scale": self.settings["scale"], "seed": self.settings["seed"], **views}

    def scenes(self, names: Iterable[str]) -> dict[str, dict[str, Any]]:
        """Descriptions of scenes in reports."""
        about = {}
        for name in names:
            scene = self.mesh_scene(name)
            generated = "generate" in scene["mesh"]
            about[name] = {"mesh_name": scene["mesh_name"], "procedural": generated}
            about[name] |= {"seed": scene["seed"], "least_shadow": scene["least_shadow"]}
        return about

    def mesh_source(self, scene: str) -> str:
        """Source file of a scene's mesh: the user's, or that of `get_mesh`."""
        mesh = self.mesh_scene(scene)["mesh"]
        return mesh["path"] if "path" in mesh else self.paths.scene("source.ply", scene)

    def mesh_module(self, scene: str) -> Path:
        """Module that generates or downloads a scene's mesh."""
        mesh = self.mesh_scene(scene)["mesh"]
        name = mesh.get("generate") or mesh["download"]
        return Path(__file__).parents[1] / "meshes" / f"{name}.py"

    def direction_light(self, scene: str, sampling: str) -> Mapping[str, Any] | None:
        """Domain of view directions; None for the whole sphere."""
        match self.entry("samplings", sampling)["domain"]:
            case "light":
                return self.mesh_scene(scene)["light"]
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

    def kind(self, experiment: str) -> type[NetworkModel]:
        """Settings class of an experiment's network."""
        encoding = self.on_rays(experiment)["network"]["encoding"]
        return kinds(ENCODINGS)[encoding].Settings

    def is_trained(self, experiment: str) -> bool:
        """Check for a training."""
        return self.entry("experiments", experiment)["training"] is not None

    def can_use_gpu(self, method: str) -> bool:
        """Check for a trained network."""
        return is_network(method) and self.kind(unbiased(method)).trained

    def export_files(self, experiment: str) -> dict[str, Any]:
        """Files with a network's sphere and its depth bias, if held out."""
        scene = self.on_rays(experiment)["scene"]
        mesh_json = self.paths.scene("mesh.json", scene)
        return {"mesh_json": mesh_json, "depth_bias_json": self.bias_file(scene, experiment)}

    def network_modules(self, experiments: Iterable[str]) -> set[Path]:
        """Modules of the kinds of experiments' networks."""
        networks = [self.entry("experiments", name)["network"] for name in experiments]
        return {
            form_module(network["form"]) if "form" in network else kind_module(network["encoding"])
            for network in networks
        }

    def view_range(self, batch: str) -> dict[str, int]:
        """First and last (exclusive) viewpoint of a batch, per view set."""
        first, last = view_range(self.views, batch)
        return {"first": first, "last": last}

    def _bias(self, method: str) -> float | str | None:
        """A method's depth bias: a number, `held_out`, or None."""
        if method != unbiased(method):
            return HELD_OUT
        return None if is_classic(method) else self.on_rays(method)["bias"]

    def fixed_bias(self, method: str) -> float:
        """A method's depth bias in the configuration; 0 without."""
        bias = self._bias(method)
        return 0.0 if bias in (None, HELD_OUT) else bias

    def bias_file(self, scene: str, method: str) -> list[str]:
        """File of a method's depth bias, if held out."""
        held_out = self._bias(method) == HELD_OUT
        return [self.paths.constants(VIEWS, unbiased(method), scene)] * held_out

    def weights(self, method: str) -> list[str]:
        """File of a method's weights; empty without a network."""
        file = self.paths.network("weights.safetensors", unbiased(method))
        return [file] * is_network(method)
