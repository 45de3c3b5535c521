"""Pictures of the method and of scenes."""

from importlib import import_module

import numpy as np
import pytest
import trimesh
from matplotlib.colors import to_rgb
from matplotlib.image import imread
from report_samples import written_figure
from scipy.ndimage import binary_opening
from scipy.special import sph_harm_y
from shapes import SPHERE_OF_LIGHTS, box, scene_of, sheet

from neural_shadows.evaluation.look import ORANGE
from neural_shadows.files.whole_files import write_json
from neural_shadows.rays.poisson_disk import sphere_directions
from neural_shadows.reports.drawing.mesh_slice import slice_mesh, slice_rays
from neural_shadows.reports.drawing.preview import draw as draw_preview
from neural_shadows.reports.figures import view_directions

SAMPLING = {"silhouette_resolution": 32, "min_quad": 1}
SLICES = ("shadow_boundary", "dual_bounds", "dead_zone_loss")
RADIUS = 0.5


def draw(shape, kind, folder, up="y"):
    files = {"mesh_ply": folder / "mesh.ply", "mesh_json": folder / "mesh.json"}
    shape.export(files["mesh_ply"])
    write_json(files["mesh_json"], {"name": "a mesh"})
    settings = {"sampling": SAMPLING, "scene_seed": 1}
    settings["scene"] = {"up": up, "ground": True, "light": SPHERE_OF_LIGHTS}
    module = import_module(f"neural_shadows.reports.figures.{kind}")
    svg = written_figure(module.draw, folder, **files, **settings)
    assert len(svg) < 600_000
    return imread(folder / "figure.png")[..., :3]


@pytest.mark.parametrize("kind", [*SLICES, "overview"])
def test_each_kind_is_drawn_of_a_sheet_without_second_hits(tmp_path, kind):
    picture = draw(sheet(0.0, 0.5), kind, tmp_path)
    assert 1300 <= picture.shape[1] <= 2000 and picture.std() > 0.02


def test_the_silhouette_stands_upright_where_the_object_is(tmp_path):
    corner = box(0.4, 0.1, 0.2).apply_translation((0.4, 0, 0.3))
    picture = draw(corner, "quadtree", tmp_path, up="z")
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


def test_bounds_of_a_sphere_are_its_chords():
    ball = slice_mesh(scene_of(trimesh.creation.icosphere(5, RADIUS)))
    np.testing.assert_allclose(np.linalg.norm(ball.outline, axis=2), RADIUS, atol=3e-3)
    rays = slice_rays(ball, 101)
    inside = np.abs(rays.offset) < 0.98 * RADIUS
    half = np.sqrt(RADIUS**2 - rays.offset[inside] ** 2)
    middle = np.sqrt(1 - rays.offset[inside] ** 2)
    np.testing.assert_allclose(rays.t_lb[inside], middle - half, atol=5e-3)
    np.testing.assert_allclose(rays.t_ub[inside], middle + half, atol=5e-3)
    beside = np.abs(rays.offset) > RADIUS
    assert not rays.hit[beside].any() and rays.hit[inside].all()


def test_the_preview_names_the_up_axis_and_a_sheet(tmp_path, capsys):
    box(1, 0.4, 0.6).export(tmp_path / "mesh.ply")
    files = [tmp_path / name for name in ("mesh.ply", "mesh.json", "a.png", "a.svg")]
    write_json(files[1], {"name": "a mesh", "faces": 12, "watertight": False, "sheet": True})
    scene = {"up": "z", "ground": True, "light": SPHERE_OF_LIGHTS}
    draw_preview(*files, scene=scene, advice="Next: a table.")
    notes = capsys.readouterr().out
    assert "Up is z:" in notes and "so are its occupancy fields" in notes
    assert "Next: a table." in notes
    assert imread(files[2])[..., :3].std() > 0.05


def test_the_spectrum_is_the_sum_over_spherical_harmonics():
    x = np.random.default_rng(1).normal(size=(40, 3))
    x /= np.linalg.norm(x, axis=1, keepdims=True)
    theta, phi = np.arccos(x[:, 2]), np.arctan2(x[:, 1], x[:, 0])
    for degree, power in enumerate(view_directions.angular_power_spectrum(x, 6), start=1):
        sums = [sph_harm_y(degree, m, theta, phi).sum() for m in range(-degree, degree + 1)]
        expected = 4 * np.pi / (40 * (2 * degree + 1)) * np.sum(np.abs(sums) ** 2)
        assert power == pytest.approx(expected, rel=1e-9)


def test_poisson_disks_are_blue():
    power = view_directions.angular_power_spectrum(sphere_directions(500, 1)[0], 50)
    assert power[:20].max() < 0.25
    assert power[-10:].mean() > 1
