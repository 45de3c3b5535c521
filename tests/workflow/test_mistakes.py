"""What a user gets wrong ends before any job starts, or in one line that says what to do."""

import trimesh
from checkout import Checkout, write_overlay


def refused(checkout: Checkout, *arguments: str, overlays=()) -> str:
    """Run Snakemake, which must end before any job, and give what it says."""
    done = checkout.snakemake(*arguments, overlays=overlays)
    assert done.returncode != 0, done.stdout
    assert "Execute" not in done.stdout
    return done.stdout


def test_on_the_command_line_and_in_an_overlay(fresh, tmp_path):
    """What makes each message is in tests/unit/config and tests/unit/layout."""
    said = refused(fresh, "--config", "dragon=nowhere/bunny.ply")
    assert sum("'nowhere/bunny.ply': no such file" in row for row in said.splitlines()) == 1, said
    assert "Traceback" not in said
    edit = {"experiments": {"dragon": {"scene": "dragno"}}}
    said = refused(fresh, overlays=[write_overlay(tmp_path / "wrong.yaml", **edit)])
    assert "config: experiments.dragon.scene: 'dragno' (did you mean 'dragon'?)" in said
    assert "wrong.yaml, line 3]" in said
    twice = tmp_path / "twice.yaml"
    twice.write_text("networks:\n  small: {frequencies: 1}\n  small: {frequencies: 2}\n")
    said = refused(fresh, overlays=[twice])
    assert "twice.yaml, line 3: 'small' is defined twice. Define it once" in said


def test_a_target_that_there_is_not(fresh):
    message = "tables: 'table_4_33' (did you mean 'table_4_3'?)"
    said = refused(fresh, "reports/smoke/table_4_33.csv")
    assert f"InputError: {message} is not among " in said


def test_the_name_of_an_entry_and_of_a_rule(fresh):
    """The viewer's is both: no target, and what may be made again."""
    message = "viewer: is an entry of `viewers`, not a file. Use reports/smoke/viewer.html"
    assert message in refused(fresh, "viewer")
    fresh.run("--dry-run", "reports/smoke/viewer.html", "--forcerun", "viewer")


def test_a_mesh_that_cannot_be_read(fresh, tmp_path):
    checkout = fresh.copy(tmp_path / "a checkout")
    ply = trimesh.creation.icosphere(subdivisions=1).export(file_type="ply")
    mesh = tmp_path / "cut.ply"
    mesh.write_bytes(ply[: len(ply) // 2])
    overlay = write_overlay(tmp_path / "cut.yaml", scenes={"cut": {"mesh": {"path": str(mesh)}}})
    done = checkout.snakemake("results/smoke/scenes/cut/mesh.ply", overlays=[overlay])
    assert done.returncode != 0
    # By the job, and again at the end of its log, which is shown.
    lines = [row for row in done.stdout.splitlines() if row.startswith("prepare_mesh: ")]
    assert len(set(lines)) == 1 and len(lines) == 2, done.stdout
    assert str(mesh) in lines[0]
    assert lines[0].endswith("[log: results/smoke/logs/prepare_mesh/cut.log]")
