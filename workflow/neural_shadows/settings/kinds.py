"""Kinds of reports and networks: one module each."""

from functools import cache
from importlib import import_module
from pathlib import Path
from types import ModuleType
from typing import Any

from neural_shadows.settings.base import by_kind

PACKAGE = Path(__file__).parents[1]


@cache
def kinds(folder: str) -> dict[str, ModuleType]:
    """Modules of a folder of the package (`reports/tables`), by name.

    A kind's module has `Settings`, the model of its section, with the file's name at one key: `kind`,
    of networks `encoding` or `form`.
    """
    names = sorted(path.stem for path in (PACKAGE / folder).glob("[a-z]*.py"))
    package = ".".join((PACKAGE.name, *folder.split("/")))
    return {name: import_module(f"{package}.{name}") for name in names}


def union(folder: str, default: str | None = None, key: str = "kind") -> Any:
    """Union of the `Settings` of a folder's kinds."""
    return by_kind(key, *(module.Settings for module in kinds(folder).values()), default=default)
