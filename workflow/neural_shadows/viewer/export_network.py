"""A trained network as ONNX, with what a renderer must know to use it."""

import warnings
from pathlib import Path

import numpy as np
import torch
from torch import Tensor, nn

from neural_shadows.errors import InputError
from neural_shadows.evaluation.shadow_methods import take_found
from neural_shadows.files.whole_files import read_json, whole_file, write_json
from neural_shadows.networks.object_space.shadow_network import ShadowNetwork
from neural_shadows.networks.weight_file import load_network
from neural_shadows.rendering.gbuffer import SHADING_OFFSET
from neural_shadows.running.stage import run_stage

OPSET = 20
CHECKED_RAYS = 512
TOLERANCE = 1e-4  # sphere radii, for all but a few rays at an edge, which rounding can turn


class _InFloat32(nn.Module):
    """The network as a function of rays alone."""

    def __init__(self, network: ShadowNetwork):
        super().__init__()
        self.network = network

    def forward(self, origins: Tensor, directions: Tensor) -> Tensor:
        return self.network(origins, directions, torch.float32)


def random_rays(count: int, seed: int) -> tuple[np.ndarray, np.ndarray]:
    """Rays into the unit sphere: origins on it and unit directions inward, (count, 3) float32."""
    points = np.random.default_rng(seed).normal(size=(2, count, 3))
    origins, ends = points / np.linalg.norm(points, axis=-1, keepdims=True)
    directions = ends - origins
    directions /= np.linalg.norm(directions, axis=-1, keepdims=True)
    return origins.astype(np.float32), directions.astype(np.float32)


def export_onnx(network: ShadowNetwork, path: Path) -> None:
    """Write a network as ONNX: `origins`, `directions` (rays, 3) float32 to `t_pred` (rays,)."""
    origins, directions = map(torch.from_numpy, random_rays(64, seed=0))
    network.eval()
    with warnings.catch_warnings():
        # They are about the exporter itself, not the network.
        warnings.simplefilter("ignore")
        program = torch.onnx.export(
            _InFloat32(network),
            (origins, directions),
            input_names=["origins", "directions"],
            output_names=["t_pred"],
            dynamic_shapes=({0: "rays"}, {0: "rays"}),
            opset_version=OPSET,
            dynamo=True,
            verbose=False,
        )
    model = program.model_proto
    for node in model.graph.node:
        # Where in whose folders the exporter found it: nothing for a file that is given away.
        del node.metadata_props[:]
    with whole_file(path) as part:
        part.write_bytes(model.SerializeToString())


def largest_difference(network: ShadowNetwork, path: Path) -> float:
    """How far ONNX Runtime's t_pred is from PyTorch's, at the 99th percentile of random rays."""
    import onnxruntime

    origins, directions = random_rays(CHECKED_RAYS, seed=1)
    with torch.inference_mode():
        expected = _InFloat32(network)(torch.from_numpy(origins), torch.from_numpy(directions))
    session = onnxruntime.InferenceSession(path, providers=["CPUExecutionProvider"])
    (found,) = session.run(None, {"origins": origins, "directions": directions})
    return float(np.quantile(np.abs(found - expected.numpy()), 0.99))


def export_network(
    *,
    weights: Path,
    mesh_json: Path,
    depth_bias_json: Path | None,
    network_onnx: Path,
    network_json: Path,
    bias: float | str,
) -> None:
    """Write a trained network as ONNX, check it, and write its conventions.

    Args:
        mesh_json: description of the mesh that it was trained on.
        depth_bias_json: the depth bias and the push that were found for it, where `bias` is
            `held_out`.

    Raises:
        InputError: an input file is damaged; its kind has no ONNX form; or ONNX Runtime answers
            otherwise than PyTorch.
    """
    network, header = load_network(weights)
    if not network.exportable:
        raise InputError(
            f"{weights}: {header['network']['encoding']!r} is no network and has no ONNX form; "
            "export one of another encoding"
        )
    mesh = read_json(mesh_json)
    depth_bias = take_found(network, depth_bias_json) if depth_bias_json else bias
    export_onnx(network, network_onnx)
    difference = largest_difference(network, network_onnx)
    if not difference <= TOLERANCE:  # which NaN is not either
        network_onnx.unlink()
        raise InputError(
            f"{network_onnx}: ONNX Runtime's depths differ from PyTorch's by {difference:.2g} sphere "
            f"radii, more than {TOLERANCE}; the network cannot be exported with these versions"
        )
    write_json(
        network_json,
        {
            "name": header["name"],
            "network": header["network"],
            "training": header["training"],
            "sphere": {
                "centre": mesh["centre"],
                "radius": mesh["radius"],
                "units": "of the mesh's file",
            },
            "normalised": "x' = (x - centre) / radius; all below is in this space",
            "query": {
                "point": f"p = x' + {SHADING_OFFSET:g} n, n the surface's normal on the lit side",
                "light": "l, unit vector towards the light",
                "culled": "lit without a query if |p - (p.l) l| >= 1 or s <= 0",
                "directions": "d = -l",
                "origins": "o = p - (p.l) l + h l with h = sqrt(1 - |p - (p.l) l|^2)",
                "s": "h - p.l, the distance from o to p",
                "chord": "2 h",
                "shadowed": "min(s, chord) > t_pred + depth_bias",
                "depth_bias": depth_bias,
            },
            "onnx": {
                "opset": OPSET,
                "inputs": {"origins": "(rays, 3) float32", "directions": "(rays, 3) float32"},
                "outputs": {"t_pred": "(rays,) float32"},
                "difference_from_pytorch": difference,
            },
        },
    )


if "snakemake" in globals():
    run_stage(snakemake, export_network)
