"""Where the module of a kind of network lies."""

from pathlib import Path

from neural_shadows.running.module_graph import PACKAGE


def kind_module(encoding: str) -> Path:
    """The module of a kind of network: `ray_grid_network.py` for the encoding `ray_grid`."""
    trained = PACKAGE / "networks" / "object_space" / f"{encoding}_network.py"
    untrained = PACKAGE / "networks" / "untrained" / trained.name
    return untrained if untrained.is_file() else trained
