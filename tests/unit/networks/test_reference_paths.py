"""No convolution or product of a network's in oneDNN's reference path, naive loops.

They take 20 times as long and more, without a word: a format that the processor lacks, or an order
of memory. oneDNN's verbose output has them as `ref`; it is switched on before the first import of
torch, hence a process of its own, which is this file as a script.
"""

import os
import re
import subprocess
import sys
from collections import defaultdict
from pathlib import Path

import pytest

FOUR = ["c_e", "view", "ratio", "difference"]
KERNELS = {"form": "kernels", "widths": [8, 8, 16], "filters": 2}
KERNELS |= {"features": ["cosine", "penumbra", "z_b", "base_hard"]}
FORMS = {
    "full": {"form": "full", "widths": [8, [16, 8], 32], "features": FOUR, "extraction": 6},
    "shuffle": {"form": "shuffle", "widths": [8, 16], "features": FOUR},
    "half": {"form": "half", "widths": [8, 16], "features": FOUR},
    "original": {"form": "original", "widths": [8, 16, 32], "features": FOUR},
    "kernels": KERNELS,
    "full ends": KERNELS | {"ends": "full"},
    "direct": {"form": "direct", "widths": [8, 8, 16], "features": FOUR},
}
PRODUCTS = {"convolution", "deconvolution", "inner_product", "matmul"}


def products(output: str) -> dict[str, set[str]]:
    """Implementations of products by the section, a line `## NAME`, of oneDNN's verbose output."""
    found, section = defaultdict(set), ""
    for line in output.splitlines():
        if line.startswith("## "):
            section = line.removeprefix("## ")
        # onednn_verbose,v1,primitive,exec,cpu,convolution,jit:avx2,forward_training,…
        fields = re.split(",(?:v[0-9]+,primitive,)?", line)
        if fields[0] == "onednn_verbose" and fields[1] == "exec" and fields[3] in PRODUCTS:
            found[section].add(fields[4])
    return found


def references(implementations: set[str]) -> list[str]:
    return sorted(name for name in implementations if re.search(r"\bref(_|\b)", name))


def test_reference_paths_are_found():
    line = "onednn_verbose,v1,primitive,exec,cpu,{},forward_training,src:bf16::blocked:acdb::f0"
    names = "convolution,ref:any", "matmul,gemm:ref", "reorder,ref:any", "convolution,brg_conv:avx2"
    found = products("\n".join(["## a", *map(line.format, names[:2])]))
    assert references(found["a"]) == ["gemm:ref", "ref:any"]
    assert references(products("\n".join(map(line.format, names[2:])))[""]) == []


@pytest.fixture(scope="module")
def found(tmp_path_factory):
    folder = tmp_path_factory.mktemp("products")
    environment = os.environ | {"ONEDNN_VERBOSE": "1", "PYTHONPATH": os.pathsep.join(sys.path)}
    command = [sys.executable, __file__, str(folder)]
    done = subprocess.run(command, env=environment, capture_output=True, text=True)
    assert done.returncode == 0, done.stderr
    return products(done.stdout)


@pytest.mark.parametrize("use", ["training", "inference"])
@pytest.mark.parametrize("form", FORMS)
def test_convolutions(found, form, use):
    # None at all: in torch's own loops, as bfloat16 without AVX-512.
    assert found[f"{form} {use}"] != set() and references(found[f"{form} {use}"]) == []


def test_products_of_rays(found):
    """In float32 they are MKL's, and oneDNN has none."""
    assert references(found["rays"]) == []


def main(folder: Path) -> None:
    """Train each form for two steps and answer a frame with it; train on rays and ask them."""
    import numpy as np
    import screen_frames
    import torch
    from built_networks import make_network
    from rays import ball_batch

    from neural_shadows.evaluation.screen_network_method import screen_method
    from neural_shadows.frames.buffers import CHANNELS
    from neural_shadows.frames.setting import setting_of
    from neural_shadows.networks.compute import choose_dtype
    from neural_shadows.rendering.gbuffer import lens_of
    from neural_shadows.rendering.light_shape import light_shape
    from neural_shadows.running.stage import converted
    from neural_shadows.training.train_on_frames import train_on_frames
    from neural_shadows.training.training_run import TrainingRun

    # On one thread torch has loops of its own, around MKL's products, for 1 × 1 pixels and for less
    # than 20,480 numbers.
    screen_frames.WIDTH, screen_frames.HEIGHT = width, height = 160, 128
    part = screen_frames.write_frames(folder)
    training = {"optimiser": "adam", "steps": 2, "crops": 2, "crop": 128, "learning_rate": 1e-3}
    training |= {"schedule": "cosine", "alpha": 0.9, "perceptual": {"net": "none"}}
    training |= {"perturbation": 3.0, "perturbation_from": 0.0, "aligned": False, "flips": True}
    arguments = {"train": [part], "validation": [part], "training": training, "scenes": ["wall"]}
    arguments |= {"lights": None, "seed": 1, "trunk": None, "device": "cpu"}
    buffers = dict.fromkeys(CHANNELS, np.full((height, width), 0.5, np.float32))
    lens = lens_of(setting_of(screen_frames.SETTING).camera, width, height)
    for name, network in FORMS.items():
        print("##", name, "training", flush=True)
        files = ("weights.safetensors", "loss.csv", "training.json")
        paths = [folder / name / file for file in files]
        arguments |= dict(zip(("weights", "loss_csv", "training_json"), paths))
        arguments |= {"network": network, "experiment": name}
        train_on_frames(**converted(train_on_frames, arguments))
        print("##", name, "inference", flush=True)
        torch.set_num_threads(2)
        screen_method(paths[0]).of_buffers(buffers, lens, 0.25, 4.0, light_shape(None))
    print("## rays", flush=True)
    network = make_network(
        {"encoding": "frequency", "frequencies": 4, "width": 64, "hidden_layers": 2}
    )
    network.initialise(1)
    cpu, batch = torch.device("cpu"), ball_batch(5000)
    settings = {"optimiser": "adam", "steps": 2, "batch_size": 5000, "learning_rate": 1e-3}
    settings |= {"schedule": "constant", "loss": {}, "seed": 1, "device": "cpu"}
    TrainingRun(network, settings | {"precision": "auto"}).train_step(batch)
    network.depths(batch.origins, batch.directions[0], choose_dtype("auto", cpu))


if __name__ == "__main__":
    main(Path(sys.argv[1]))
