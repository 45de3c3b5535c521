import matplotlib.image
import pytest
import trimesh
from shapes import bumpy_sphere

from neural_shadows.files import write_json
from neural_shadows.layout import METHOD_FIGURES
from neural_shadows.method_figures import draw_method_figure

SAMPLING = {"sampler": "poisson_quadtree", "silhouette_resolution": 32, "min_quad": 1}


@pytest.fixture(scope="module")
def meshes(tmp_path_factory):
    folder = tmp_path_factory.mktemp("meshes")
    bumpy_sphere(3).export(folder / "closed.ply")
    sheet = trimesh.creation.box((1, 0.01, 1))
    trimesh.Trimesh(sheet.vertices, sheet.faces[:2], process=False).export(folder / "open.ply")
    for name in ("closed", "open"):
        write_json(folder / f"{name}.json", {"name": name})
    return folder


def draw(meshes, name, kind, folder):
    draw_method_figure(
        kind,
        meshes / f"{name}.ply",
        meshes / f"{name}.json",
        folder / "f.png",
        folder / "f.svg",
        title="How it works",
        up="y",
        sampling=SAMPLING,
        seed=1,
    )
    return matplotlib.image.imread(folder / "f.png"), (folder / "f.svg").read_bytes()


@pytest.mark.parametrize("kind", METHOD_FIGURES)
def test_each_kind_is_drawn_and_twice_alike(meshes, tmp_path, kind):
    picture, svg = draw(meshes, "closed", kind, tmp_path)
    assert picture.shape[1] >= 1200
    assert picture[..., :3].std() > 0.02
    assert len(svg) < 2_000_000
    if kind != "view_directions":  # seconds each, and the same code writes it
        assert draw(meshes, "closed", kind, tmp_path)[1] == svg


@pytest.mark.parametrize("kind", ["overview", "dual_bounds", "dead_zone_loss", "shadow_boundary"])
def test_a_sheet_without_second_hits_is_drawn_too(meshes, tmp_path, kind):
    picture, _ = draw(meshes, "open", kind, tmp_path)
    assert picture[..., :3].std() > 0.02
