"""A small viewer of untrained networks, and the scene that it shows as the CPU sees it."""

import base64
import zlib
from pathlib import Path
from typing import NamedTuple

import numpy as np
import trimesh
from built_networks import make_network
from opened import write_constants
from shapes import SPHERE_OF_LIGHTS, bumpy_sphere, prepared

from neural_shadows.files.whole_files import write_json
from neural_shadows.networks.object_space.shadow_network import ShadowNetwork
from neural_shadows.networks.weight_file import load_network, save_network
from neural_shadows.scenes.scene import Scene, make_scene
from neural_shadows.viewer.mesh_arrays import BITS, MeshArrays, mesh_arrays
from neural_shadows.viewer.write_viewer import write_viewer

TEMPLATE = Path(__file__).parents[1] / "workflow/report/viewer"
FIELD = {"encoding": "occupancy_field", "resolution": 64, "stored": "int8"}
NETWORKS = {
    "field": FIELD | {"surface": "solid", "start": "distances"},
    "thesis": {"encoding": "frequency", "frequencies": 10, "width": 64, "hidden_layers": 8},
}
REPORT = {"name": "bumps", "faces": 1, "thesis_mesh": False, "watertight": True}


class ViewerPage(NamedTuple):
    """A page, and what it should show."""

    html: Path
    png: Path
    scene: Scene  # of the mesh in the steps that the page holds
    networks: dict[str, ShadowNetwork]
    biases: dict[str, float]


def restored_mesh(arrays: MeshArrays) -> tuple[np.ndarray, np.ndarray]:
    """The vertices (V, 3) float32 and triangles (F, 3) int32 that mesh.js makes of them."""
    zigzag = arrays.steps.astype(np.int64)
    places = np.where(zigzag & 1, -(zigzag + 1) // 2, zigzag // 2).cumsum(1).T
    codes = arrays.codes.astype(np.int64)
    before = np.concatenate([[0], np.cumsum(codes == 0)[:-1]])
    faces = (before - codes).reshape(-1, 3).astype(np.int32)
    return (places / (2**BITS - 1) * 2 - 1).astype(np.float32), faces


def make_viewer(folder: Path, settings=NETWORKS, shape=None, light=SPHERE_OF_LIGHTS) -> ViewerPage:
    """Write it; of a solid, and networks as they are before a training."""
    shape = shape or bumpy_sphere(5)
    shape.export(folder / "mesh.ply")
    write_json(folder / "mesh.json", REPORT)
    networks, rows, biases = {}, [], {"field": 0.004, "thesis": -0.3}
    for name, setting in settings.items():
        network = make_network(setting)
        if setting["encoding"] != "frequency":
            network.prepare(folder / "mesh.ply")
        network.initialise(5)
        header = {"name": name, "network": setting, "training": None}
        weights = folder / name / "weights.safetensors"
        save_network(weights, network, header)
        write_constants(folder / f"{name}.json", depth_bias=biases[name], push=0.05)
        networks[name], _ = load_network(weights)
        networks[name].push = 0.05
        rows.append({"method": name, "experiment": name, "label": name, "bias": "held_out"})
    scene = {"up": "y", "ground": True, "light": light}
    write_viewer(
        html=folder / "viewer.html",
        png=folder / "viewer.png",
        template=[path for path in TEMPLATE.rglob("*") if path.is_file()],
        mesh_ply=folder / "mesh.ply",
        mesh_json=folder / "mesh.json",
        weights=[folder / name / "weights.safetensors" for name in settings],
        depth_biases=[folder / f"{name}.json" for name in settings],
        name="bumps",
        rows=rows,
        scene=scene,
        frames={"width": 300, "height": 200, "view_sets": ["shadow", "surface"], "seed": 3},
        views=1,
        about={"mesh_name": "bumps", "procedural": False, "seed": 3, "least_shadow": 0.0},
        run={"scale": "test", "seed": 3, "width": 300, "height": 200, "reference": "exact"},
    )
    restored = trimesh.Trimesh(
        *restored_mesh(mesh_arrays(shape.vertices, shape.faces)), process=False
    )
    quantised = make_scene(prepared(restored)[0], up=[0, 1, 0], ground=True, light=light)
    html, png = folder / "viewer.html", folder / "viewer.png"
    return ViewerPage(html, png, quantised, networks, biases)


def unpacked(array: dict[str, str]) -> np.ndarray:
    """An array of a page's data, as the browser reads it."""
    kind = np.dtype(array["kind"])
    planes = np.frombuffer(zlib.decompress(base64.b64decode(array["data"])), np.uint8)
    return np.ascontiguousarray(planes.reshape(kind.itemsize, -1).T).view(kind).ravel()
