"""Export of a trained network as ONNX, with its conventions."""

import warnings
from pathlib import Path

import numpy as np
import torch
from torch import Tensor, nn

from neural_shadows.errors import InputError
from neural_shadows.evaluation.ray_network import take_constants
from neural_shadows.files.whole_files import read_json, whole_file, write_json
from neural_shadows.networks.object_space.shadow_network import ShadowNetwork
from neural_shadows.networks.weight_file import load_network
from neural_shadows.rendering.gbuffer import SHADING_OFFSET
from neural_shadows.running.stage import run_stage

OPSET = 20
CHECKED_RAYS = 512
TOLERANCE = 1e-4  # sphere radii, at the 99th percentile: rounding may flip rays at an edge


class _InFloat32(nn.Module):
    """Network as a function of rays only, in float32."""

    def __init__(self, network: ShadowNetwork):
        super().__init__()
        self.network = network

    def forward(self, origins: Tensor, directions: Tensor) -> Tensor:
        return self.network(origins, directions, torch.float32)


def random_rays(count: int, seed: int) -> tuple[np.ndarray, np.ndarray]:
    """Random rays into the unit sphere, (count, 3) float32 each.

    Origins lie on the sphere; directions are unit vectors inward."""
    points = np.random.default_rng(seed).normal(size=(2, count, 3))
    origins, ends = points / np.linalg.norm(points, axis=-1, keepdims=True)
    directions = ends - origins
    directions /= np.linalg.norm(directions, axis=-1, keepdims=True)
    return origins.astype(np.float32), directions.astype(np.float32)


def export_onnx(network: ShadowNetwork, path: Path) -> None:
    """Write a network as ONNX.

    Inputs `origins` and `directions`, (rays, 3) float32; output `t_pred`, (rays,) float32."""
    origins, directions = map(torch.from_numpy, random_rays(64, seed=0))
    network.eval()
    with warnings.catch_warnings():
        # The warnings concern the exporter, not the network.
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
        # Local paths of the exporting machine.
        del node.metadata_props[:]
    with whole_file(path) as part:
        part.write_bytes(model.SerializeToString())


def largest_difference(network: ShadowNetwork, path: Path) -> float:
    """Difference of ONNX Runtime's t_pred from PyTorch's, 99th percentile."""
    import onnxruntime

    origins, directions = random_rays(CHECKED_RAYS, seed=1)
    with torch.inference_mode():
        expected = _InFloat32(network)(torch.from_numpy(origins), torch.from_numpy(directions))
    session = onnxruntime.InferenceSession(path, providers=["CPUExecutionProvider"])
    (t_pred,) = session.run(None, {"origins": origins, "directions": directions})
    return float(np.quantile(np.abs(t_pred - expected.numpy()), 0.99))


def export_network(
    *,
    weights: Path,
    mesh_json: Path,
    depth_bias_json: Path | None,
    network_onnx: Path,
    network_json: Path,
    bias: float | str,
) -> None:
    """Write and check a network as ONNX, with its conventions.

    Args:
        mesh_json: description of the training mesh.
        depth_bias_json: held-out depth bias and push, where `bias` is `held_out`.

    Raises:
        InputError: an input file is damaged, the network's kind cannot be exported, or ONNX Runtime
            and PyTorch differ.
    """
    network, header = load_network(weights)
    if not network.exportable:
        raise InputError(
            f"{weights}: the encoding {header['network']['encoding']!r} has no ONNX form. "
            "Export a network of another encoding"
        )
    mesh = read_json(mesh_json)
    depth_bias = take_constants(network, depth_bias_json) if depth_bias_json else bias
    export_onnx(network, network_onnx)
    difference = largest_difference(network, network_onnx)
    if not difference <= TOLERANCE:  # catches NaN
        network_onnx.unlink()
        raise InputError(
            f"{network_onnx}: ONNX Runtime's depths differ from PyTorch's by {difference:.2g} sphere "
            f"radii, more than {TOLERANCE}. Install other versions of torch or onnxruntime"
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
