"""The depth biases that `depth_bias` found, read from their files."""

from collections.abc import Iterable
from pathlib import Path
from typing import Any

from pydantic import FiniteFloat
from typing_extensions import TypedDict

from neural_shadows.evaluation.method_names import biased_key
from neural_shadows.files.records import _read


class _DepthBias(TypedDict):
    depth_bias: FiniteFloat


def read_bias_search(path: str | Path) -> dict[str, Any]:
    """What `find_depth_biases` wrote, by experiment."""
    return _read(path, dict[str, _DepthBias], "file of depth biases")


def biases_by_method(paths: Iterable[Path]) -> dict[str, float]:
    """The depth bias of each method that has one found, from files of `find_depth_biases`.

    Raises:
        InputError: a file is missing, or not whole.
    """
    return {
        biased_key(name): bias for path in paths for name, bias in read_depth_biases(path).items()
    }


def read_depth_biases(path: Path) -> dict[str, float]:
    """The depth bias of each experiment that `find_depth_biases` found.

    Raises:
        InputError: the file is missing, or not whole.
    """
    return {name: found["depth_bias"] for name, found in read_bias_search(path).items()}
