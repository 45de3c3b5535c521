"""A small scene with references and an untrained network on disk, for tests of evaluation."""

from pathlib import Path
from typing import NamedTuple

from shapes import SPHERE_OF_LIGHTS, bumpy_sphere

from neural_shadows.evaluation.render_references import render_references
from neural_shadows.files.whole_files import write_json
from neural_shadows.networks.object_space.frequency_network import FrequencyNetwork
from neural_shadows.networks.weight_file import save_network

SCENE = {"up": "y", "ground": True, "light": SPHERE_OF_LIGHTS}
FRAMES = {"width": 96, "height": 64, "view_sets": ["shadow", "surface"], "seed": 3}
TINY = {"frequencies": 2, "width": 16, "hidden_layers": 1}


class Evaluated(NamedTuple):
    """Files of a batch of two views of each set."""

    mesh_ply: Path
    references: Path
    lpips_json: Path
    weights: Path  # of the experiment `net`


def make_evaluated(folder: Path, shape=None, first: int = 0, frames=FRAMES, **given) -> Evaluated:
    """Write them; `given` are others of `render_references`."""
    names = ("mesh.ply", "000.safetensors", "lpips.json", "net/weights.safetensors")
    files = Evaluated(*(folder / name for name in names))
    (shape or bumpy_sphere(4)).export(files.mesh_ply)
    given |= {"scene": SCENE, "frames": frames, "first": first, "last": first + 2}
    render_references(*files[:2], **given)
    write_json(files.lpips_json, {"available": False})
    network = FrequencyNetwork(**TINY)
    network.initialise(1)
    save_network(files.weights, network, {"network": {"encoding": "frequency"} | TINY})
    return files
