"""Times of methods on frames under an area light."""

import time
from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np

from neural_shadows.evaluation.frame import Inputs
from neural_shadows.evaluation.measured_frames import MeasuredFrame, open_frames, open_methods
from neural_shadows.evaluation.method import Constants, Method, visibility
from neural_shadows.evaluation.registry import frame_method
from neural_shadows.files.whole_files import read_json
from neural_shadows.frames.soft_frame import SoftFrame
from neural_shadows.rendering.surface import see_surface
from neural_shadows.running.progress import progress_bar

# Measured once each, methods of 0.3 s took up to twice as long as the same method under the next light.
_AGREED = 1.05  # the two least of a call's times: then it is not repeated
_LONG = 2000  # milliseconds of a call that is not repeated, of which a disturbance is a small share
# What a renderer has. All else a method makes of it in its own time: biases, rays' origins.
_GIVEN = ("from_light", "cosines", "depths")


def times(
    inputs: Inputs, methods: Mapping[str, str | None], constants: Sequence[Path], repeats: int
) -> dict[str, Any]:
    """Time each method on each part's first frame, all radii.

    Methods take turns, so that other load disturbs all of them alike. Of a window the whole frame is timed,
    and it bears its share: a window alone would pay for the filtering of all of a map.

    Args:
        inputs: test parts, one a scene; weights of networks, each in a folder of its experiment's
            name.
        methods: the experiment of each one's weights, or None. constants: of the tuned methods.

    Returns: of each method and radius `ms`, the median over frames of the `least` of up to `repeats`, of the
        method alone; its light `map`, the numbers in a texel, and other bytes
        held. By the texels of a side, `maps`: the `ms` of rasterising it, and its `texels`. All `ms` are a
        window's `share` of those of its whole frame.

    Raises:
        InputError: an input file cannot be read.
    """
    frames = [frame for frame in open_frames(inputs) if frame.number == 0]
    radii = frames[0].part.radii
    timed, chosen = _opened(inputs, methods, constants, len(radii))
    own = frames[0].frame.light_map.resolution
    side_of = {name: method.resolution or own for name, method in timed.items()}
    sides = sorted({own, *side_of.values()})
    maps: dict[int, list[float]] = {side: [] for side in sides}
    answer_ms = {name: np.zeros((len(frames), len(radii))) for name in timed}
    shares = [_share(measured.frame) for measured in frames]
    with progress_bar(len(frames) * len(radii), "frames", "time methods") as bar:
        for number, measured in enumerate(frames):
            share, whole = shares[number], _whole(measured.frame)
            windows, wholes = (
                {side: _prepared(frame.with_map_of(side)) for side in sides}
                for frame in (measured.frame, whole)
            )
            for side, times in maps.items():
                times.append(share * _map_ms(wholes[side], repeats))
            for k, radius in enumerate(measured.part.radii):
                works = {
                    name: partial(_answer, method, constants=chosen[name][k], radius=radius)
                    for name, method in timed.items()
                    if method.changes_at(chosen[name], k)
                }
                # What is compiled, and what a method makes of a scene and a size: a point light's may be
                # another path than that of all others. Cones through fields took five times as long at first.
                for name, work in works.items() if k <= 1 else ():
                    work((windows if k == 0 else wholes)[side_of[name]])
                of_frame = {
                    name: partial(work, wholes[side_of[name]]) for name, work in works.items()
                }
                milliseconds = least(of_frame, repeats)
                for name, each in answer_ms.items():
                    ms = milliseconds.get(name)
                    each[number, k] = each[number, k - 1] if ms is None else share * ms
                bar.update()
    return {
        "frames": len(frames),
        "repeats": repeats,
        "once_above_ms": _LONG,
        "maps": {
            str(side): {
                "ms": float(np.median(times)),
                "texels": frames[0].frame.with_map_of(side).light_map.count,
            }
            for side, times in maps.items()
        },
        "share": float(np.median(shares)),
        "methods": {
            name: {
                "ms": np.median(each, axis=0).tolist(),
                "map": str(side_of[name]) if timed[name].texel_floats else None,
                "texel_floats": timed[name].texel_floats,
                "held_bytes": _held(timed[name], frames),
            }
            for name, each in answer_ms.items()
        },
    }


def _opened(
    inputs: Inputs, methods: Mapping[str, str | None], constants: Sequence[Path], radii: int
) -> tuple[dict[str, Method], dict[str, list[Constants]]]:
    """The methods that compute an answer, and the constants of all by radius; see `times`."""
    tuned = {
        record["method"]: [each["constants"] for each in record["radii"]]
        for record in map(read_json, constants)
    }
    chosen = {
        name: tuned.get(frame_method(name).tuned_as or name, [{}] * radii) for name in methods
    }
    trained = {path.parent.name: path for path in inputs.weights}
    opened = {
        name: open_methods(name, replace(inputs, weights=[trained[n]] if n else []))(None)
        for name, n in methods.items()
    }
    return {name: method for name, method in opened.items() if method.answer}, chosen


def _share(frame: SoftFrame) -> float:
    """An image's share of the whole frame's pixels. 1 unless it is a window of it."""
    surface, window = frame.surface, frame.surface.camera.window
    if window is None:
        return 1.0
    return surface.width * surface.height / (window.full_width * window.full_height)


def _whole(frame: SoftFrame) -> SoftFrame:
    """The whole frame of a window, or the frame itself."""
    window = frame.surface.camera.window
    if window is None:
        return frame
    camera = replace(frame.surface.camera, window=None)
    surface = see_surface(frame.scene, camera, window.full_width, window.full_height)
    return replace(frame, surface=surface)


def _held(method: Method, frames: Sequence[MeasuredFrame]) -> float:
    """Median bytes kept of the scene, over frames."""
    return (
        float(np.median([method.held(measured.frame) for measured in frames]))
        if method.held
        else 0.0
    )


def _prepared(frame: SoftFrame) -> SoftFrame:
    """The frame with what is given computed."""
    for name in _GIVEN:
        getattr(frame, name)
    return frame


def _answer(method: Method, frame: SoftFrame, *, radius: float, constants: Constants) -> np.ndarray:
    """A method's answer by what is given; not by what it, or another method, made of the frame before."""
    anew = replace(frame)
    vars(anew).update({name: getattr(frame, name) for name in _GIVEN})
    return visibility(method, anew, radius, constants)


def _map_ms(frame: SoftFrame, repeats: int) -> float:
    """Milliseconds of rasterising the light's map."""
    return least({"map": lambda: replace(frame).depths}, repeats)["map"]


def least(works: Mapping[str, Callable[[], Any]], repeats: int) -> dict[str, float]:
    """Least milliseconds of each call, to which other load only adds; the calls take turns.

    One runs until its two least times agree, `repeats` times at most; above `_LONG` once.
    """
    times: dict[str, list[float]] = {name: [] for name in works}
    for _ in range(repeats):
        for name, work in works.items():
            if _is_enough(times[name]):
                continue
            started = time.perf_counter()
            work()
            times[name].append(1000 * (time.perf_counter() - started))
    return {name: min(each) for name, each in times.items()}


def _is_enough(times: Sequence[float]) -> bool:
    first, *others = sorted(times) or [0.0]
    return first > _LONG or bool(others) and others[0] <= _AGREED * first
