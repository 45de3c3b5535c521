"""Trunks, seeds and pretrained weights of screen-space experiments."""

import pytest
from shipped import shipped

from neural_shadows.config.reading import check_files, read_config
from neural_shadows.config.resolved import resolved
from neural_shadows.errors import InputError

EXPERIMENT = {
    "network": "nsm",
    "training": "nsm",
    "frame_set": "nsm",
    "scenes": ["room"],
    "seed": 7,
}


def read(metrics=None, **changes):
    sections = {"experiments": {"mine": EXPERIMENT | changes}}
    if metrics is not None:
        sections["metrics"] = {"lpips": metrics}
    return read_config(shipped(**sections))


@pytest.mark.parametrize(
    ("metrics", "net", "trunk"),
    [
        ({"net": "squeeze", "trunk": "squeeze.pth"}, "squeeze", "squeeze.pth"),
        ({"net": "alex", "trunk": "alex.pth"}, "none", None),
        ({"net": "squeeze"}, "none", None),
    ],
)
def test_squeezenet_s_trunk_is_lpips_s(metrics, net, trunk):
    found = resolved(read(metrics=metrics))["experiments"]["mine"]
    assert (found["training"]["perceptual"]["net"], found["trunk"]) == (net, trunk)


@pytest.mark.parametrize(
    ("claim", "again", "words"),
    [
        (
            "kpnsm_leaks_less",
            {"kpnsm": ["kpnsm_seed_1", "kpnsm_seed_1"]},
            "again: 'kpnsm_seed_1' is listed twice",
        ),
        (
            "kpnsm_leaks_less",
            {"kpnsm": ["kpnsm_seed_2", "kpnsm_seed_1"]},
            "again.kpnsm: 'kpnsm_seed_1' has the seed 1 of 'kpnsm'. Give each its own",
        ),
        (
            "kpnsm_half_ends_err_little_more",
            {"kpnsm_steps": ["kpnsm_steps_seed_2", "kpnsm_steps_seed_1"]},
            "again.kpnsm: 'kpnsm_seed_1' has the seed 1 of 'kpnsm'",
        ),
        (
            "kpnsm_half_ends_err_little_more",
            {"kpnsm_steps": ["kpnsm_table_3_seed_1"]},
            "again.kpnsm_steps: 'kpnsm_table_3_seed_1' has no network .* from 'kpnsm_full_ends' in",
        ),
        (
            "nsm_wider_with_the_light",
            {"nsm_between": ["nsm_unseen"]},
            "again.nsm_between: 'nsm_unseen' has no network .* from 'nsm' in",
        ),
    ],
)
def test_other_seeds_are_other_ones_of_the_same_network(claim, again, words):
    values = shipped("nsm_seeds", "kpnsm_seeds", seed=1)
    values["claims"] = {claim: values["claims"][claim] | {"again": again}}
    with pytest.raises(InputError, match=f"claims.{claim}.{words}"):
        read_config(values)


def test_a_claim_on_tables_is_about_the_networks_of_other_seeds_too():
    """And not about others in their tables."""
    claims = resolved(read_config(shipped("nsm_seeds")))["claims"]
    found = {"nsm", "nsm_seed_1", "nsm_seed_2", "nsm_plain", "nsm_plain_seed_1", "nsm_plain_seed_2"}
    assert {*claims["nsm_perturbation_calms"]["networks"]} == found
    found = {"nsm_trimmed", "nsm_trimmed_seed_1", "nsm_trimmed_seed_2"}
    assert {*claims["nsm_16_bits_err_no_more"]["networks"]} == found


def test_shipped_weights_are_files_there_or_in_the_checkout_or_urls(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    for path in ("README.md", "https://example.org/mine.safetensors"):
        check_files(read(weights={"path": path, "sha256": "0" * 64}))
    missing = {"path": "mine.safetensors", "sha256": "0" * 64}
    with pytest.raises(InputError, match=r"mine.weights.path = 'mine.safetensors': no such file"):
        check_files(read(weights=missing))
    (tmp_path / "mine.safetensors").touch()
    check_files(read(weights=missing))
    with pytest.raises(InputError, match="experiments.mine.weights.sha256 = 'A'"):
        read(weights=missing | {"sha256": "A"})
