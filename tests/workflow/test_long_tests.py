"""Tests that run only when they are named still reach every rule; nothing is run for it."""

from few_jobs import few_jobs, files_of_rules, rules_of


def test_faults_kill_a_job_of_every_rule(fresh, tmp_path):
    """A rule that none of their targets needs would never be killed."""
    overlays = [few_jobs(tmp_path / "few.yaml")]
    assert files_of_rules(fresh, overlays).keys() == rules_of(fresh)
