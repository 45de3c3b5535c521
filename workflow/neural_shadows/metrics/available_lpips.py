"""LPIPS of a run, if available."""

from collections.abc import Callable
from pathlib import Path

from neural_shadows.files.whole_files import read_json


def lpips_metric(lpips_json: Path, threads: int) -> dict[str, Callable[..., float]]:
    """LPIPS by its name; empty where it is not available. The metric takes images (H, W) in [0, 1].

    Args:
        lpips_json: of `find_lpips`. threads: of PyTorch, from now on.
    """
    availability = read_json(lpips_json)
    if not availability["available"]:
        return {}
    # Here and not above: torch and torchvision take 3 s to import.
    import torch

    from neural_shadows.metrics.lpips_distance import make_lpips

    torch.set_num_threads(threads)
    trunk = Path(availability["trunk"]) if availability["trunk"] else None
    return {"lpips": make_lpips(availability["net"], trunk)}
