"""How much memory a network and a shadow map take, by formula and as stored [4.4.2]."""

from pathlib import Path

import numpy as np

from neural_shadows.evaluation.method_names import resolution_of
from neural_shadows.meshes.prepared_mesh import PreparedMesh
from neural_shadows.scenes.tracing import Tracer
from neural_shadows.shadow_maps.shadow_map import shadow_map_square, texel_heights

FLOAT_BYTES = 4


def network_bytes(weights: Path) -> int:
    """Bytes of all that a file of weights stores; 4 for each weight of the thesis's network."""
    # safetensors: 8 bytes with the length of the header, the header, then the tensors alone.
    with weights.open("rb") as file:
        header = int.from_bytes(file.read(8), "little")
    return weights.stat().st_size - 8 - header


def shadow_map_bytes(method: str) -> int:
    """4 N² bytes of the map `shadow_map_N`: a float32 depth in each texel."""
    return FLOAT_BYTES * resolution_of(method) ** 2


def shadow_map_file_bytes(mesh: PreparedMesh, tracer: Tracer, method: str) -> int:
    """Bytes of a map of this mesh as it is traced."""
    square = shadow_map_square(mesh.vertices, np.array([0.0, 0.0, 1.0]))
    resolution = resolution_of(method)
    return texel_heights(tracer, square, resolution, np.arange(resolution**2)).nbytes
