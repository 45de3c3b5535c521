"""Stage: the depth bias of least error, on held-out views.

A depth that is slightly short causes self-shadowing: a bias removes it, and light leaks where it
is too large. A distance field, whose surface is right on average, may need a negative bias. Networks and shadow maps are treated alike.
"""

from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np

from neural_shadows.evaluation.hard_method import OfBias, ShadowMethod
from neural_shadows.evaluation.references import References
from neural_shadows.evaluation.shadow_methods import classic_method, network_method, open_network
from neural_shadows.files.whole_files import write_json
from neural_shadows.metrics.shadow_error import shadow_error
from neural_shadows.rendering.gbuffer import GBuffer
from neural_shadows.running.origin import describe_origin
from neural_shadows.running.progress import progress_bar
from neural_shadows.running.stage import run_stage
from neural_shadows.scenes.scene import open_scene

# In sphere radii, three an octave from half the shading offset: down to −1/60, none, up to 1/8.
_OCTAVES = np.round(0.0005 * 2 ** (np.arange(25) / 3), 5)
BIASES = tuple(float(b) for b in (*-_OCTAVES[15::-1], 0.0, *_OCTAVES))


def find_depth_bias(
    references: Path,
    mesh_ply: Path,
    weights: Path | None,
    depth_bias_json: Path,
    *,
    method: str,
    scene: Mapping[str, Any],
    device: str = "auto",
    precision: str = "auto",
    threads: int = 1,
) -> None:
    """Write the best bias of `BIASES`, and all errors.

    The best has the least shadow error over a batch. Of a network that has `pushes`, the best pair
    of one and a bias. `at_end`: either is the first or the last of the search, so that a better one
    may lie beyond; logged as well.

    Args:
        references: of `render_references`, of views that no evaluation uses.
        mesh_ply: prepared, for a shadow map.
        weights: of a network; None for a shadow map.
        method: the method's key, without a bias.
        scene: `up`, `ground` and `light`, see `open_scene`.

    Raises:
        InputError: an input file cannot be read.
    """
    if weights:
        methods = _pushed(weights, device, threads, precision)
    else:
        methods = {0.0: classic_method(method, open_scene(mesh_ply, **scene))}
    batch = References(references)
    # Sums over views of (false shadow, light leak) by push and bias.
    sums = np.zeros((len(methods), len(BIASES), 2))
    with progress_bar(len(batch), "views", f"find depth bias of {method}") as bar:
        for frame, truth in batch:
            for i, shadow_method in enumerate(methods.values()):
                visibility = shadow_method(frame)
                for j, bias in enumerate(BIASES):
                    error = shadow_error(visibility(bias), truth)
                    sums[i, j] += error.false_shadow, error.light_leak
            bar.update()
    pairs = [(push, bias) for push in methods for bias in BIASES]
    means = (sums / len(batch)).reshape(-1, 2).tolist()
    errors = [
        {"depth_bias": bias, "push": push, "false_shadow": false_shadow, "light_leak": light_leak}
        for (push, bias), (false_shadow, light_leak) in zip(pairs, means)
    ]
    best = min(errors, key=_rank)
    best_pair = {"depth_bias": best["depth_bias"], "push": best["push"]}
    searched = {"depth_bias": BIASES, "push": [*methods]}
    ends = [
        key
        for key, values in searched.items()
        if len(values) > 1 and best_pair[key] in (values[0], values[-1])
    ]
    for key in ends:
        print(
            f"warning: {method}: the best {key.replace('_', ' ')}, {best_pair[key]}, ends the search"
        )
    best_pair |= {"at_end": bool(ends), "views": len(batch), "errors": errors}
    write_json(depth_bias_json, best_pair | describe_origin())


def _rank(error: Mapping[str, float]) -> tuple[float, float, float]:
    """Sort key: shadow error, then smallest bias, then smallest push."""
    shadow = error["false_shadow"] + error["light_leak"]
    return shadow, abs(error["depth_bias"]), abs(error["push"])


def _pushed(weights: Path, device: str, threads: int, precision: str) -> dict[float, ShadowMethod]:
    """The method of a network by push."""
    network, dtype = open_network(weights, device, threads, precision)
    method = network_method(network, dtype)

    def pushed(push: float) -> ShadowMethod:
        def with_push(frame: GBuffer) -> OfBias:
            network.push = push
            return method(frame)

        return with_push

    return {push: pushed(push) for push in network.pushes}


if "snakemake" in globals():
    run_stage(snakemake, find_depth_bias)
