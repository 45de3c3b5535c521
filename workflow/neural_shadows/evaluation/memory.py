"""Bytes that networks and shadow maps store [4.4.2]."""

from pathlib import Path

from neural_shadows.evaluation.method_names import METHODS, family_and_size


def network_bytes(weights: Path) -> int:
    """Bytes of all that a file of weights stores; 4 for each weight of the thesis's network."""
    # safetensors: 8 bytes with the length of the header, the header, then the tensors alone.
    with weights.open("rb") as file:
        header = int.from_bytes(file.read(8), "little")
    return weights.stat().st_size - 8 - header


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
    family, size = family_and_size(stored)
    of_size = METHODS[family].stored_bytes if family else None
    return of_size(size) if of_size else None
