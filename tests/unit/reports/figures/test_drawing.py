import matplotlib.image
import numpy as np
import pytest
import trimesh
from matplotlib.colors import to_rgb
from sample_records import MESH
from scipy.ndimage import binary_opening
from shapes import box, bumpy_sphere

from neural_shadows.errors import InputError
from neural_shadows.files.whole_files import write_json
from neural_shadows.layout.layout import METHOD_FIGURES
from neural_shadows.reports.figures import drawing as method_figures
from neural_shadows.reports.figures.method import draw_method_figure

SAMPLING = {"sampler": "poisson_quadtree", "silhouette_resolution": 32, "min_quad": 1}


@pytest.fixture(scope="module")
def meshes(tmp_path_factory):
    folder = tmp_path_factory.mktemp("meshes")
    bumpy_sphere(3).export(folder / "closed.ply")
    sheet = trimesh.creation.box((1, 0.01, 1))
    trimesh.Trimesh(sheet.vertices, sheet.faces[:2], process=False).export(folder / "open.ply")
    corner = box(0.4, 0.2, 0.1).apply_translation((0.4, 0.3, 0))
    corner.export(folder / "corner_y.ply")
    # The same, seen from the front, with z up: (x, y, z) as (x, −z, y).
    corner.apply_transform(trimesh.transformations.rotation_matrix(np.pi / 2, (1, 0, 0)))
    corner.export(folder / "corner_z.ply")
    for name in ("closed", "open", "corner_y", "corner_z"):
        write_json(folder / f"{name}.json", MESH | {"name": name})
    return folder


def draw(meshes, name, kind, folder, up="y"):
    draw_method_figure(
        kind,
        meshes / f"{name}.ply",
        meshes / f"{name}.json",
        folder / "f.png",
        folder / "f.svg",
        title="How it works",
        up=up,
        sampling=SAMPLING,
        seed=1,
    )
    return matplotlib.image.imread(folder / "f.png"), (folder / "f.svg").read_bytes()


@pytest.mark.parametrize("kind", METHOD_FIGURES)
def test_each_kind_is_drawn_and_twice_alike(meshes, tmp_path, kind):
    picture, svg = draw(meshes, "closed", kind, tmp_path)
    assert 1300 <= picture.shape[1] <= 2000
    assert picture[..., :3].std() > 0.02
    assert len(svg) < 600_000
    if kind != "view_directions":  # seconds each, and the same code writes it
        assert draw(meshes, "closed", kind, tmp_path)[1] == svg


@pytest.mark.parametrize("kind", ["overview", "dual_bounds", "dead_zone_loss", "shadow_boundary"])
def test_a_sheet_without_second_hits_is_drawn_too(meshes, tmp_path, kind):
    picture, _ = draw(meshes, "open", kind, tmp_path)
    assert picture[..., :3].std() > 0.02


@pytest.mark.parametrize("up", ["y", "z"])
def test_the_silhouette_stands_upright_where_the_object_is(meshes, tmp_path, up):
    picture, _ = draw(meshes, f"corner_{up}", "quadtree", tmp_path, up)
    left = picture[:, : picture.shape[1] // 2, :3]

    def extent(colour, smallest):
        of_colour = np.abs(left - colour).max(axis=2) < 0.02
        rows, columns = np.nonzero(binary_opening(of_colour, np.ones((smallest, smallest))))
        return np.array([columns.min(), columns.max(), rows.max(), rows.min()])

    # Letters have grey rims, but no grey area.
    circle, grey = extent(to_rgb(method_figures.ORANGE), 1), extent(184 / 255, 5)
    centre = np.repeat([circle[:2].mean(), circle[2:].mean()], 2)
    radius = (circle[1] - circle[0]) / 2
    x_min, x_max, y_min, y_max = (grey - centre) / radius * (1, 1, -1, -1)
    # Half a texel of 2/32 at most, as a texel counts by its centre, and a line's width.
    assert (x_min, x_max, y_min, y_max) == pytest.approx((0.2, 0.6, 0.2, 0.4), abs=0.04)


def test_an_outline_of_many_segments_becomes_a_picture(meshes, tmp_path, monkeypatch):
    assert b"<image" not in draw(meshes, "closed", "dual_bounds", tmp_path)[1]
    monkeypatch.setattr(method_figures, "DRAWN_SEGMENTS", 10)
    assert b"<image" in draw(meshes, "closed", "dual_bounds", tmp_path)[1]


def test_an_unknown_kind_is_refused(meshes, tmp_path):
    with pytest.raises(InputError, match="'spectrum' is unknown"):
        draw(meshes, "closed", "spectrum", tmp_path)
    assert not list(tmp_path.iterdir())
