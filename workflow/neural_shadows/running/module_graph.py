"""Module dependencies of stages."""

import hashlib
import re
from collections.abc import Iterable
from functools import cache
from operator import attrgetter
from pathlib import Path

PACKAGE = Path(__file__).parents[1]
_NAME = PACKAGE.name

# Logs and error messages of all stages: no result depends on them.
_AROUND = PACKAGE / "running" / "stage.py"

# Configuration and file names: jobs have them as inputs and params, which Snakemake compares itself.
_OF_THE_GRAPH = (
    *(
        PACKAGE / room
        for room in ("settings", "sections", "layout", "networks/settings", "training/settings")
    ),
    *(PACKAGE / "networks" / folder for folder in ("object_space/kinds", "screen_space/forms")),
)


# What a module imports by walking a folder.
_WALKED = {PACKAGE / "metrics" / "registry.py": PACKAGE / "metrics" / "kinds"}

# By a pattern: to parse all modules took 1.2 s of each start of Snakemake.
_IMPORT = re.compile(
    rf"^[ \t]*from ({PACKAGE.name}(?:\.[\w.]+)?) import (\([^)]*\)|[^\n]+)"
    rf"|^[ \t]*import [^\n]*?({PACKAGE.name}\.[\w.]+)",
    re.MULTILINE,
)

# On lines of their own. A text may have lines that begin with ##, and none with one #.
_COMMENT = re.compile(r"^[ \t]*#(?!#).*\n", re.MULTILINE)
_DOCSTRING = re.compile(r'^([ \t]*)"""(?=[\w`(−]).*?"""[ \t]*$', re.MULTILINE | re.DOTALL)

# Of annotations alone, which no result depends on.
_TYPES = re.compile(r"^if TYPE_CHECKING:.*\n(?:(?:[ \t]+.*)?\n)+", re.MULTILINE)


@cache
def _imported(source: Path) -> frozenset[Path]:
    """Modules of this package imported by a file, anywhere in it but for types."""
    names = set()
    text = _TYPES.sub("", source.read_text(encoding="utf-8"))
    for package, imported, module in _IMPORT.findall(text):
        names |= {package or module}
        names |= {f"{package}.{name}" for name in re.findall(r"\w+", imported)}
    files = _files(PACKAGE)
    paths = {files[name] for name in names if name in files}
    if source in _WALKED:
        paths |= {*_WALKED[source].glob("*.py")}
    return frozenset(path for path in paths if path.parent not in _OF_THE_GRAPH)


@cache
def _files(package: Path) -> dict[str, Path]:
    """Files of a package by their modules' names."""
    files = package.glob("**/*.py")
    return {
        ".".join((_NAME, *file.relative_to(package).with_suffix("").parts)): file for file in files
    }


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
    return _sorted(path for path in modules if path.parent not in _OF_THE_GRAPH)


def digest(modules: Iterable[Path]) -> str:
    """Of modules' names and code, 16 hexadecimal digits.

    Edited docstrings, and comments on lines of their own, rerun nothing.
    """
    content = hashlib.sha256()
    for module in _sorted(modules):
        content.update(_content(module))
    return content.hexdigest()[:16]


def _sorted(paths: Iterable[Path]) -> list[Path]:
    return sorted(paths, key=attrgetter("parts"))  # paths themselves compare far more slowly


@cache
def _content(module: Path) -> bytes:
    """A module's name and a digest of its content, with the C file beside it of its name."""
    content, in_c = _code(module.read_text(encoding="utf-8")).encode(), module.with_suffix(".c")
    if in_c.exists():
        content += in_c.read_bytes()
    return f"{module.relative_to(PACKAGE)} {hashlib.sha256(content).hexdigest()} ".encode()


def _code(text: str) -> str:
    """A module's text with no comment on a line of its own and with empty docstrings."""
    return _DOCSTRING.sub(r'\1""', _COMMENT.sub("", text))
