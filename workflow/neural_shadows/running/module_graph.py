"""Which modules of the package a stage's result depends on."""

import ast
import hashlib
from collections.abc import Iterable
from functools import cache
from pathlib import Path

PACKAGE = Path(__file__).parents[1]

# What every stage does around its one call: the log and the message of an error. No result
# depends on it, and an edit of a log's wording must not train a network.
_AROUND = PACKAGE / "running" / "stage.py"

# What reads the configuration and names files. A job has it as inputs and params, which Snakemake
# compares itself: a new check must write no table anew.
_OF_THE_GRAPH = (
    *(PACKAGE / room for room in ("settings", "sections", "layout", "networks/settings")),
    *(PACKAGE / "networks" / folder for folder in ("object_space/kinds", "screen_space/forms")),
)


@cache
def _imported(source: Path) -> frozenset[Path]:
    """Modules of this package that a file imports, at its top or inside a function."""
    names = set()
    for node in ast.walk(ast.parse(source.read_text(encoding="utf-8"))):
        if isinstance(node, ast.Import):
            names |= {alias.name for alias in node.names}
        elif isinstance(node, ast.ImportFrom) and node.module:
            names |= {node.module} | {f"{node.module}.{alias.name}" for alias in node.names}
    parts = [name.split(".")[1:] for name in names if name.startswith(f"{PACKAGE.name}.")]
    paths = {PACKAGE.joinpath(*part).with_suffix(".py") for part in parts}
    return frozenset(path for path in paths if path.is_file() and path.parent not in _OF_THE_GRAPH)


def modules_of(stage: Path) -> list[Path]:
    """A stage's file and the package's modules that it imports, directly or through others.

    Snakemake tracks a script by its age and not what it imports. With their digest as a rule's
    param an edited module reruns the rules whose results depend on it, and no others.

    Args:
        stage: or the file of a kind of network, of which only its imports count.

    Returns:
        Sorted paths, without `stage.py` and what it alone imports.
    """
    found, queue = {stage}, [stage]
    while queue:
        new = _imported(queue.pop()) - found - {_AROUND}
        found |= new
        queue += new
    return sorted(path for path in found if path.parent not in _OF_THE_GRAPH)


def digest(modules: Iterable[Path]) -> str:
    """Of modules' names and content, 16 hexadecimal digits."""
    found = hashlib.sha256()
    for module in sorted(modules):
        found.update(f"{module.relative_to(PACKAGE)} {_content(module)} ".encode())
    return found.hexdigest()[:16]


@cache
def _content(module: Path) -> str:
    return hashlib.sha256(module.read_bytes()).hexdigest()
