"""Checks of command-line targets, with suggestions."""

import re
from collections.abc import Iterable, Mapping
from pathlib import Path, PurePath

from neural_shadows.config.whole import RESERVED_TABLES
from neural_shadows.errors import InputError
from neural_shadows.evaluation.registry import FRAME_METHODS
from neural_shadows.sections.frame_tables import check_method
from neural_shadows.sections.sections import Sections
from neural_shadows.settings.base import check_among


def check_targets(targets: Iterable[str], config: Sections, folder: Path) -> None:
    """Check that targets are files of the run's scale.

    Args:
        targets: of the command line. folder: of the shipped configuration and its overlays.

    Raises:
        InputError: a target is in the folder of another scale, or the name of an entry; or a method
            cannot answer a user's frames.
    """
    scales = _scales(folder)
    for target in targets:
        _check_scale(target, config, scales)
        _check_answers(target, config)
        for section, ending in (("tables", "csv"), ("figures", "png"), ("viewers", "html")):
            if target in getattr(config, section):
                below = "reports" if config.scale == "desk" else f"reports/{config.scale}"
                raise InputError(
                    f"{target}: is an entry of `{section}`, not a file. Use "
                    f"{below}/{target}.{ending}"
                )


def _check_scale(target: str, config: Sections, overlays: Mapping[str, str]) -> None:
    """Check that a target is in the run's folder."""
    top, _, rest = target.partition("/")
    folder = rest.partition("/")[0] if "/" in rest else "desk"
    if top not in ("reports", "results") or folder == config.scale:
        return
    if folder != "desk" and folder in overlays:
        raise InputError(
            f"{target}: has the scale {folder!r}, and this run {config.scale!r}. Add "
            f"`--configfile {overlays[folder]}` after the targets"
        )
    # Of the others only reports: as a module, a workflow has targets of its own.
    entries = *config.tables, *config.figures, *config.viewers
    if top == "reports" and PurePath(rest).stem in (*RESERVED_TABLES, *entries):
        own = "reports" if config.scale == "desk" else f"reports/{config.scale}"
        raise InputError(
            f"{target}: this run has the scale {config.scale!r}. Use {own}/{PurePath(rest).name}"
            + (f", or add `--config scale={folder}` after the targets" if folder != "desk" else "")
        )


def _check_answers(target: str, config: Sections) -> None:
    """Check a method for `reports/answers/FRAME_SET/METHOD.csv`."""
    if not (match := re.fullmatch(r"reports/(?:\w+/)?answers/(\w+)/(\w+)(?:\.csv)?", target)):
        return
    frame_set, method = match.groups()
    methods = [*FRAME_METHODS, *config.screen_experiments, *config.networks_by_scene]
    try:
        check_among(target, frame_set, config.soft_frame_sets)
        check_among(target, method, methods)
        check_method(config, f"{target}: {method!r}", frame_set, method)
    except ValueError as error:
        raise InputError(str(error)) from error


def _scales(folder: Path) -> Mapping[str, str]:
    """Shipped overlays by scale."""
    scales = {}
    for path in sorted(folder.glob("*.yaml")):
        if scale := re.search(r"^scale: (\w+)", path.read_text(encoding="utf-8"), re.MULTILINE):
            scales.setdefault(scale[1], f"config/{path.name}")
    return scales
