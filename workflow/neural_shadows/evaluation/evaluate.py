"""Stage: one method on test frames, against the reference [4.1]."""

from itertools import groupby
from pathlib import Path
from typing import Any

import numpy as np

from neural_shadows.evaluation.answers import write_answers
from neural_shadows.evaluation.frame import (
    KIND,
    METRICS,
    Inputs,
    are_views,
    constants_of,
    module_of,
    sequence_constants_of,
)
from neural_shadows.evaluation.metric_files import write_metrics
from neural_shadows.metrics.registry import image_metrics
from neural_shadows.running.progress import progress_bar
from neural_shadows.running.stage import run_stage
from neural_shadows.settings.records import SceneSettings


def evaluate(
    frames: list[Path],
    sequences: list[Path],
    meshes: list[Path],
    weights: list[Path],
    constants_json: Path | None,
    lpips_json: Path,
    metrics_csv: Path,
    answers_npz: Path,
    *,
    occluders: Path | None = None,
    fields: list[Path] = (),
    method: str,
    scene: SceneSettings | None = None,
    bias: float = 0.0,
    device: str = "auto",
    precision: str = "auto",
    by_scene: bool = False,
    threads: int = 1,
) -> None:
    """Measure a method on frames, and its flicker over sequences.

    Writes metrics, see `write_metrics`, and visibilities, see `write_answers`.

    Args:
        frames: test frames. sequences, meshes, weights, fields, occluders, scene, device,
            precision, by_scene: see `Inputs`.
        constants_json: of `tune`; None for a method without constants.
        bias: depth bias of a network on views without constants, in sphere radii.
        lpips_json: of `find_lpips`, its model beside it; LPIPS is left out where it is not available.
        method: the method's key.

    Raises:
        InputError: an input file cannot be read.
    """
    compute = {"device": device, "precision": precision, "threads": threads}
    beside = {"fields": fields, "occluders": occluders, "scene": scene, "by_scene": by_scene}
    inputs = Inputs(frames, meshes, weights, sequences, **beside, **compute)
    kind, measures = (module_of(names, are_views(frames)) for names in (KIND, METRICS))
    method_of = kind.open_methods(method, inputs)
    constants = constants_of(constants_json, kind.count_radii(frames[0]))
    with_history = sequence_constants_of(constants_json, len(constants))
    if bias:
        constants = [{"depth_bias": bias}]
    images = image_metrics(measures.LIGHT, lpips_json, threads)

    rows: list[dict[str, Any]] = []
    visibilities: dict[str, np.ndarray] = {}
    total = kind.count_frames([*frames, *sequences])

    def add(key: dict[str, Any], values: dict[str, float], stored: dict[str, np.ndarray]) -> None:
        place = key | {"method": method}
        rows.extend(place | {"metric": name, "value": value} for name, value in values.items())
        visibilities.update(stored)

    with progress_bar(total, "frames", f"evaluate {method}") as bar:
        for path, of_file in groupby(kind.open_frames(inputs), lambda frame: frame.path):
            scene_method = method_of(path.parent.name)
            if scene_method is None:
                bar.update(sum(1 for _ in of_file))
            elif path in sequences:
                add(*measures.flicker(of_file, scene_method, constants, with_history, bar.update))
            else:
                for frame in of_file:
                    for k, shares in enumerate(frame.visibilities(scene_method, constants)):
                        values = measures.metrics(frame, shares, k, images)
                        add(frame.key(k), values, frame.stored(shares, k))
                    bar.update()
    write_metrics(metrics_csv, rows)
    write_answers(answers_npz, visibilities)


if "snakemake" in globals():
    run_stage(snakemake, evaluate)
