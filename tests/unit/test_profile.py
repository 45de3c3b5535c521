"""The profile for Slurm names rules and resources that there are."""

import re
from pathlib import Path

import yaml

ROOT = Path(__file__).parents[2]


PROFILE = yaml.safe_load((ROOT / "workflow/profiles/slurm/config.yaml").read_text())

_GRAPH = "\n".join(path.read_text() for path in (ROOT / "workflow" / "rules").glob("*.smk"))
RULES = dict(re.findall(r"^rule (\w+):\n((?: .*\n|\n)+)", _GRAPH, re.MULTILINE))


def test_rules_exist():
    """Snakemake says nothing of a name that is no rule's."""
    assert PROFILE["groups"].keys() <= RULES.keys()
    assert set(PROFILE["groups"].values()) == PROFILE["group-components"].keys()


def test_what_is_not_grouped_is_long_or_local():
    long = {"describe_rays", "train", "render_references", "count_violations", "evaluate"}
    long |= {"tune", "export_network", "render_frames", "measure_frames"}
    long |= {"measure_sensitivity", "answer_frames", "fit_fields", "expected_minutes"}
    timed = {"time_methods", "profile_screen_network", "measure_sun_hours"}
    local = {name for name, rule in RULES.items() if "localrule: True" in rule}
    assert local == {"find_lpips", "get_mesh", "restore_weights"}  # these may download
    assert PROFILE["set-resources"].keys() == timed
    assert RULES.keys() - PROFILE["groups"].keys() == long | timed | local


def test_every_rule_says_what_it_needs():
    for name, rule in RULES.items():
        assert re.search(r"usual\(\d+, minutes=\d+\)", rule), name


def test_one_job_of_a_group_at_a_time():
    assert PROFILE["resources"]["slot"] == PROFILE["default-resources"]["slot"] == 1
    assert PROFILE["set-resource-scopes"] == {"slot": "local"}
