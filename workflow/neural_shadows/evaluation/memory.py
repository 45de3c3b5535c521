"""How much memory a network and a shadow map take [4.4.2]."""

from pathlib import Path

from neural_shadows.evaluation.method_names import family_of, is_map, resolution_of


def network_bytes(weights: Path) -> int:
    """Bytes of all that a file of weights stores; 4 for each weight of the thesis's network."""
    # safetensors: 8 bytes with the length of the header, the header, then the tensors alone.
    with weights.open("rb") as file:
        header = int.from_bytes(file.read(8), "little")
    return weights.stat().st_size - 8 - header


def shadow_map_bytes(method: str) -> int:
    """Bytes of the N² heights of a map FAMILY_N, stored as while it answers."""
    return family_of(method).texel_bytes * resolution_of(method) ** 2


def stored_bytes(stored: str | Path) -> int | None:
    """Bytes that a method's file holds.

    Args:
        stored: weights of a network, or the key of another method, without a bias.

    Returns:
        None for what stores nothing of its own: a null predictor, and ray tracing, whose mesh the
        others need as well.
    """
    if isinstance(stored, Path):
        return network_bytes(stored)
    return shadow_map_bytes(stored) if is_map(stored) else None
