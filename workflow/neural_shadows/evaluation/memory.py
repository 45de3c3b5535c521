"""How much memory a network and a shadow map take: by formula, checked against files [4.4.2]."""

import tempfile
from pathlib import Path

import numpy as np

from neural_shadows.errors import InputError
from neural_shadows.evaluation.method_names import resolution_of
from neural_shadows.files.whole_files import write_array
from neural_shadows.meshes.prepared_mesh import PreparedMesh
from neural_shadows.networks.weight_file import load_network
from neural_shadows.scenes.tracing import Tracer
from neural_shadows.shadow_maps.shadow_map import shadow_map_square, texel_heights

FLOAT_BYTES = 4


def network_bytes(weights: Path) -> int:
    """Bytes of all that the network in this file stores; 4 for each weight of the thesis's [4.4.2].

    Raises:
        InputError: the file's tensors take another size: it is not whole, or of another precision.
    """
    network, _ = load_network(weights)
    formula = sum(tensor.nbytes for tensor in network.stored().values())
    # safetensors: 8 bytes with the length of the header, the header, then the tensors alone.
    with weights.open("rb") as file:
        header = int.from_bytes(file.read(8), "little")
    stored = weights.stat().st_size - 8 - header
    if stored != formula:
        raise InputError(
            f"{weights}: holds {stored:,} bytes of weights, not {formula:,}; "
            "delete it and train again"
        )
    return formula


def shadow_map_bytes(method: str) -> int:
    """4 N² bytes of the map `shadow_map_N`: a float32 depth in each texel [4.4.2]."""
    return FLOAT_BYTES * resolution_of(method) ** 2


def shadow_map_file_bytes(mesh: PreparedMesh, tracer: Tracer, method: str) -> int:
    """Size of the file that a map of this mesh makes, without the header that names its shape."""
    resolution = resolution_of(method)
    square = shadow_map_square(mesh.vertices, np.array([0.0, 0.0, 1.0]))
    heights = texel_heights(tracer, square, resolution, np.arange(resolution**2))
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "map.npy"
        write_array(path, heights.reshape(resolution, resolution))
        with path.open("rb") as file:
            np.lib.format.read_magic(file)
            np.lib.format.read_array_header_1_0(file)
            return path.stat().st_size - file.tell()
