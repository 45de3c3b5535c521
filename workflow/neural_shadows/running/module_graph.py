"""Module dependencies of stages."""

import hashlib
import re
from collections.abc import Iterable
from functools import cache
from pathlib import Path

PACKAGE = Path(__file__).parents[1]

# Logs and error messages of all stages: no result depends on them.
_AROUND = PACKAGE / "running" / "stage.py"

# Configuration and file names: jobs have them as inputs and params, which Snakemake compares itself.
_OF_THE_GRAPH = (
    *(PACKAGE / room for room in ("settings", "sections", "layout", "networks/settings")),
    *(PACKAGE / "networks" / folder for folder in ("object_space/kinds", "screen_space/forms")),
)


# By a pattern: to parse all modules took 1.2 s of each start of Snakemake.
_IMPORT = re.compile(
    rf"^[ \t]*from ({PACKAGE.name}(?:\.[\w.]+)?) import (\([^)]*\)|[^\n]+)"
    rf"|^[ \t]*import [^\n]*?({PACKAGE.name}\.[\w.]+)",
    re.MULTILINE,
)


@cache
def _imported(source: Path) -> frozenset[Path]:
    """Modules of this package imported by a file, anywhere in it."""
    names = set()
    for package, imported, module in _IMPORT.findall(source.read_text(encoding="utf-8")):
        names |= {package or module}
        names |= {f"{package}.{name}" for name in re.findall(r"\w+", imported)}
    parts = [name.split(".")[1:] for name in names]
    paths = {PACKAGE.joinpath(*part).with_suffix(".py") for part in parts if part}
    return frozenset(path for path in paths if path.is_file() and path.parent not in _OF_THE_GRAPH)


@cache
def modules_of(stage: Path) -> list[Path]:
    """A stage's file and the package's modules it imports, transitively.

    Snakemake tracks a script by its age and not what it imports. With their digest as a rule's
    param an edited module reruns the rules whose results depend on it, and no others.

    Args:
        stage: or the file of a kind of network, of which only its imports count.

    Returns:
        Sorted paths, without `stage.py` and what it alone imports.
    """
    modules, queue = {stage}, [stage]
    while queue:
        new = _imported(queue.pop()) - modules - {_AROUND}
        modules |= new
        queue += new
    return sorted(path for path in modules if path.parent not in _OF_THE_GRAPH)


def digest(modules: Iterable[Path]) -> str:
    """Of modules' names and content, 16 hexadecimal digits."""
    content = hashlib.sha256()
    for module in sorted(modules):
        content.update(f"{module.relative_to(PACKAGE)} {_content(module)} ".encode())
    return content.hexdigest()[:16]


@cache
def _content(module: Path) -> str:
    return hashlib.sha256(module.read_bytes()).hexdigest()
