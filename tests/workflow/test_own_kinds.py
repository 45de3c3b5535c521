"""A kind of one's own is one file: the documentation's recipes, copied and run."""

import re
import subprocess
import sys

import pandas as pd
import yaml
from checkout import ROOT, write_overlay
from shipped import shipped

CLAIMS = "reports/smoke/claims.csv"
TARGETS = [
    "reports/smoke/sizes.csv",
    "reports/smoke/figure_sizes.png",
    "reports/smoke/dim.csv",
    CLAIMS,
]


def recipes() -> dict[str, str]:
    """The files of config/README.md whose first line is a comment with their path."""
    text = (ROOT / "config/README.md").read_text(encoding="utf-8")
    blocks = re.findall(r"```(?:python|yaml)\n# (\S+)\n(.*?)```", text, re.S)
    return dict(blocks)


def test_kinds_of_the_documentation(finished, tmp_path):
    files = recipes()
    kinds = [path for path in files if path.endswith(".py")]
    # One of each that is one file.
    folders = [path.removeprefix("workflow/neural_shadows/").rpartition("/")[0] for path in kinds]
    assert sorted(folders) == [
        "evaluation/soft_methods",
        "reports/claims/kinds",
        "reports/figures",
        "reports/tables",
    ]
    for path in kinds:
        assert not (finished.folder / path).exists()
        (finished.folder / path).write_text(files[path], encoding="utf-8")
    overlay = tmp_path / "own.yaml"
    overlay.write_text(files["config/own.yaml"], encoding="utf-8")
    # Its own claim alone.
    others = write_overlay(
        tmp_path / "others.yaml", claims=dict.fromkeys(shipped("smoke")["claims"])
    )
    finished.run(*TARGETS, overlays=[others, overlay])
    sizes = pd.read_csv(finished.folder / TARGETS[0])
    assert list(sizes) == ["mesh", "faces"] and len(sizes) == 2 and (sizes["faces"] > 0).all()
    assert (finished.folder / TARGETS[1]).stat().st_size > 5000
    dim = pd.read_csv(finished.folder / TARGETS[2])
    assert {"hard", "dimmed", "no_shadow"} <= {*dim["method"]}
    claims = pd.read_csv(finished.folder / CLAIMS).set_index("claim")
    assert claims["verdict"].to_dict() == {"small": "supported"}


def test_other_recipes_are_planned(fresh, tmp_path):
    """Those of the configuration alone: their meshes are stood in for."""
    mesh = tmp_path / "mesh.ply"
    mesh.write_bytes(b"ply\n")
    for path, text in recipes().items():
        if path.endswith(".yaml") and path not in ("config/own.yaml", "config/quay.yaml"):
            sections = yaml.safe_load(text)
            for scene in sections.get("scenes", {}).values():
                scene["mesh"] = {"path": str(mesh)}
            (name, *_) = sections["tables"]
            overlay = write_overlay(tmp_path / "own.yaml", **sections)
            folder = f"reports/{sections['scale']}" if "scale" in sections else "reports"
            command = [sys.executable, "-m", "snakemake", "--dry-run", f"{folder}/{name}.csv"]
            environment = fresh.environment()
            done = subprocess.run(
                [*command, "--configfile", str(overlay)],
                cwd=fresh.folder,
                env=environment,
                capture_output=True,
                text=True,
            )
            assert f"Writing {name}" in done.stdout + done.stderr, done.stderr
