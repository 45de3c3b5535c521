"""The shipped configuration, with overlays, as Snakemake merges it."""

import functools
import re
from copy import deepcopy

import yaml
from checkout import ROOT
from snakemake.utils import update_config

# The files of the default configuration, in the Snakefile's order.
DEFAULT = re.findall(r'configfile: "config/(\w+)\.yaml"', (ROOT / "Snakefile").read_text())


@functools.cache
def _file(name: str) -> dict:
    return yaml.safe_load((ROOT / "config" / f"{name}.yaml").read_text(encoding="utf-8"))


def shipped(*overlays: str, **values) -> dict:
    """The default's values with those of overlays in `config/` and further ones."""
    sections: dict = {}
    for name in (*DEFAULT, *overlays):
        update_config(sections, deepcopy(_file(name)))
    update_config(sections, values)
    return sections
