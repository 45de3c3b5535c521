"""Fields of open, thin meshes: surface and fitness."""

import json

import numpy as np
import pytest
from built_networks import make_network
from shapes import SPHERE_OF_LIGHTS, hills

from neural_shadows.evaluation.ray_network import network_method
from neural_shadows.meshes.prepare_mesh import prepare_mesh
from neural_shadows.metrics.kinds.errors_of_visibility import shadow_error
from neural_shadows.networks.mesh_surface import is_unfit, with_surface
from neural_shadows.networks.settings.networks import ray_network
from neural_shadows.networks.weight_file import load_network
from neural_shadows.rays.labels import dual_bounds
from neural_shadows.rendering.exact_shadow import exact_visibility
from neural_shadows.rendering.gbuffer import render_gbuffer
from neural_shadows.rendering.viewpoints import draw_viewpoints
from neural_shadows.running.stage import converted
from neural_shadows.scenes.scene import open_scene
from neural_shadows.training.train_on_rays import train_on_rays

FIELD = {"encoding": "occupancy_field", "resolution": 32, "start": "undecided", "stored": "int8"}
FIELD |= {"corner_bits": 8}
BRIEF = {"optimiser": "adam", "steps": 150, "batch_size": 8192, "learning_rate": 0.5}
BRIEF |= {"schedule": "cosine", "loss": {"false_shadow": 1.0}}
RAYS = 40_000


def write_rays(folder, tracer) -> dict:
    """Labelled rays from all over the unit sphere, as arguments of `train`."""
    rng = np.random.default_rng(1)
    o, d = (rng.normal(size=(RAYS, 3)) for _ in range(2))
    o, d = (each / np.linalg.norm(each, axis=1, keepdims=True) for each in (o, d))
    d[(o * d).sum(1) > 0] *= -1
    o, d = o.astype(np.float32), d.astype(np.float32)
    files = [folder / name for name in ("directions.npy", "origins.000.npy", "bounds.000.npy")]
    bounds = np.stack(dual_bounds(tracer, o, d), 1)
    for path, array in zip(files, (d, o[:, None], bounds[:, None])):
        np.save(path, array)
    (folder / "rays.json").write_text("{}")
    shards = {"origins": files[1:2], "bounds": files[2:]}
    return {"directions_npy": files[0], "rays_json": folder / "rays.json", **shards}


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    folder = tmp_path_factory.mktemp("hills")
    hills().export(folder / "hills.obj")
    files = [folder / name for name in ("hills.obj", "mesh.ply", "mesh.json")]
    prepare_mesh(*files, {"path": "hills.obj"}, "hills")
    assert json.loads(files[2].read_text())["sheet"]
    return folder


@pytest.fixture(scope="module")
def scene(folder):
    return open_scene(folder / "mesh.ply", up="y", ground=False, light=SPHERE_OF_LIGHTS)


def trained(folder, scene, surface):
    """The record of a field that was trained, and the share of points that it shadows wrongly."""
    out = folder / surface
    out.mkdir()
    train_on_rays(
        mesh_ply=folder / "mesh.ply",
        mesh_json=folder / "mesh.json",
        weights=out / "weights.safetensors",
        loss_csv=out / "loss.csv",
        training_json=out / "training.json",
        **converted(train_on_rays, {"network": FIELD | {"surface": surface}, "training": BRIEF}),
        seed=1,
        experiment=surface,
        device="cpu",
        precision="float32",
        **write_rays(folder, scene.tracer),
    )
    network, header = load_network(out / "weights.safetensors")
    answer = network_method(network, None)
    errors = []
    for view in draw_viewpoints(scene, ["surface"], range(6), 1.5, 3):
        frame = render_gbuffer(scene, view, 60, 40)
        truth = exact_visibility(scene.tracer, frame)
        error = shadow_error(answer(frame)(0.02), truth)
        errors.append(error.false_shadow + error.light_leak)
    return json.loads((out / "training.json").read_text()), header["network"], np.mean(errors)


def test_a_field_of_an_open_mesh_is_a_sheet_by_itself_and_far_better_so(folder, scene):
    record, network, error = trained(folder, scene, "auto")
    assert network["surface"] == record["network"]["surface"] == "sheet" and not record["unfit"]
    forced, _, wrong = trained(folder, scene, "solid")
    assert forced["unfit"]
    # 0.9 % of the points against 65.
    assert 10 * error < wrong


def test_an_unresolved_surface_is_refused():
    with pytest.raises(ValueError, match="surface: auto: not resolved"):
        make_network(FIELD | {"surface": "auto"})


@pytest.mark.parametrize(
    ("sheet", "network", "surface", "unfit"),
    [
        (True, {"surface": "auto", "start": "undecided"}, "sheet", False),
        (False, {"surface": "auto", "start": "undecided"}, "solid", False),
        # Distances need an inside.
        (True, {"surface": "auto", "start": "fitted"}, "solid", True),
        (False, {"surface": "auto", "start": "fitted"}, "solid", False),
        (True, {"surface": "solid"}, "solid", True),
        (False, {"surface": "sheet"}, "sheet", False),
        (True, {"surface": "auto"}, "sheet", False),
        (True, {"encoding": "ray_grid"}, None, False),
    ],
)
def test_which_surface_a_network_takes(sheet, network, surface, unfit):
    settings = ray_network({"encoding": "occupancy_field", **network})
    chosen = with_surface(settings, {"sheet": sheet})
    assert (
        getattr(chosen, "surface", None) == surface and is_unfit(chosen, {"sheet": sheet}) == unfit
    )
