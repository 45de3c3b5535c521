"""The shipped configuration, with overlays, as Snakemake merges it."""

import functools
import re
from copy import deepcopy

import yaml
from checkout import ROOT
from snakemake.utils import update_config

from neural_shadows.config.reading import without_others

# The files of the default configuration, in the Snakefile's order.
DEFAULT = re.findall(r'configfile: "config/(\w+)\.yaml"', (ROOT / "Snakefile").read_text())


@functools.cache
def _file(name: str) -> dict:
    return yaml.safe_load((ROOT / "config" / f"{name}.yaml").read_text(encoding="utf-8"))


def shipped(*overlays: str, **values) -> dict:
    """The default's values with those of overlays in `config/` and further ones."""
    files = [*map(_file, (*DEFAULT, *overlays))]
    sections: dict = {}
    for part in (*files, values):
        update_config(sections, deepcopy(part))
    return without_others(sections, files)
