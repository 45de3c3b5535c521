"""A job that fails says how its log ends and how to run it alone, and that command does."""

import hashlib
import json
import os
import subprocess
import sys
from pathlib import Path

import trimesh
from checkout import write_overlay

TARGET = "results/smoke/scenes/ball/mesh.ply"


KILLED = """

def generate_mesh(*args, **settings):
    import os, signal
    print("half way", flush=True)
    os.kill(os.getpid(), signal.SIGKILL)
"""


def test_a_killed_job_is_told_of_by_the_run(fresh, tmp_path):
    """As by the system when memory ends: it cannot say so itself."""
    checkout = fresh.copy(tmp_path / "checkout")
    target = "results/smoke/scenes/fence/generated.ply"
    with checkout.module("generated_mesh.py").open("a") as file:
        file.write(KILLED)
    failed = checkout.snakemake(target)
    assert failed.returncode != 0
    log = "results/smoke/logs/generate_mesh/fence.log"
    said = failed.stdout[failed.stdout.index("generate_mesh: ended without a word: killed") :]
    assert said.splitlines()[0].endswith(f"[log: {log}]")
    assert said.splitlines()[1:3] == [
        "  | half way",
        f"  run it alone: snakemake --cores 1 {target} --configfile config/smoke.yaml",
    ]


def test_a_failed_job_is_run_alone_by_its_command(fresh, tmp_path):
    checkout = fresh.copy(tmp_path / "a checkout")
    ply = trimesh.creation.icosphere(subdivisions=1).export(file_type="ply")
    mesh = tmp_path / "ball.ply"
    mesh.write_bytes(ply[: len(ply) // 2])
    overlay = write_overlay(
        checkout.folder / "a ball.yaml", scenes={"ball": {"mesh": {"path": str(mesh)}}}
    )
    log = checkout.results / "logs/prepare_mesh/ball.log"

    def record() -> dict:
        (line,) = (row for row in log.read_text().splitlines() if row.startswith("{"))
        return json.loads(line)

    failed = checkout.snakemake(TARGET, "--config", "seed=7", overlays=[overlay])
    assert failed.returncode != 0
    rows = failed.stdout.splitlines()
    (reason,) = (row for row in rows if row.startswith("prepare_mesh: "))
    outcome = reason[len("prepare_mesh: ") : reason.index(" [log: ")]
    assert f"{mesh}: cannot be read as PLY" in outcome
    assert record()["outcome"] == outcome
    (alone,) = (row for row in rows if "run it alone: " in row)
    command = alone.split("run it alone: ")[1]
    assert command == (
        f"snakemake --cores 1 {TARGET} --configfile config/smoke.yaml 'a ball.yaml' --config seed=7"
    )

    mesh.write_bytes(ply)
    path = os.pathsep.join([str(Path(sys.executable).parent), os.environ["PATH"]])
    done = subprocess.run(
        command,
        shell=True,
        cwd=checkout.folder,
        env=checkout.environment() | {"PATH": path},
        stdout=subprocess.PIPE,
        stderr=subprocess.STDOUT,
        text=True,
        timeout=300,
    )
    assert done.returncode == 0, done.stdout
    assert "1 of 1 steps (100%) done" in done.stdout
    found = record()
    assert (found["rule"], found["outcome"]) == ("prepare_mesh", "done")
    assert found["wildcards"] == {"scene": "ball"} and found["params"] == {"name": "ball"}
    (source,) = found["inputs"]["source"]
    assert source == {
        "path": str(mesh),
        "bytes": len(ply),
        "sha256": hashlib.sha256(ply).hexdigest(),
    }
    code = [file["path"] for file in found["inputs"]["code"]]
    assert "workflow/neural_shadows/mesh.py" in code
    assert found["outputs"]["mesh"] == [TARGET]
    assert found["seconds"] > 0 and found["versions"]["trimesh"] == trimesh.__version__
