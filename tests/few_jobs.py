"""The smoke workflow with a job or two of every rule, for tests that disturb runs."""

from pathlib import Path

import yaml
from checkout import ROOT, write_overlay

KEPT = {
    "tables": {"table_4_3", "table_4_6", "soft_methods", "cost"},
    "figures": {"figure_4_4", "figure_3_1"},
    "claims": {"dragon_worse_than_512"},
}
TARGETS = [
    "all",
    "results/smoke/cost/samples.10000.json",
    "results/smoke/networks/dragon/network.onnx",
]
NO_JOB = {"download_mesh"}  # of the rules, at the smoke scale


def few_jobs(path: Path, steps: int = 200) -> Path:
    """Write an overlay of the smoke scale that keeps the dragon's network and PCSS alone.

    Args:
        steps: of its training.
    """
    reports = yaml.safe_load((ROOT / "config/reports.yaml").read_text(encoding="utf-8"))
    sections = {
        section: dict.fromkeys(reports[section].keys() - kept) for section, kept in KEPT.items()
    }
    biased = {"method": "dragon", "bias": "held_out", "label": "With its bias"}
    sections["tables"]["table_4_3"] = {"rows": ["shadow_map_512", "dragon", biased], "figures": []}
    sections["tables"]["table_4_6"] = {"rows": {"dragon": ["ray_traced", "dragon"]}}
    sections["tables"]["soft_methods"] = {"methods": ["pcss"]}
    sections["frame_sets"] = {"frames": {"unseen": [], "sequence": 0}}
    return write_overlay(path, trainings={"base": {"steps": steps}}, **sections)
