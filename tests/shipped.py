"""The shipped configuration, with overlays, as Snakemake merges it."""

import functools
from copy import deepcopy

import yaml
from checkout import ROOT
from snakemake.utils import update_config


@functools.cache
def _file(name: str) -> dict:
    return yaml.safe_load((ROOT / "config" / f"{name}.yaml").read_text(encoding="utf-8"))


def shipped(*overlays: str, **values) -> dict:
    """The default's values with those of overlays in `config/` and further ones."""
    sections: dict = {}
    for name in ("config", "reports", *overlays):
        update_config(sections, deepcopy(_file(name)))
    update_config(sections, values)
    return sections
