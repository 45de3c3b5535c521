"""Targets of a command line that no rule makes, and what was meant."""

from collections.abc import Iterable, Mapping
from pathlib import Path

import yaml

from neural_shadows.errors import InputError
from neural_shadows.sections.sections import Sections


def check_targets(targets: Iterable[str], config: Sections, folder: Path) -> None:
    """Check that targets are of the scale of the run, and files.

    Args:
        targets: the command line. folder: of the shipped configuration and its overlays.

    Raises:
        InputError: a target is in the folder of another scale, or the name of an entry.
    """
    scales = _scales(folder)
    for target in targets:
        top, _, rest = target.partition("/")
        scale = rest.partition("/")[0]
        if top in ("reports", "results") and "/" in rest and scale in scales:
            if scale != config.scale:
                raise InputError(
                    f"{target}: is of the scale {scale!r}, and this run is {config.scale!r}. Add "
                    f"`--configfile {scales[scale]}` behind the targets"
                )
        for section, ending in (("tables", "csv"), ("figures", "png"), ("viewers", "html")):
            if target in getattr(config, section):
                below = "reports" if config.scale == "desk" else f"reports/{config.scale}"
                raise InputError(
                    f"{target}: is no file but an entry of `{section}`. Ask for "
                    f"{below}/{target}.{ending}"
                )


def _scales(folder: Path) -> Mapping[str, str]:
    """The shipped overlays by their scales."""
    scales = {}
    for path in sorted(folder.glob("*.yaml")):
        if scale := yaml.safe_load(path.read_text(encoding="utf-8")).get("scale"):
            scales.setdefault(scale, f"config/{path.name}")
    return scales
