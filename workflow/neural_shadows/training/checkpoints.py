"""Checkpoints of trainings: what they are called, where they lie, and until when they are kept."""

import hashlib
import json
import shutil
from collections.abc import Iterable, Mapping
from pathlib import Path
from typing import Any

from neural_shadows.running.module_graph import modules_of

# Beside the folders of a run's networks. In it a folder `<experiment>-<digest>` for each training.
CHECKPOINTS = "checkpoints"

STATE = "state.safetensors"  # in such a folder

STAGES = Path(__file__).parent  # where the stages that train lie


def checkpoint_folder(weights: Path, header: Mapping[str, Any], code: Iterable[Path]) -> Path:
    """Where the checkpoint of a training lies: `networks/checkpoints/<experiment>-<digest>`.

    Snakemake deletes the outputs of a job that failed, so that a checkpoint cannot be among them.
    Its name holds a digest of the settings, the data and the code: changed ones thereby start
    anew and never resume from a state that they did not make.

    Args:
        weights: `networks/<experiment>/weights.safetensors`; header: of that file.
        code: the modules that the training is started from: its stage, and its network's kind.
    """
    digest = hashlib.sha256(json.dumps(header, sort_keys=True).encode())
    for module in code:
        for path in modules_of(module):
            digest.update(path.read_bytes())
    return weights.parents[1] / CHECKPOINTS / f"{header['name']}-{digest.hexdigest()[:16]}"


def remove_finished(networks: Path) -> None:
    """Remove the checkpoints of trainings whose weights are there.

    To be called when whoever asked for these has taken note of them. Before that Snakemake may
    yet delete one and ask for it again, after a kill or on a full disk; the training then ends
    at once.
    """
    for checkpoint in (networks / CHECKPOINTS).glob("*"):
        experiment = checkpoint.name.rpartition("-")[0]
        if (networks / experiment / "weights.safetensors").exists():
            shutil.rmtree(checkpoint, ignore_errors=True)
