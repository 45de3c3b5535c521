"""LPIPS of grey frames (Zhang et al. 2018), by the package `lpips` in ONNX."""

from collections.abc import Callable
from pathlib import Path

import numpy as np

from neural_shadows.errors import InputError
from neural_shadows.metrics.grey_images import check_pair
from neural_shadows.metrics.metric import Metric

METRICS = {"lpips": Metric("LPIPS", slow=True, comparable=False)}


def with_model(lpips_onnx: Path, threads: int) -> Callable[..., dict[str, float]]:
    """LPIPS of grey images (H, W) in [0, 1].

    In ONNX Runtime, which loads in 0.1 CPU s; torch, torchvision and lpips took each job 5 s. A pair of
    600 × 400 takes 0.22 CPU s by `squeeze`, in PyTorch 0.3 s; the values are the same to 1e-7.

    Args:
        lpips_onnx: of `find_lpips`.

    Raises:
        InputError: it cannot be read.
    """
    import onnxruntime

    options = onnxruntime.SessionOptions()
    options.intra_op_num_threads = threads
    try:
        model = onnxruntime.InferenceSession(
            lpips_onnx, options, providers=["CPUExecutionProvider"]
        )
    except Exception as error:  # of many kinds
        raise InputError(f"{lpips_onnx}: damaged ({error}). Delete it and run again.") from error

    def of_images(image: np.ndarray, reference: np.ndarray) -> dict[str, float]:
        check_pair(image, reference)
        pair = {"image": np.float32(image), "reference": np.float32(reference)}
        return {"lpips": float(model.run(None, pair)[0])}

    return of_images
