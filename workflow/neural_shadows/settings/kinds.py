"""The kinds of tables, figures and claims: each is a module of its folder."""

from functools import cache
from importlib import import_module
from pathlib import Path
from types import ModuleType
from typing import Any

from neural_shadows.settings.base import by_kind

PACKAGE = Path(__file__).parents[1]


@cache
def kinds(folder: str) -> dict[str, ModuleType]:
    """The kinds of a folder of the package (`reports/tables`), by name: that of their file.

    A kind's module has `Settings`, the model of its section, with the file's name at one key: `kind`,
    of networks `encoding` or `form`.
    """
    names = sorted(path.stem for path in (PACKAGE / folder).glob("[a-z]*.py"))
    package = ".".join((PACKAGE.name, *folder.split("/")))
    return {name: import_module(f"{package}.{name}") for name in names}


def union(folder: str, default: str | None = None, key: str = "kind") -> Any:
    """The union of the `Settings` of a folder's kinds, which differ in one key."""
    return by_kind(key, *(one.Settings for one in kinds(folder).values()), default=default)
