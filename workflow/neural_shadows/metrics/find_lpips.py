"""Stage: LPIPS's model in a run, for all evaluation jobs."""

import socket
import sys
import warnings
from pathlib import Path
from typing import TYPE_CHECKING

from neural_shadows.files.whole_files import whole_file, write_json
from neural_shadows.networks.pretrained_trunk import MODELS, Net, read_trunk
from neural_shadows.running.stage import run_stage

if TYPE_CHECKING:
    import lpips


def find_lpips(trunk: Path | None, lpips_json: Path, lpips_onnx: Path, *, net: Net) -> None:
    """Write LPIPS with its pretrained backbone as ONNX, and its availability.

    Keys: `net`, `trunk`, `available` and `reason`. A backbone that cannot be downloaded leaves
    LPIPS out, with a reason in the tables, and the model empty. A configured one must work.

    Raises:
        InputError: the config's own `trunk` cannot be used.
    """
    reason = None
    socket.setdefaulttimeout(60)  # torch.hub has no timeout of its own
    with whole_file(lpips_onnx) as part:
        try:
            model = load_model(net, trunk)
        except (OSError, RuntimeError) as error:
            # Without the path of the cache in a home directory: reports show the reason.
            cause = getattr(error, "reason", None) or getattr(error, "strerror", None) or error
            reason = (
                f"torchvision's weights of {MODELS[net]} cannot be downloaded ({cause}). Set the "
                f"config key metrics.lpips.trunk to a local copy."
            )
            print(f"LPIPS is left out: {reason}", file=sys.stderr)
            part.touch()
        else:
            export_onnx(model, part)
    settings = {"net": net, "trunk": str(trunk) if trunk else None}
    write_json(lpips_json, {**settings, "available": reason is None, "reason": reason})


def load_model(net: Net, trunk: Path | None) -> "lpips.LPIPS":
    """LPIPS 0.1 with a backbone from a file or torch's cache. Without a file, torchvision's.

    That cache is `$TORCH_HOME/hub/checkpoints`, by default in `~/.cache/torch`; what is not in it
    is downloaded. The package has the linear heads.

    Raises:
        InputError: the file `trunk` cannot be used.
        OSError, RuntimeError: torchvision's cannot be downloaded, or is damaged.
    """
    import lpips

    with warnings.catch_warnings():
        # lpips 0.1.4 names torchvision's models in the manner of torchvision 0.12.
        warnings.filterwarnings("ignore", category=UserWarning, module="torchvision")
        model = lpips.LPIPS(net=net, version="0.1", pnet_rand=trunk is not None, verbose=False)
    if trunk:
        weights = read_trunk(net, trunk)
        # lpips cuts the backbone into slices but keeps the layers' numbers: slice2.3.weight.
        slices = {key: weights[key.partition(".")[2]] for key in model.net.state_dict()}
        model.net.load_state_dict(slices)
    return model.eval()


def export_onnx(model: "lpips.LPIPS", path: Path) -> None:
    """Write LPIPS of grey images.

    Inputs `image` and `reference`, (height, width) float32 in [0, 1]; output `distance`.
    """
    import torch

    class OfGrey(torch.nn.Module):
        def __init__(self) -> None:
            super().__init__()
            self.model = model

        def forward(self, image: torch.Tensor, reference: torch.Tensor) -> torch.Tensor:
            pair = (grey.expand(1, 3, *grey.shape) for grey in (image, reference))
            return self.model(*pair, normalize=True).reshape(())

    sides = {0: "height", 1: "width"}
    with warnings.catch_warnings():
        # By tracing, which is deprecated: 0.5 s, where torch.export takes 18 s.
        warnings.simplefilter("ignore")
        torch.onnx.export(
            OfGrey(),
            (torch.rand(64, 96), torch.rand(64, 96)),
            path,
            input_names=["image", "reference"],
            output_names=["distance"],
            dynamic_axes={"image": sides, "reference": sides},
            dynamo=False,
        )


if "snakemake" in globals():
    run_stage(snakemake, find_lpips)
