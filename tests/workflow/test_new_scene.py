"""A scene of one's own is an edit of the configuration and nothing else."""

import pandas as pd
import trimesh
from checkout import write_overlay

FEW = {"directions": 20, "points_per_direction": 100, "silhouette_resolution": 32, "shards": 1}
SHORT = {"steps": 20, "batch_size": 256, "learning_rate": 0.001}


def test_scene_of_an_overlay(finished, tmp_path):
    """A torus in millimetres, off its origin."""
    torus = trimesh.creation.torus(major_radius=300, minor_radius=90)
    torus.apply_translation([1e4, -2e4, 500]).export(tmp_path / "ring_mm.stl")
    network = {"scene": "torus", "sampling": "few", "network": "thesis", "training": SHORT}
    overlay = write_overlay(
        tmp_path / "torus.yaml",
        scenes={"torus": {"mesh": {"path": str(tmp_path / "ring_mm.stl")}, "up": "z"}},
        samplings={"few": FEW | {"sampler": "poisson_quadtree"}},
        experiments={"torus": network | {"label": "{steps} steps"}},
        tables={"table_torus": {"title": "A torus", "rows": ["shadow_map_512", "torus"]}},
    )
    # Only its own jobs run, the page that shows everything, and the manifest of all.
    others = [path for path in finished.pending(overlays=[overlay]) if "torus" not in path]
    of_all = ("index.html", "manifest.json", "ro-crate-metadata.json")
    assert sorted(others) == [f"reports/smoke/{name}" for name in of_all]
    said = finished.run("reports/smoke/table_torus.csv", overlays=[overlay])
    assert "| 512² shadow map" in said and "Open reports/smoke/table_torus.md" in said
    reports = finished.reports
    table = pd.read_csv(reports / "table_torus.csv")
    methods = ["20 steps", "512² shadow map", "All dark", "No shadow"]
    assert sorted(table["method"]) == methods
    assert (reports / "scenes" / "torus.png").is_file()
    # The mesh was given by an absolute path.
    text = (reports / "table_torus.md").read_text(encoding="utf-8")
    assert "ring_mm" in text and "wyrm" not in text and str(tmp_path) not in text
    # Another seed draws its rays anew, and nothing else's.
    seed = write_overlay(tmp_path / "seed.yaml", scenes={"torus": {"seed": 7}})
    pending = finished.pending(overlays=[overlay, seed])
    assert "train" in pending.values()
    assert not any(name in path for path in pending for name in ("dragon", "fence", "table_4"))
