"""Odd shapes that are read go through what follows: rays, labels, viewpoints."""

import json

import numpy as np
import pytest
from broken_meshes import WORKS, shapes
from mesh_formats import binary_ply

from neural_shadows.errors import InputError
from neural_shadows.meshes.prepare_mesh import prepare_mesh
from neural_shadows.meshes.prepared_mesh import read_prepared
from neural_shadows.rays.describe_rays import describe_rays
from neural_shadows.rays.draw_directions import make_directions
from neural_shadows.rays.label_rays import make_labels
from neural_shadows.rays.sample_rays import make_rays
from neural_shadows.rendering.viewpoints import draw_viewpoints
from neural_shadows.scenes.lights import axis_vector
from neural_shadows.scenes.tracing import Tracer

SETTINGS = {"silhouette_resolution": 32, "min_quad": 1, "seed": 3}
READ = [shape for shape in shapes() if shape.end == WORKS]


@pytest.mark.parametrize("shape", READ, ids=lambda shape: f"{shape.kind}: {shape.name}")
def test_rays_and_labels(tmp_path, shape):
    files = [tmp_path / name for name in ("m.ply", "m.json", "d.npy", "o.npy", "b.npy")]
    mesh_ply, mesh_json, directions, origins, bounds = files
    (tmp_path / "source.ply").write_bytes(binary_ply(shape.vertices, shape.faces))
    prepare_mesh(tmp_path / "source.ply", mesh_ply, mesh_json, name="shape")
    sampler = "poisson_quadtree"
    make_directions(directions, sampler=sampler, directions=20, seed=3)
    part = {"first": 0, "last": 20, "threads": 1}
    make_rays(
        mesh_ply, directions, origins, sampler=sampler, points_per_direction=100, **SETTINGS, **part
    )
    make_labels(mesh_ply, directions, origins, bounds, seed=SETTINGS["seed"], **part)
    described = describe_rays(
        tmp_path / "rays.json",
        mesh_ply=mesh_ply,
        directions_npy=directions,
        origins_npys=[origins],
        bounds_npys=[bounds],
        sampler=sampler,
        **SETTINGS,
    )
    assert json.loads((tmp_path / "rays.json").read_text()) == described
    # A needle of 1e-11 of its length lies between all rays; whatever else is read is hit.
    assert (described["misses"] < 1) == (shape.name != "needles")

    mesh = read_prepared(mesh_ply)
    tracer = Tracer(mesh.vertices, mesh.faces)
    for view_set in ("shadow", "surface", "centre"):
        try:
            views = draw_viewpoints(
                mesh,
                tracer,
                up=axis_vector("y", "up"),
                ground=True,
                light_domain={"domain": "sphere", "min_elevation_deg": 20},
                view_sets=[view_set],
                indices=range(2),
                width=60,
                height=40,
                seed=1,
            )
        except InputError as error:
            assert view_set == "surface" and "no point of the object is both lit and seen" in str(
                error
            )
            continue
        for view in views:
            assert np.isfinite([view.eye, view.target, view.light]).all()
