"""A new scene is an edit of the config and nothing else."""

import gzip

import pandas as pd
import trimesh
from checkout import write_overlay

# One job a stage, and none with much to do.
TINY = {
    "scale": "tiny",
    "samplings": {
        "poisson_quadtree": {
            "directions": 10,
            "points_per_direction": 100,
            "silhouette_resolution": 16,
            "shards": 1,
        }
    },
    "networks": {"field_256": {"resolution": 16}},
    "trainings": {
        "base": {"steps": 20, "batch_size": 256},
        "field": {"steps": 20, "batch_size": 256},
    },
    "rendering": {
        "width": 64,
        "height": 64,
        "views_per_set": 1,
        "batch": 1,
        "held_out_views": 1,
    },
}


def test_scene_of_an_overlay(second_scene):
    # In a finished checkout only the scene's own jobs run, and the page that shows everything.
    others = [path for path in second_scene.planned if "torus" not in path]
    assert others == ["reports/smoke/index.html"]
    assert "train" in second_scene.planned.values()
    reports = second_scene.checkout.reports
    table = pd.read_csv(reports / "table_torus.csv")
    assert list(table.columns[:4]) == ["method", "lpips", "psnr", "ssim"]
    assert list(table["method"]) == ["512² map", "128² map", "Our method"]
    assert set(table["mesh"]) == {"ring_mm"}
    assert "Mesh: ring_mm, 2,048 triangles, watertight" in (reports / "table_torus.md").read_text(
        encoding="utf-8"
    )
    assert (reports / "scenes" / "torus.png").is_file()
    # The mesh was given by an absolute path.
    folder = str(second_scene.overlay.parent).encode()
    files = [path for path in reports.rglob("*") if path.is_file()]
    assert [path for path in files if folder in path.read_bytes()] == []
    assert second_scene.checkout.pending(overlays=[second_scene.overlay]) == {}


def test_mesh_file_of_the_command_line(finished, tmp_path):
    mesh = tmp_path / "elsewhere" / "boulder.ply.gz"
    mesh.parent.mkdir()
    boulder = trimesh.creation.icosphere(subdivisions=2, radius=40)
    mesh.write_bytes(gzip.compress(boulder.export(file_type="ply")))
    finished.run(
        "reports/tiny/table_4_3.csv",
        "--config",
        f"dragon={mesh}",
        overlays=[write_overlay(tmp_path / "tiny.yaml", **TINY)],
    )
    reports = finished.folder / "reports" / "tiny"
    assert set(pd.read_csv(reports / "table_4_3.csv")["mesh"]) == {"boulder"}
    text = (reports / "table_4_3.md").read_text(encoding="utf-8")
    assert "Mesh: boulder, 320 triangles, watertight" in text
    assert "wyrm" not in text
