"""The profile for Slurm names rules and resources that there are."""

import re
from pathlib import Path

import pytest
import yaml

ROOT = Path(__file__).parents[2]


@pytest.fixture(scope="module")
def profile() -> dict:
    return yaml.safe_load((ROOT / "workflow" / "profiles" / "slurm" / "config.yaml").read_text())


@pytest.fixture(scope="module")
def rules() -> dict[str, str]:
    """The text of each rule by its name."""
    text = "\n".join(path.read_text() for path in (ROOT / "workflow" / "rules").glob("*.smk"))
    found = re.split(r"^rule ", text, flags=re.MULTILINE)[1:]
    return {re.match(r"\w+", rule)[0]: rule for rule in found}


def test_rules_exist(profile, rules):
    """Snakemake says nothing of a name that is no rule's."""
    assert profile["groups"].keys() <= rules.keys()
    assert profile["set-resources"].keys() <= rules.keys()
    assert set(profile["groups"].values()) == profile["group-components"].keys()


def test_what_is_not_grouped_is_long_or_local(profile, rules):
    alone = {"describe_rays", "train", "render_references", "evaluate", "find_depth_bias"}
    alone |= {"export_network"}
    timed = {"measure_frame_times", "measure_cost"}
    local = {"find_lpips", "download_mesh"}
    assert rules.keys() - profile["groups"].keys() == alone | timed | local
    assert profile["set-resources"].keys() == timed
    assert {name for name, rule in rules.items() if "localrule: True" in rule} == local


def test_every_rule_says_what_it_needs(rules):
    for name, rule in rules.items():
        assert re.search(r"usual\(\d+, minutes=\d+\)|mem_mb=.*runtime=", rule, re.DOTALL), name


def test_one_job_of_a_group_at_a_time(profile):
    assert profile["resources"]["slot"] == profile["default-resources"]["slot"] == 1
    assert profile["set-resource-scopes"] == {"slot": "local"}
