"""How much memory a network and a shadow map take [4.4.2]."""

from pathlib import Path

from neural_shadows.evaluation.method_names import resolution_of

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
