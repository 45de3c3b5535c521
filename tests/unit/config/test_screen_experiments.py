"""Checks of screen-space experiments, with one-line messages; pretrained weights."""

import pytest
from shipped import shipped

from neural_shadows.config.reading import check_files, read_config
from neural_shadows.config.resolved import resolved
from neural_shadows.errors import InputError

FRAMES = {
    **{"scenes": ["atrium"], "unseen": ["garden"], "width": 64, "height": 32, "radii": [0, 0.25]},
    **{"light_map": {"kind": "perspective", "resolution": 64}, "train": 2, "twins": {"count": 1}},
}
BRIEF = {"steps": 10, "crops": 2, "crop": 32, "learning_rate": 0.1}
EXPERIMENT = {"network": "nsm", "training": "nsm", "frame_set": "few", "scenes": ["atrium"]}


def read(frames=None, metrics=None, **changes):
    sections = {"experiments": {"mine": EXPERIMENT | changes}}
    sections["frame_sets"] = {"few": FRAMES | (frames or {})}
    if metrics is not None:
        sections["metrics"] = {"lpips": metrics}
    return read_config(shipped(**sections))


@pytest.mark.parametrize(
    ("changes", "words"),
    [
        ({"scenes": ["garden"]}, "'garden' is in `unseen` of frame_sets.few"),
        ({"scenes": ["atrim"]}, "did you mean 'atrium'"),
        ({"lights": [1, 2]}, "frame_sets.few has 2 radii, counted from 0"),
        ({"frames": {"train": 0}}, "frame_sets.few has train = 0"),
        ({"frames": {"twins": {"count": 0}}}, "perturbation = 3 needs perturbed frames"),
        ({"network": "kernels_rays"}, "filters rays, and frame_sets.few has rays = 0"),
        (
            {"network": "kernels_rays", "frames": {"rays": 1}},
            "perturbation = 3: perturbed frames have no rays.*Set perturbation: 0",
        ),
        (
            {"network": {"form": "kernels", "widths": [4, 8], "features": ["base_pcf"], "edge": 1}},
            "edge: needs the feature 'log_d'",
        ),
        (
            {"training": {"steps": 1, "crops": 1, "crop": 15, "learning_rate": 1.0}},
            "Set 16 or more",
        ),
        ({"network": "original_5"}, "not among nsm, trimmed"),
        (
            {"network": {"form": "kernels", "widths": [4, 8], "features": ["cosine", "z_b"]}},
            "network.features: kernels filter one of the features base_hard.*; there is none",
        ),
        (
            {
                "network": {"form": "direct", "widths": [4, 8, 8, 8], "features": ["c_e"]},
                "training": {"steps": 1, "crops": 1, "crop": 15, "learning_rate": 1.0},
            },
            "1/16 of a frame",
        ),
        (
            {
                "network": {"form": "direct", "widths": [4, 8], "features": ["c_e"]},
                "training": {"steps": 1, "crops": 3, "crop": 64, "learning_rate": 1.0},
            },
            "crops = 3: .* Set an even number",
        ),
        (
            {"training": BRIEF | {"schedule": "steps"}},
            r"tenth_from = \[\]: needs one step or more with `schedule: st",
        ),
        ({"training": BRIEF | {"tenth_from": [2]}}, r"= \[2\]: .*the schedule is 'cosine'"),
        (
            {"training": BRIEF | {"schedule": "steps", "tenth_from": [4, 10]}},
            r"= \[4, 10\]: must be ascending, .* end below steps = 10",
        ),
    ],
)
def test_what_cannot_be_trained_is_refused(changes, words):
    with pytest.raises(InputError, match=f"config: experiments.mine.*{words}"):
        read(**changes)


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
    ("changes", "words"),
    [
        (
            {"networks_by_scene": {"mine": {"experiments": ["nsm", "nsm_plain"], "label": "Mine"}}},
            "networks_by_scene.mine.experiments: 'room' has two networks",
        ),
        (
            {"networks_by_scene": {"nsm": {"experiments": ["nsm"], "label": "Mine"}}},
            "networks_by_scene.nsm: an entry of `experiments` has this name",
        ),
        (
            {"frame_sets": {"windows": {"unseen": []}}},
            "tables.kpnsm_unseen.over: frame_sets.windows has no `unseen`",
        ),
        (
            {"frame_sets": {"windows": {"sequence": 0}}},
            "tables.kpnsm_table_3.frame_set: frame_sets.windows has sequence = 0",
        ),
        (
            {"tables": {"kpnsm_unseen": {"metrics": ["time"]}}},
            "tables.kpnsm_unseen.*time is not available with `by: scene`",
        ),
        (
            {"claims": {"kpnsm_leaks_less": {"again": {"pcss_post": ["kpnsm"]}}}},
            "claims.kpnsm_leaks_less.*again: 'pcss_post'",
        ),
        (
            {"claims": {"kpnsm_leaks_less": {"again": {"msm_15": ["kpnsm_basic"]}}}},
            "claims.kpnsm_leaks_less.again: 'msm_15' is not among kpnsm",
        ),
        (
            {"claims": {"kpnsm_leaks_less": {"again": {"kpnsm": ["kpnsm_basic"]}}}},
            "kpnsm_leaks_less.again.kpnsm: 'kpnsm_basic' has another network than 'kpnsm'. .*seed",
        ),
        (
            {"claims": {"kpnsm_leaks_less": {"again": {"kpnsm": ["kpnsm"]}}}},
            "claims.kpnsm_leaks_less.again: 'kpnsm' is listed twice",
        ),
        (
            {"claims": {"nsm_wider_with_the_light": {"again": {"nsm_between": ["nsm_between"]}}}},
            "claims.nsm_wider_with_the_light.again: 'nsm_between' is listed twice",
        ),
        (
            {"tables": {"kpnsm_unseen": {"methods": ["kpnsm", {"method": "kpnsm", "label": "K"}]}}},
            "tables.kpnsm_unseen.methods: 'kpnsm' is listed twice",
        ),
        (
            {"tables": {"soft_methods": {"methods": ["pcss", "pcss"]}}},
            "tables.soft_methods.methods: 'pcss' is listed twice",
        ),
    ],
)
def test_what_tables_and_claims_cannot_have_is_refused(changes, words):
    with pytest.raises(InputError, match=words):
        read_config(shipped(**changes))


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
