"""Checkpoints of trainings: names, folders and lifetime."""

import hashlib
import json
import shutil
from collections.abc import Iterable
from pathlib import Path

from neural_shadows.running.module_graph import digest, modules_of
from neural_shadows.settings.records import WeightsHeader

# Beside the networks' folders, with a folder `<experiment>-<digest>` for each training.
CHECKPOINTS = "checkpoints"

STATE = "state.safetensors"  # in such a folder

STAGES = Path(__file__).parent  # folder of the training stages


def checkpoint_folder(weights: Path, header: WeightsHeader, code: Iterable[Path]) -> Path:
    """Checkpoint folder of a training: `networks/checkpoints/<experiment>-<digest>`.

    Snakemake deletes a failed job's outputs, so a checkpoint cannot be among them. Its name has a
    digest of the settings, the data and the code, so that changed ones start anew.

    Args:
        weights: `networks/<experiment>/weights.safetensors`; header: of that file.
        code: modules of the training's stage and its network's kind.
    """
    modules = {path for module in code for path in modules_of(module)}
    content = f"{json.dumps(header, sort_keys=True)} {digest(modules)}"
    name = hashlib.sha256(content.encode()).hexdigest()[:16]
    return weights.parents[1] / CHECKPOINTS / f"{header['name']}-{name}"


def remove_finished(networks: Path) -> None:
    """Remove the checkpoints of finished trainings.

    Call it once Snakemake has registered the weights. Before that it may delete and request them
    again, after a kill or on a full disk; the training then ends at once from its checkpoint.
    """
    for checkpoint in (networks / CHECKPOINTS).glob("*"):
        experiment = checkpoint.name.rpartition("-")[0]
        if (networks / experiment / "weights.safetensors").exists():
            shutil.rmtree(checkpoint, ignore_errors=True)
