"""Stage: a method's constants of least error, on validation frames."""

from collections.abc import Mapping, Sequence
from dataclasses import replace
from itertools import product
from pathlib import Path
from types import ModuleType
from typing import Any

import numpy as np

from neural_shadows.evaluation.frame import KIND, Inputs, are_views, module_of, sequences_module
from neural_shadows.evaluation.method import Constants, Method
from neural_shadows.files.whole_files import write_json
from neural_shadows.running.origin import describe_origin
from neural_shadows.running.progress import progress_bar
from neural_shadows.running.stage import run_stage
from neural_shadows.settings.records import SceneSettings


def tune(
    frames: list[Path],
    meshes: list[Path],
    weights: list[Path],
    constants_json: Path,
    *,
    sequence: Path | None = None,
    fields: list[Path] = (),
    method: str,
    scene: SceneSettings | None = None,
    device: str = "auto",
    precision: str = "auto",
    threads: int = 1,
) -> None:
    """Find the constants of least error, by radius.

    Of frames the mean squared error off the geometry's edges, of views the share of points in error.
    One constant after another, the others at their best so far, or where the search begins: 5 settings of
    two constants with three values each, instead of all 9; as many rounds as `Method.rounds`. Or jointly,
    see `Method.joint`. It begins in the middle of the candidates, without `Method.last`.

    Args:
        frames: validation frames of all scenes, or held-out views of one, which no evaluation uses.
        sequence: on which a method with a history has its constants chosen once more, at the middle
            radius, for sequences alone; None of a method without.
        meshes, weights, fields, scene, device, precision: see `Inputs`.
        constants_json: `candidates` by constant; by radius, as `radii`, the best `constants`, their
            `error`, `tried`, errors of the last constant's candidates or of all settings in order,
            by term, and `at_end`, the constants whose best value may lie beyond the candidates;
            `history`, of a sequence: likewise `constants`, `tried` and `at_end`.
        method: the method's key, without a bias.

    Raises:
        InputError: an input file cannot be read.
    """
    settings = {"device": device, "precision": precision, "threads": threads}
    inputs = Inputs(frames, meshes, weights, fields=fields, scene=scene, **settings)
    kind = module_of(KIND, are_views(frames))
    tuned = kind.open_methods(method, inputs)(None)
    candidates = {name: list(values) for name, values in tuned.constants.items()}
    by_radius = [{"constants": _begin(tuned)} for _ in range(kind.count_radii(frames[0]))]
    ends = [dict.fromkeys(candidates, False) for _ in by_radius]
    known = [{} for _ in by_radius]
    for names in _searched(tuned):
        grid = [dict(zip(names, values)) for values in product(*map(candidates.get, names))]
        tried = [[best["constants"] | values for values in grid] for best in by_radius]
        title = f"tune {' and '.join(names)} of {method}"
        _measure(kind, inputs, tuned, tried, known, title)
        for best, settings, errors, at_end in zip(by_radius, tried, known, ends):
            terms = np.array([errors[_key(setting)] for setting in settings])
            sums = terms.sum(axis=1)
            chosen = _least(settings, sums, names[::-1] if tuned.joint else [])
            best |= {"constants": settings[chosen], "error": sums[chosen]}
            best["tried"] = [
                setting | dict(zip(kind.ERRORS, each))
                for setting, each in zip(settings, terms.tolist())
            ]
            for name in names:
                at_end[name] = _at_end(name, candidates[name], settings, sums, chosen)
    for best, at_end in zip(by_radius, ends):
        best["at_end"] = [name for name in candidates if at_end[name]]
        for name in best["at_end"]:
            value = f"{name.replace('_', ' ')}, {best['constants'][name]}"
            print(f"{method}: the best {value}, ends the search")  # the table says so, too
    about = {"method": method, "frames": kind.count_frames(frames), "candidates": candidates}
    about |= {"radii": by_radius}
    if sequence:
        in_sequence = replace(inputs, frames=[sequence])
        about["history"] = _with_history(in_sequence, method, candidates, by_radius)
    write_json(constants_json, about | describe_origin())


def _begin(method: Method) -> Constants:
    """Constants at which the search begins; see `tune`."""
    return {
        name: values[0 if name in method.of_last else len(values) // 2]
        for name, values in method.constants.items()
    }


def _searched(method: Method) -> list[list[str]]:
    """Constants searched together, in turn."""
    if method.joint:
        return [[*method.constants]]
    return [[name] for name in method.constants] * method.rounds


def _with_history(
    inputs: Inputs,
    method: str,
    candidates: Mapping[str, Sequence[float]],
    by_radius: Sequence[Mapping[str, Any]],
) -> dict[str, Any]:
    """Constants of least squared error over a sequence, one after another, from those of frames on."""
    kind, answers = module_of(KIND, views=False), sequences_module()
    frames, tuned = [*kind.open_frames(inputs)], kind.open_methods(method, inputs)(None)
    best: dict[str, Any] = {"constants": by_radius[len(by_radius) // 2]["constants"], "at_end": []}
    total = len(frames) * sum(map(len, candidates.values()))
    with progress_bar(total, "frames", f"tune the history of {method}") as bar:
        for name, values in candidates.items():
            settings = [best["constants"] | {name: value} for value in values]
            errors = []
            for constants in settings:
                errors.append(answers.squared_error(frames, tuned, [constants] * len(by_radius)))
                bar.update(len(frames))
            chosen = int(np.argmin(errors))
            best["constants"] = settings[chosen]
            best["tried"] = [setting | {"mse": mse} for setting, mse in zip(settings, errors)]
            if _at_end(name, values, settings, errors, chosen):
                best["at_end"].append(name)
    return best


def _measure(
    kind: ModuleType,
    inputs: Inputs,
    method: Method,
    tried: Sequence[Sequence[Constants]],
    known: Sequence[dict[tuple[float, ...], np.ndarray]],
    title: str,
) -> None:
    """Add to those known by radius the mean errors of frames, (terms,), of settings tried first now.

    A constant after the first is tried at the value that it has, too, and later rounds repeat settings.
    """
    new = [
        [setting for setting in settings if _key(setting) not in errors]
        for settings, errors in zip(tried, known)
    ]
    if not any(new):
        return
    sums, count = [0.0] * len(new), 0
    with progress_bar(kind.count_frames(inputs.frames), "frames", title) as bar:
        for frame in kind.open_frames(inputs):
            errors, weight = frame.errors_of(method, new)
            sums, count = [a + b for a, b in zip(sums, errors)], count + weight
            bar.update()
    for settings, errors, total in zip(new, known, sums):
        errors |= zip(map(_key, settings), total / count)


def _key(setting: Constants) -> tuple[float, ...]:
    """Its values, in the order that all settings of a search have."""
    return tuple(setting.values())


def _least(settings: Sequence[Constants], errors: np.ndarray, smallest: Sequence[str]) -> int:
    """Setting of least error.

    Of equal ones the first, or that of the smallest constants.
    """
    order = [
        (error, *(abs(constants[name]) for name in smallest))
        for constants, error in zip(settings, errors)
    ]
    return order.index(min(order))


def _at_end(
    name: str,
    candidates: Sequence[float],
    settings: Sequence[Constants],
    errors: Sequence[float],
    chosen: int,
) -> bool:
    """Check for a best value at an end of its candidates.

    If its neighbour is worse, the other constants as chosen; a bound of its own, as 0 is, is no end,
    nor is one of two.
    """
    others = settings[chosen] | {name: None}
    along = [e for constants, e in zip(settings, errors) if constants | {name: None} == others]
    value = settings[chosen][name]
    best = candidates.index(value)
    if len(along) < 3 or not value or best not in (0, len(along) - 1):
        return False
    return bool(along[1 if best == 0 else -2] > along[best])


if "snakemake" in globals():
    run_stage(snakemake, tune)
