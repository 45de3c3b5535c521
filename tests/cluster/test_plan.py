"""The plan that the profile's README shows is what the workflow and the measured run give."""

import subprocess
import sys

from checkout import Checkout


def test_the_readme_shows_the_plan_of_the_thesis_s_sweep(tmp_path):
    checkout = Checkout.fresh(tmp_path)
    done = subprocess.run(
        [sys.executable, "workflow/profiles/slurm/plan.py", "--configfile", "config/thesis.yaml"],
        cwd=checkout.folder,
        env=checkout.environment(),
        capture_output=True,
        text=True,
        timeout=600,
    )
    assert done.returncode == 0, done.stderr
    readme = checkout.folder / "workflow" / "profiles" / "slurm" / "README.md"
    assert done.stdout in readme.read_text()


def test_a_plan_that_cannot_be_made_says_why(tmp_path):
    checkout = Checkout.fresh(tmp_path)
    overlay = tmp_path / "wrong.yaml"
    overlay.write_text("sede: 7\n")
    for arguments, reason in (
        (["--configfile", str(overlay)], "sede"),
        (["--configfile", "missing.yaml"], "missing.yaml"),
        (["--measured", "results/benchmarks"], "name a run's results/benchmarks"),
    ):
        done = subprocess.run(
            [sys.executable, "workflow/profiles/slurm/plan.py", *arguments],
            cwd=checkout.folder,
            env=checkout.environment(),
            capture_output=True,
            text=True,
            timeout=600,
        )
        assert done.returncode == 1
        assert reason in done.stderr and len(done.stderr.splitlines()) == 1, done.stderr
