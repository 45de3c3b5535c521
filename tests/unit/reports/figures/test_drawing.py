"""The pictures of the method, each drawn by its kind's own `draw`."""

from importlib import import_module

import numpy as np
import pytest
import trimesh
from matplotlib.colors import to_rgb
from matplotlib.image import imread
from scipy.ndimage import binary_opening
from shapes import SPHERE_OF_LIGHTS, box, bumpy_sphere, sheet

from neural_shadows.files.whole_files import write_json
from neural_shadows.reports.figures import drawing
from neural_shadows.reports.figures.style import ORANGE

SAMPLING = {"silhouette_resolution": 32, "min_quad": 1}
SLICES = ("shadow_boundary", "dual_bounds", "dead_zone_loss")


@pytest.fixture(scope="module")
def meshes(tmp_path_factory):
    folder = tmp_path_factory.mktemp("meshes")
    write_json(folder / "mesh.json", {"name": "a mesh"})
    bumpy_sphere(3).export(folder / "closed.ply")
    sheet(0.0, 0.5).export(folder / "open.ply")
    corner = box(0.4, 0.2, 0.1).apply_translation((0.4, 0.3, 0))
    corner.export(folder / "corner_y.ply")
    # The same, seen from the front, with z up: (x, y, z) as (x, −z, y).
    corner.apply_transform(trimesh.transformations.rotation_matrix(np.pi / 2, (1, 0, 0)))
    corner.export(folder / "corner_z.ply")
    return folder


def draw(meshes, name, kind, folder, up="y"):
    settings = {} if kind in SLICES else {"sampling": SAMPLING, "seed": 1}
    settings["scene"] = {"up": up, "ground": True, "light": SPHERE_OF_LIGHTS}
    files = meshes / f"{name}.ply", meshes / "mesh.json", folder / "f.png", folder / "f.svg"
    import_module(f"neural_shadows.reports.figures.{kind}").draw(*files, title="How", **settings)
    return imread(files[2])[..., :3], files[3].read_bytes()


@pytest.mark.parametrize("kind", [*SLICES, "overview", "quadtree"])
def test_each_kind_is_drawn_also_of_a_sheet_without_second_hits(meshes, tmp_path, kind):
    picture, svg = draw(meshes, "closed", kind, tmp_path)
    assert 1300 <= picture.shape[1] <= 2000 and picture.std() > 0.02
    assert len(svg) < 600_000
    if kind != "quadtree":
        assert draw(meshes, "open", kind, tmp_path)[0].std() > 0.02


@pytest.mark.parametrize("up", ["y", "z"])
def test_the_silhouette_stands_upright_where_the_object_is(meshes, tmp_path, up):
    picture, _ = draw(meshes, f"corner_{up}", "quadtree", tmp_path, up)
    left = picture[:, : picture.shape[1] // 2]

    def extent(colour, smallest):
        of_colour = np.abs(left - colour).max(axis=2) < 0.02
        rows, columns = np.nonzero(binary_opening(of_colour, np.ones((smallest, smallest))))
        return np.array([columns.min(), columns.max(), rows.max(), rows.min()])

    # Letters have grey rims, but no grey area.
    circle, grey = extent(to_rgb(ORANGE), 1), extent(184 / 255, 5)
    centre = np.repeat([circle[:2].mean(), circle[2:].mean()], 2)
    radius = (circle[1] - circle[0]) / 2
    x_min, x_max, y_min, y_max = (grey - centre) / radius * (1, 1, -1, -1)
    # Half a texel of 2/32 at most, as a texel counts by its centre, and a line's width.
    assert (x_min, x_max, y_min, y_max) == pytest.approx((0.2, 0.6, 0.2, 0.4), abs=0.04)


def test_an_outline_of_many_segments_becomes_a_picture(meshes, tmp_path, monkeypatch):
    assert b"<image" not in draw(meshes, "closed", "dual_bounds", tmp_path)[1]
    monkeypatch.setattr(drawing, "DRAWN_SEGMENTS", 10)
    assert b"<image" in draw(meshes, "closed", "dual_bounds", tmp_path)[1]
