"""Reading and checking the configuration."""

from collections import defaultdict
from collections.abc import Iterable, Mapping, Sequence
from pathlib import Path
from typing import Any

import yaml
from pydantic import ValidationError

from neural_shadows.config.messages import LOADER, describe, place_of
from neural_shadows.config.whole import Config
from neural_shadows.errors import InputError
from neural_shadows.meshes.formats import format_of
from neural_shadows.running.origin import CHECKOUT
from neural_shadows.sections.own_frames import OwnFrames, without_frames
from neural_shadows.sections.scenes import MeshFile
from neural_shadows.settings.base import not_among

# Values of `dragon` other than a file.
MESHES_BY_NAME = {"wyrm": {"generate": "wyrm"}, "stanford": {"download": "stanford_dragon"}}

# The key of all entries of a section that neither its file nor a later one names.
OTHERS = "*"

# Sections of what a run makes by default; `only` chooses among their entries.
REPORTS = frozenset({"tables", "figures", "viewers", "claims"})


def without_others(values: dict[str, Any], files: Iterable[Mapping[str, Any]]) -> dict[str, Any]:
    """A merged configuration without entries dropped by `"*": null`.

    Args:
        files: sections of each config file, in the order of merging.
    """
    defined, dropped = defaultdict(set), defaultdict(set)
    for sections in files:
        for name, section in sections.items():
            if isinstance(section, dict):
                if OTHERS in section:
                    dropped[name] = {*defined[name]}
                defined[name] |= section.keys()
                dropped[name] -= section.keys()
    return {
        name: {key: entry for key, entry in section.items() if key not in dropped[name]}
        if dropped[name]
        else section
        for name, section in values.items()
    }


def of_files(
    values: dict[str, Any], files: Sequence[tuple[str, Mapping[str, Any]]]
) -> dict[str, Any]:
    """A configuration with the reports of some files alone, `only`.

    Args:
        files: each config file's name without ending, and its sections.

    Raises:
        InputError: `only` is no name of a file with reports, nor a list of them.
    """
    only = [values["only"]] if isinstance(values["only"], str) else values["only"]
    reporting = [name for name, sections in files if not REPORTS.isdisjoint(sections)]
    if not isinstance(only, list) or not all(isinstance(name, str) for name in only):
        raise InputError(f"config: only = {only!r}: give one of {', '.join(reporting)}, or a list")
    for name in only:
        if name not in reporting:
            raise InputError(f"config: only: {not_among(name, reporting)}")
    chosen = [sections for name, sections in files if name in only]
    return values | {
        section: {
            key: entry
            for key, entry in values[section].items()
            if any(key in (sections.get(section) or ()) for sections in chosen)
        }
        for section in REPORTS
        if isinstance(values.get(section), dict)
    }


def _without_nulls(value: Any) -> Any:
    """A section without its null keys, removed by overlays."""
    if not isinstance(value, dict):
        return value
    return {key: _without_nulls(part) for key, part in value.items() if part is not None}


class _NoDuplicates(LOADER):
    """YAML loader rejecting repeated keys."""

    def construct_mapping(self, node, deep=False):
        seen = set()
        for key, _ in node.value:
            if str(key.value) in seen:
                raise InputError(
                    f"config: {key.start_mark.name}, line {key.start_mark.line + 1}: "
                    f"{key.value!r} is defined twice. Define it once"
                )
            seen.add(str(key.value))
        return super().construct_mapping(node, deep)


def read_sections(path: str | Path) -> dict[str, Any]:
    """Sections of a config file.

    Raises:
        InputError: a key is repeated (with file and line), or the file is not YAML or has no sections.
    """
    try:
        with Path(path).open(encoding="utf-8") as file:
            sections = yaml.load(file, _NoDuplicates)
    except (OSError, ValueError, yaml.YAMLError, RecursionError) as error:
        reason = " ".join(str(error).split())[:300]
        raise InputError(f"config: {path}: cannot be read as YAML ({reason})") from error
    if not isinstance(sections, dict):
        raise InputError(f"config: {path}: has no sections. Write `section: ...` at its top")
    return sections


def read_config(values: dict[str, Any], files: Sequence[str | Path] = ()) -> Config:
    """Check a configuration merged by Snakemake.

    Args:
        values: the merged config files and `--config` values. files: in the order of merging, for
            `"*": null` and for messages.

    Raises:
        InputError: a key is unknown or missing, a value has the wrong type or range, or a
            name refers to nothing; one line that names key, value and what is allowed.
    """
    if values.get("dragon", "wyrm") in (None, ""):
        raise InputError("config: dragon: is empty. Allowed: wyrm, stanford, or a mesh file")
    sections = [read_sections(file) for file in files]
    values = _without_nulls(without_others(values, sections))
    if values.get("only"):
        values = of_files(values, [*zip((Path(file).stem for file in files), sections)])
    if isinstance(shorthand := values.get("dragon"), str):
        scenes = values.get("scenes")
        if not isinstance(scenes, dict) or not isinstance(scenes.get("dragon"), dict):
            raise InputError("config: dragon: `scenes` has no scene named `dragon`")
        mesh = MESHES_BY_NAME.get(shorthand, {"path": shorthand})
        configured = scenes["dragon"].get("mesh")
        # `--config dragon=wyrm` keeps the resolution of a scene with a wyrm.
        if not (isinstance(configured, dict) and mesh.items() <= configured.items()):
            scenes["dragon"]["mesh"] = mesh
    if (up := values.get("up")) is not None and isinstance(
        dragon := (values.get("scenes") or {}).get("dragon"), dict
    ):
        dragon["up"] = up
    try:
        return Config.model_validate(values, context=values)
    except ValidationError as error:
        message = describe(error, values)
        raise InputError(f"config: {message}{place_of(message, files, values)}") from error


def check_files(config: Config, files: Iterable[str | Path] = (), values: Any = None) -> None:
    """Check that configured files exist.

    Snakemake does not check inputs of an existing result.

    Args:
        files, values: of `read_config`, for a message's place.

    Raises:
        InputError: a mesh, a frame folder or weights are missing, a mesh has an unknown suffix, or the
            folder of results or reports is a link to nothing; one line with the key.
    """
    try:
        _check_files(config)
    except InputError as error:
        place = place_of(str(error).removeprefix("config: "), files, values)
        raise InputError(f"{error}{place}") from error


def _check_files(config: Config) -> None:
    for folder in (Path("results"), Path("reports")):
        for path in (folder, folder / config.scale):
            if path.is_symlink() and not path.exists():
                raise InputError(
                    f"{path}: is a link to {path.readlink()}, which does not exist. Make that folder, "
                    "or remove the link"
                )
    for name, scene in config.mesh_scenes.items():
        if isinstance(scene.mesh, MeshFile):
            path, key = scene.mesh.path, f"scenes.{name}.mesh.path"
            if name == "dragon" and config.dragon == path:
                key = "dragon"
                if "." not in path and not Path(path).exists():
                    problem = not_among(path, MESHES_BY_NAME)
                    raise InputError(f"config: dragon: {problem}, and no file")
            _check_file(key, path)
            try:
                format_of(path)
            except InputError as error:
                raise InputError(f"config: {key}: {error}") from error
    for name, frames in config.frame_sets.items():
        missing = without_frames(frames) if isinstance(frames, OwnFrames) else None
        if missing is not None:
            described = "results" if frames.engine is None else "config"
            raise InputError(
                f"config: frame_sets.{name}.path = {frames.path!r}: {missing}. "
                f"{described}/README.md describes the format"
            )
    for name, experiment in config.screen_experiments.items():
        if experiment.weights is not None:
            path = experiment.weights.path
            if "://" not in path and not (CHECKOUT / path).is_file():
                _check_file(f"experiments.{name}.weights.path", path)
            continue
        trunk = getattr(config.training_of(name).perceptual, "trunk", None)
        if trunk is not None:
            named = experiment.training if isinstance(experiment.training, str) else None
            key = f"trainings.{named}" if named else f"experiments.{name}.training"
            _check_file(f"{key}.perceptual.trunk", trunk)
    if config.metrics.lpips.trunk is not None:
        _check_file("metrics.lpips.trunk", config.metrics.lpips.trunk)


def _check_file(key: str, path: str) -> None:
    if not Path(path).is_file():
        raise InputError(
            f"config: {key} = {path!r}: no such file. "
            "Give a path relative to the working directory, or an absolute one"
        )
