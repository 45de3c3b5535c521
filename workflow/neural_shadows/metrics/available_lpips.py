"""LPIPS where its trunk was found, else nothing."""

from collections.abc import Callable
from pathlib import Path

from neural_shadows.files.whole_files import read_json


def lpips_metric(lpips_json: Path, threads: int) -> dict[str, Callable[..., float]]:
    """LPIPS by its name, for images (H, W) in [0, 1]; nothing where it is not available.

    Args:
        lpips_json: what `find_lpips` wrote. threads: of PyTorch, from now on.
    """
    found = read_json(lpips_json)
    if not found["available"]:
        return {}
    # Here and not above: torch and torchvision take 3 s to import.
    import torch

    from neural_shadows.metrics.lpips_distance import make_lpips

    torch.set_num_threads(threads)
    trunk = Path(found["trunk"]) if found["trunk"] else None
    return {"lpips": make_lpips(found["net"], trunk)}
