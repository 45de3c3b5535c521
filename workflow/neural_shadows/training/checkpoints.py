"""States of trainings: where they lie in a run's folder, and until when they are kept."""

import shutil
from pathlib import Path

# In the folder of a run's networks. In it a folder `<experiment>-<digest>` for each training.
UNFINISHED = "unfinished"


def forget_finished(networks: Path) -> None:
    """Remove the states of trainings whose networks are there.

    To be called when whoever asked for these has taken note of them. Before that Snakemake may
    yet delete one and ask for it again, after a kill or on a full disk; the training then ends
    at once.

    Args:
        networks: the folder of a run's networks, each in a folder of its experiment's name.
    """
    for state in (networks / UNFINISHED).glob("*"):
        experiment = state.name.rpartition("-")[0]
        if (networks / experiment / "weights.safetensors").exists():
            shutil.rmtree(state, ignore_errors=True)
