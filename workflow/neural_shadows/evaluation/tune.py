"""Stage: a method's constants of least error, on validation frames."""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace
from functools import partial
from itertools import product
from pathlib import Path
from types import ModuleType
from typing import Any

import numpy as np

from neural_shadows.evaluation.frame import KIND, Inputs, are_views, module_of, sequences_module
from neural_shadows.evaluation.method import ROUNDS_OF_HISTORY, Constants, Method
from neural_shadows.files.whole_files import write_json
from neural_shadows.running.origin import describe_origin
from neural_shadows.running.progress import progress_bar
from neural_shadows.running.stage import run_stage
from neural_shadows.settings.records import SceneSettings

# An end of candidates counts where the one before it errs by over 1 % more: σ of 64 beside 32 hardly differs.
_GAIN = 1.01


def tune(
    frames: list[Path],
    meshes: list[Path],
    weights: list[Path],
    constants_json: Path,
    *,
    sequences: list[Path] = (),
    fields: list[Path] = (),
    method: str,
    scene: SceneSettings | None = None,
    device: str = "auto",
    precision: str = "auto",
    threads: int = 1,
) -> None:
    """Find the constants of least error, by radius.

    Of frames and sequences the mean squared error off the geometry's edges, of views the share of points in
    error. One constant after another, the others at their best so far, or where the search begins: 5
    settings of two constants with three values each, instead of all 9; as many rounds as `Method.rounds`.
    Or jointly, see `Method.joint`. It begins in the middle of the candidates, without `Method.last`.

    Args:
        frames: validation frames of all scenes, or held-out views of one, which no evaluation uses.
        sequences: on which a method has the constants of its history chosen, the others being those of the
            middle radius; none of a method without such constants. When one sequence chose all constants,
            eight rays by the FFX-like filter erred 1.5 times as much with their history as without it, over
            24 test sequences.
        meshes, weights, fields, scene, device, precision: see `Inputs`.
        constants_json: `candidates` by constant; by radius, as `radii`, the best `constants`, their
            `error`, `tried`, errors of the last constant's candidates or of all settings in order,
            by term, and `at_end`, the constants whose best value may lie beyond the candidates;
            `history`, of sequences: likewise, and `of_history`, the candidates of its constants.
        method: the method's key, without a bias.

    Raises:
        InputError: an input file cannot be read.
    """
    settings = {"device": device, "precision": precision, "threads": threads}
    inputs = Inputs(frames, meshes, weights, fields=fields, scene=scene, **settings)
    kind = module_of(KIND, are_views(frames))
    tuned = kind.open_methods(method, inputs)(None)
    by_radius = [{"constants": _begin(tuned)} for _ in range(kind.count_radii(frames[0]))]
    title = f"of {method}"
    errors = partial(_frame_errors, kind, inputs, tuned, title)
    _search(tuned.constants, _searched(tuned), tuned.joint, by_radius, kind.ERRORS, errors)
    about = {"method": method, "frames": kind.count_frames(frames), "radii": by_radius}
    about["candidates"] = {name: list(values) for name, values in tuned.constants.items()}
    if sequences:
        middle = by_radius[len(by_radius) // 2]["constants"]
        about["history"] = {"constants": middle | _middles(tuned.of_history)}
        about["of_history"] = {name: list(values) for name, values in tuned.of_history.items()}
        each = [replace(inputs, frames=[path]) for path in sequences]
        errors = partial(_sequence_errors, kind, each, tuned, f"of the history {title}")
        one_by_one = [[name] for name in tuned.of_history] * ROUNDS_OF_HISTORY
        _search(tuned.of_history, one_by_one, False, [about["history"]], ["mse"], errors)
    searched = [("", best) for best in by_radius]
    searched += [(" over time", about["history"])] if sequences else []
    for when, best in searched:
        for name in best["at_end"]:
            value = f"{name.replace('_', ' ')}{when}, {best['constants'][name]}"
            print(f"{method}: the best {value}, ends the search")  # the table says so, too
    write_json(constants_json, about | describe_origin())


def _search(
    candidates: Mapping[str, Sequence[float]],
    searched: Sequence[Sequence[str]],
    smallest: bool,
    begins: Sequence[dict[str, Any]],
    terms: Sequence[str],
    measure: Callable[[str, list[list[Constants]]], list[np.ndarray]],
) -> None:
    """Choose constants, of several lights at once, from the `constants` of each on; see `tune`.

    Args:
        candidates: by constant. searched: constants that are searched together, in turn. smallest: of equal
            errors the smallest constants are chosen, not the first.
        begins: get `constants`, `error`, `tried` and `at_end`.
        terms: names of the terms of an error. measure: of what is searched, in words, and of the settings of
            each light, their errors (settings, terms) by light. No setting is measured twice: a constant
            after the first is tried at the value that it has, too, and later rounds repeat settings.
    """
    ends = [dict.fromkeys(candidates, False) for _ in begins]
    known: list[dict[tuple[float, ...], np.ndarray]] = [{} for _ in begins]
    for names in searched:
        grid = [dict(zip(names, values)) for values in product(*map(candidates.get, names))]
        tried = [[best["constants"] | values for values in grid] for best in begins]
        new = [[s for s in each if _key(s) not in errors] for each, errors in zip(tried, known)]
        if any(new):
            measured = measure(" and ".join(names), new)
            for errors, settings, values in zip(known, new, measured, strict=True):
                errors |= zip(map(_key, settings), values, strict=True)
        for best, settings, errors, at_end in zip(begins, tried, known, ends):
            values = np.array([errors[_key(setting)] for setting in settings])
            sums = values.sum(axis=1)
            chosen = _least(settings, sums, names[::-1] if smallest else [])
            best |= {"constants": settings[chosen], "error": sums[chosen]}
            best["tried"] = [
                setting | dict(zip(terms, each)) for setting, each in zip(settings, values.tolist())
            ]
            for name in names:
                at_end[name] = _at_end(name, candidates[name], settings, sums, chosen)
    for best, at_end in zip(begins, ends):
        best["at_end"] = [name for name in candidates if at_end[name]]


def _begin(method: Method) -> Constants:
    """Constants at which the search begins; see `tune`."""
    first = {name: method.constants[name][0] for name in method.of_last}
    return _middles(method.constants) | first


def _middles(candidates: Mapping[str, Sequence[float]]) -> Constants:
    return {name: values[len(values) // 2] for name, values in candidates.items()}


def _searched(method: Method) -> list[list[str]]:
    """Constants searched together, in turn."""
    if method.joint:
        return [[*method.constants]]
    return [[name] for name in method.constants] * method.rounds


def _frame_errors(
    kind: ModuleType,
    inputs: Inputs,
    method: Method,
    title: str,
    names: str,
    settings: list[list[Constants]],
) -> list[np.ndarray]:
    """Mean errors of frames, (settings, terms) by radius; see `_search`."""
    sums, count = [0.0] * len(settings), 0
    with progress_bar(kind.count_frames(inputs.frames), "frames", f"tune {names} {title}") as bar:
        for frame in kind.open_frames(inputs):
            errors, weight = frame.errors_of(method, settings)
            sums, count = [a + b for a, b in zip(sums, errors)], count + weight
            bar.update()
    return [total / count for total in sums]


def _sequence_errors(
    kind: ModuleType,
    inputs: Sequence[Inputs],
    method: Method,
    title: str,
    names: str,
    settings: list[list[Constants]],
) -> list[np.ndarray]:
    """Mean squared errors over sequences, of one light, (settings, 1); see `_search`.

    Args:
        inputs: of each sequence: one in memory at a time, whose frames keep their rays for all settings.
    """
    with progress_bar(len(inputs) * len(settings[0]), "runs", f"tune {names} {title}") as bar:

        def errors_of(sequence: Inputs) -> list[float]:
            steps, errors = [*sequences_module().steps_of(kind.open_frames(sequence))], []
            for constants in settings[0]:
                errors.append(sequences_module().squared_error(steps, method, constants))
                bar.update()
            return errors

        return [np.mean([errors_of(each) for each in inputs], axis=0)[:, None]]


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

    If its neighbour is worse by `_GAIN`, the other constants as chosen: where it is not, errors hardly change any
    more. A bound of its own, as 0 and a `share` of 1 are, is no end, nor is one of two.
    """
    others = settings[chosen] | {name: None}
    along = [e for constants, e in zip(settings, errors) if constants | {name: None} == others]
    value = settings[chosen][name]
    best = candidates.index(value)
    bound = not value or (name == "share" and value == 1)
    if len(along) < 3 or bound or best not in (0, len(along) - 1):
        return False
    return bool(along[1 if best == 0 else -2] > _GAIN * along[best])


if "snakemake" in globals():
    run_stage(snakemake, tune)
