"""What a user gets wrong ends before any job starts, or in one line that says what to do."""

import numpy as np
import pytest
import trimesh
from checkout import Checkout, write_overlay


def failed(checkout: Checkout, *arguments: str, overlays=()) -> str:
    """Run Snakemake, which must refuse before any job, and give what it says."""
    done = checkout.snakemake(*arguments, overlays=overlays)
    assert done.returncode != 0, done.stdout
    assert "Execute" not in done.stdout
    assert "Traceback" not in done.stdout
    return done.stdout


@pytest.mark.parametrize(
    ("setting", "line"),
    [
        ("sede=3", "config: sede: unknown key; allowed: scale, seed, "),
        ("seed=many", "config: seed = 'many': Input should be a valid integer"),
    ],
)
def test_mistake_on_the_command_line(fresh, setting, line):
    said = failed(fresh, "--config", setting)
    assert sum(row.startswith(line) for row in said.splitlines()) == 1, said
    assert not fresh.results.exists()


@pytest.mark.parametrize(
    ("sections", "line"),
    [
        (
            {"samplings": {"poisson_quadtree": {"direction": 5}}},
            "config: samplings.poisson_quadtree.direction: unknown key; "
            "allowed: sampler, domain, directions, ",
        ),
        (
            {"trainings": {"base": {"steps": "100"}}},
            "config: trainings.base.steps = '100': Input should be a valid integer",
        ),
        (
            {"rendering": {"width": 8}},
            "config: rendering.width = 8: Input should be greater than or equal to 64",
        ),
        (
            {"experiments": {"dragon": {"scene": "dragno"}}},
            "config: experiments.dragon.scene: no such name in `scenes`: 'dragno'; allowed: dragon",
        ),
    ],
    ids=["key", "type", "range", "scene"],
)
def test_mistake_in_an_overlay(fresh, tmp_path, sections, line):
    said = failed(fresh, overlays=[write_overlay(tmp_path / "wrong.yaml", **sections)])
    assert sum(row.startswith(line) for row in said.splitlines()) == 1, said
    assert not fresh.results.exists()


def test_name_given_twice(fresh, tmp_path):
    overlay = tmp_path / "twice.yaml"
    overlay.write_text("networks:\n  small: {frequencies: 1}\n  small: {frequencies: 2}\n")
    said = failed(fresh, overlays=[overlay])
    assert "twice.yaml, line 3: 'small' is there twice; give each name once" in said


@pytest.mark.parametrize("state", ["fresh", "smoke"])
def test_missing_mesh_file(request, state):
    # In a finished checkout, too: an older mesh must not stand in for the missing one.
    said = failed(request.getfixturevalue(state), "--config", "dragon=nowhere/bunny.ply")
    assert "config: scenes.dragon.mesh.path = 'nowhere/bunny.ply': no such file" in said


def test_broken_meshes(fresh, tmp_path):
    checkout = fresh.copy(tmp_path / "checkout")
    sphere = trimesh.creation.icosphere(subdivisions=1)
    ply = sphere.export(file_type="ply")
    (tmp_path / "empty.ply").touch()
    (tmp_path / "cut.ply").write_bytes(ply[: len(ply) // 2])
    holed = trimesh.Trimesh(sphere.vertices.copy(), sphere.faces, process=False)
    holed.vertices[5, 1] = np.nan
    (tmp_path / "nan.ply").write_bytes(holed.export(file_type="ply"))
    (tmp_path / "flat.obj").write_text("v 0 0 0\nv 1 0 0\nv 2 0 0\nf 1 2 3\n")
    problems = {
        "empty.ply": "is empty",
        "cut.ply": "cannot be read as PLY",
        "nan.ply": "vertex 5 (counted from 0) is (",
        "flat.obj": "have zero area",
    }
    scenes = {name.split(".")[0]: {"mesh": {"path": str(tmp_path / name)}} for name in problems}
    overlay = write_overlay(tmp_path / "broken.yaml", scenes=scenes)
    targets = [f"results/smoke/scenes/{scene}/mesh.ply" for scene in scenes]
    done = checkout.snakemake(*targets, "--keep-going", overlays=[overlay])
    assert done.returncode != 0
    for name, reason in problems.items():
        scene = name.split(".")[0]
        lines = [
            row
            for row in done.stdout.splitlines()
            if row.startswith("prepare_mesh: mesh ") and name in row
        ]
        assert len(lines) == 1, (name, done.stdout)
        assert reason in lines[0]
        assert lines[0] in (checkout.results / f"logs/prepare_mesh/{scene}.log").read_text()
        folder = checkout.results / "scenes" / scene
        assert not folder.exists() or list(folder.iterdir()) == []
