"""What a network of whole frames may be trained on, told in one line; the trunk that it gets."""

import pytest
from shipped import shipped

from neural_shadows.config.reading import read_config
from neural_shadows.config.resolved import resolved
from neural_shadows.errors import InputError

FRAMES = {
    **{"scenes": ["atrium"], "unseen": ["garden"], "width": 64, "height": 32, "radii": [0, 0.25]},
    **{"light_map": {"kind": "perspective", "resolution": 64}, "train": 2, "twins": {"count": 1}},
}
BRIEF = {"steps": 10, "crops": 2, "crop": 32, "learning_rate": 0.1}
EXPERIMENT = {"network": "nsm", "training": "nsm", "frame_set": "few", "scenes": ["atrium"]}


def read(frames=None, metrics=None, **changes):
    sections = {"screen_experiments": {"mine": EXPERIMENT | changes}}
    sections["frame_sets"] = {"few": FRAMES | (frames or {})}
    if metrics is not None:
        sections["metrics"] = {"lpips": metrics}
    return read_config(shipped(**sections))


@pytest.mark.parametrize(
    ("changes", "told"),
    [
        ({"scenes": ["garden"]}, "'garden' is among `unseen` of frame_sets.few"),
        ({"scenes": ["atrim"]}, "did you mean 'atrium'"),
        ({"lights": [1, 2]}, "frame_sets.few has 2 radii, counted from 0"),
        ({"frames": {"train": 0}}, "frame_sets.few has train = 0"),
        ({"frames": {"twins": {"count": 0}}}, "perturbation = 3 needs twins"),
        (
            {"training": {"steps": 1, "crops": 1, "crop": 15, "learning_rate": 1.0}},
            "give 16 pixels",
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
            "crops = 3: .* give an even number",
        ),
        (
            {"training": BRIEF | {"schedule": "steps"}},
            r"tenth_from = \[\]: goes with `schedule: st",
        ),
        ({"training": BRIEF | {"tenth_from": [2]}}, r"= \[2\]: .*the schedule is 'cosine'"),
        (
            {"training": BRIEF | {"schedule": "steps", "tenth_from": [4, 10]}},
            r"= \[4, 10\]: must grow .* end below steps = 10",
        ),
    ],
)
def test_what_cannot_be_trained_is_refused(changes, told):
    with pytest.raises(InputError, match=f"config: screen_experiments.mine.*{told}"):
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
    found = resolved(read(metrics=metrics))["screen_experiments"]["mine"]
    assert (found["training"]["perceptual"]["net"], found["trunk"]) == (net, trunk)


@pytest.mark.parametrize(
    ("changes", "told"),
    [
        (
            {"networks_by_scene": {"mine": {"experiments": ["nsm", "nsm_plain"], "label": "Mine"}}},
            "networks_by_scene.mine.experiments: 'room' is learned by two of them",
        ),
        (
            {"networks_by_scene": {"nsm": {"experiments": ["nsm"], "label": "Mine"}}},
            "networks_by_scene.nsm: an entry of `screen_experiments` has this name",
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
            "tables.kpnsm_unseen.*time is not to be had by scene",
        ),
        (
            {"claims": {"kpnsm_leaks_less": {"again": {"pcss_post": ["kpnsm"]}}}},
            "claims.kpnsm_leaks_less.*again: 'pcss_post'",
        ),
    ],
)
def test_what_tables_and_claims_cannot_have_is_refused(changes, told):
    with pytest.raises(InputError, match=told):
        read_config(shipped(**changes))
