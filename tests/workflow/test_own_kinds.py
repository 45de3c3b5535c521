"""A kind of one's own is one file: the documentation's recipes, copied and run."""

import re
import subprocess
import sys
from collections import Counter
from pathlib import Path

import pandas as pd
import yaml
from checkout import ROOT, write_overlay
from shipped import shipped

# Files of a kind by folder: its own are all that it takes.
FILES = {
    "evaluation/methods": 2,  # one for soft and hard, a filter of rays
    "metrics/kinds": 1,
    "networks/object_space": 1,  # the class of the one in `kinds`
    "networks/object_space/kinds": 1,
    "networks/screen_space/forms": 1,
    "rendering/light_shapes": 1,
    "reports/claims/kinds": 1,
    "reports/figures": 1,
    "reports/tables": 1,
    "scenes/generators": 1,
}
CLAIMS = "reports/smoke/claims.csv"
TARGETS = [
    "reports/smoke/sizes.csv",
    "reports/smoke/figure_sizes.png",
    "reports/smoke/dim.csv",
    "reports/smoke/dim_views.csv",
    CLAIMS,
]
PAGE = "reports/smoke/available.html"


def recipes() -> dict[str, str]:
    """The files of config/README.md whose first line is a comment with their path."""
    text = (ROOT / "config/README.md").read_text(encoding="utf-8")
    blocks = re.findall(r"```(?:python|yaml)\n# (\S+)\n(.*?)```", text, re.S)
    return dict(blocks)


def lines_of(source: str) -> list[str]:
    """Lines of a recipe, without empty ones, imports and docstrings."""
    source = re.sub(r'""".*?"""', "", source, flags=re.S)
    rows = (row.strip() for row in source.splitlines())
    return [row for row in rows if row and not row.startswith(("from ", "import "))]


def test_kinds_of_the_documentation(finished, tmp_path):
    files = recipes()
    kinds = [path for path in files if path.endswith(".py")]
    folders = [path.removeprefix("workflow/neural_shadows/").rpartition("/")[0] for path in kinds]
    assert Counter(folders) == FILES
    for path in kinds:
        assert len(lines_of(files[path])) <= 15, path
        assert not (finished.folder / path).exists()
        (finished.folder / path).write_text(files[path], encoding="utf-8")
    overlay = tmp_path / "own.yaml"
    overlay.write_text(files["config/own.yaml"], encoding="utf-8")
    # Its own claim alone, and networks that are hardly trained.
    others = write_overlay(
        tmp_path / "others.yaml",
        claims=dict.fromkeys(shipped("smoke")["claims"]),
        trainings={"base": {"steps": 20}, "nsm": {"steps": 2}},
    )
    finished.run(*TARGETS, overlays=[others, overlay])
    # A page of what is there makes nothing.
    (finished.reports / "table_4_3.json").unlink()
    finished.run(PAGE, overlays=[others, overlay])
    sizes = pd.read_csv(finished.folder / TARGETS[0])
    assert list(sizes) == ["mesh", "faces", "scale"]
    assert len(sizes) == 2 and (sizes["faces"] > 0).all()
    assert (finished.folder / TARGETS[1]).stat().st_size > 5000
    dim = pd.read_csv(finished.folder / TARGETS[2])
    assert {"hard", "dimmed", "rt_4_box", "doubling", "no_shadow"} <= {*dim["method"]}
    assert dim[dim["method"].eq("rt_4_box")]["bytes"].eq(0).all()
    views = pd.read_csv(finished.folder / TARGETS[3])
    assert {"32 sines", "Dimmed", "No shadow"} <= {*views["method"]}
    assert dim["worst"].between(0, 1).all() and dim["worst"].max() > 0.5
    text = (finished.folder / TARGETS[2]).with_suffix(".md").read_text(encoding="utf-8")
    assert "worst point % ↓" in text and "pillar" in text
    claims = pd.read_csv(finished.folder / CLAIMS).set_index("claim")
    assert claims["verdict"].to_dict() == {"small": "supported"}
    page = (finished.folder / PAGE).read_text(encoding="utf-8")
    assert "No mesh has more than a million triangles" in page and "worst point" in page
    assert 'id="table-table_4_6"' in page and 'id="table-table_4_3"' not in page
    assert not (finished.reports / "table_4_3.json").exists()


def test_other_recipes_are_planned(fresh, tmp_path):
    """Those of the configuration alone, together: their meshes are stood in for."""
    mesh = tmp_path / "mesh.ply"
    mesh.write_bytes(b"ply\n")
    overlays, tables = [], []
    for path, text in recipes().items():
        if path.endswith(".yaml") and path not in ("config/own.yaml", "config/quay.yaml"):
            sections = yaml.safe_load(text)
            for scene in sections.get("scenes", {}).values():
                if "mesh" in scene:
                    scene["mesh"] = {"path": str(mesh)}
            tables += sections.get("tables", {})
            overlays.append(write_overlay(tmp_path / Path(path).name, **sections))
    targets = [f"reports/statue/{name}.csv" for name in tables]
    command = [sys.executable, "-m", "snakemake", "--dry-run", *targets, "--configfile", *overlays]
    done = subprocess.run(
        command,
        cwd=fresh.folder,
        env=fresh.environment(),
        stdout=subprocess.PIPE,
        stderr=subprocess.STDOUT,
        text=True,
    )
    assert len(tables) == 4
    assert [name for name in tables if f"Writing {name}" not in done.stdout] == [], done.stdout
