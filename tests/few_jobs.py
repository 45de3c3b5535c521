"""The smoke workflow with a job or two of every rule, for tests that disturb runs."""

import re
from collections import defaultdict
from collections.abc import Sequence
from pathlib import Path

import numpy as np
from checkout import Checkout, write_overlay
from engine_frames import NAMES, write_npz
from shipped import shipped

KEPT = {
    "tables": {
        *("table_4_3", "table_4_6", "soft_methods", "sun_hours"),
        *("nsm_table_s1", "nsm_table_s2"),  # a network of whole frames, and a profile of one
    },
    "figures": {"figure_4_4", "figure_3_1", "figure_sun_hours"},
    "claims": {"dragon_worse_than_512", "lower_bound_costs_more"},
}
TARGETS = [
    "all",
    "results/smoke/networks/dragon/network.onnx",
    "results/smoke/networks/shipped/weights.safetensors",
    "reports/smoke/answers/engine/base_hard.csv",
    "reports/smoke/expected_minutes.csv",
]


def few_jobs(path: Path, steps: int = 200) -> Path:
    """Write an overlay of the smoke scale that keeps the dragon's network, PCSS, cones and NSM alone.

    Beside it a frame of an engine, which it names.

    Args:
        steps: of its training.
    """
    sections = {section: {"*": None} | dict.fromkeys(kept, {}) for section, kept in KEPT.items()}
    biased = {"method": "dragon", "bias": "held_out", "label": "With its bias"}
    sections["tables"]["table_4_3"] = {"rows": ["shadow_map_512", "dragon", biased], "figures": []}
    sections["tables"]["table_4_6"] = {"rows": {"dragon": ["ray_traced", "dragon"]}}
    sections["tables"]["soft_methods"] = {"methods": ["pcss", "cone_1"]}
    weights = shipped()["experiments"]["kernels_enhanced"]["weights"]
    restored = {"network": "kernels_enhanced", "training": "kpnsm", "weights": weights}
    restored |= {"frame_set": "frames", "scenes": ["room_dragon"], "label": "Shipped"}
    sections["experiments"] = {"shipped": restored}
    sections["scenes"] = {"blinds": None}
    sections["frame_sets"] = {
        "frames": {"unseen": [], "sequence": 0},
        "engine": _engine_frames(path.with_name("engine")),
    }
    return write_overlay(path, trainings={"base": {"steps": steps}}, **sections)


def _engine_frames(folder: Path) -> dict[str, object]:
    """A frame set of one frame of 8 × 4 pixels, as an engine writes it: all is lit."""
    write_npz(folder / "quay/frame", {name: np.ones((4, 8), np.float32) for name in NAMES.values()})
    return {"path": str(folder), "engine": {"sizes": {"quay": 2.0}, "radii": [0], "targets": []}}


def files_of_rules(checkout: Checkout, overlays: Sequence[Path]) -> dict[str, list[str]]:
    """What the jobs of each rule write by `TARGETS`, whether it is there or not."""
    files = defaultdict(list)
    for row in checkout.summary(*TARGETS, overlays=overlays):
        files[row["rule"]].append(row["output_file"])
    return files


def rules_of(checkout: Checkout) -> set[str]:
    """The names of all rules."""
    graph = "".join(path.read_text() for path in checkout.folder.glob("workflow/rules/*.smk"))
    return set(re.findall(r"^rule (\w+):", graph, re.MULTILINE))
