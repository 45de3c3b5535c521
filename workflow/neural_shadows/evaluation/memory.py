"""Storage of networks and shadow maps, in bytes [4.4.2]."""

from pathlib import Path

from neural_shadows.evaluation.registry import METHODS, family_and_size


def network_bytes(weights: Path) -> int:
    """Bytes in a file of weights: 4 a weight of the thesis's network."""
    # safetensors: 8 bytes with the length of the header, the header, then the tensors alone.
    with weights.open("rb") as file:
        header = int.from_bytes(file.read(8), "little")
    return weights.stat().st_size - 8 - header


def stored_bytes(stored: str | Path) -> int | None:
    """Bytes of a method's file; None if it stores nothing.

    Args:
        stored: weights of a network, or the key of another method, without a bias.

    Returns:
        None for a null predictor, and for ray tracing, whose mesh the others need as well.
    """
    if isinstance(stored, Path):
        return network_bytes(stored)
    family, size = family_and_size(stored)
    of_size = METHODS[family].stored_bytes if family else None
    return of_size(size) if of_size else None
