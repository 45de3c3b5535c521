"""Frames of the user that a method cannot answer are refused before any training."""

import json
import re

import numpy as np
import pytest
from engine_frames import NAMES, write_exr, write_npz
from shipped import shipped

from neural_shadows.config.reading import read_config
from neural_shadows.config.targets import check_targets
from neural_shadows.errors import InputError

IMAGES = {name: np.ones((4, 8), np.float32) for name in NAMES.values()}
TABLE = {"kind": "soft_methods", "title": "Mine", "frame_set": "quay"}


@pytest.fixture(params=[write_exr, write_npz])
def engine(request, tmp_path):
    """A function: a configuration with frames of an engine that lack some images."""

    def configured(lacking=(), methods=None, **settings):
        images = {name: image for name, image in IMAGES.items() if name not in lacking}
        request.param(tmp_path / "quay/a frame", images)
        engine = {"sizes": {"quay": 2.0}, "radii": [0, 0.001], "targets": [], **settings}
        values = shipped()
        values["frame_sets"]["quay"] = {"path": str(tmp_path), "engine": engine}
        if methods:
            values["tables"]["mine"] = TABLE | {"methods": methods}
        return values

    return configured


def refused(values, target=None):
    targets = [target] if target else []
    with pytest.raises(InputError) as caught:
        config = read_config(values)
        check_targets(targets, config, config_folder())
    assert "\n" not in str(caught.value)
    return str(caught.value)


def config_folder():
    from checkout import ROOT

    return ROOT / "config"


def test_whole_frames_pass(engine):
    config = read_config(engine(methods=["base_hard", "base_msm", "kpnsm"]))
    check_targets(["reports/answers/quay/kpnsm.csv"], config, config_folder())


@pytest.mark.parametrize("method", ["pcss", "hard", "rt_4"])
def test_a_method_that_needs_a_scene_is_refused(engine, method):
    target = f"reports/answers/quay/{method}.csv"
    words = f"{target}: '{method}' needs the scene's geometry, and a user's own frames have none"
    assert refused(engine(), target).startswith(words)


@pytest.mark.parametrize("target", [None, "reports/answers/quay/kpnsm.csv"])
def test_a_missing_image_is_named_with_its_key(engine, target):
    said = refused(engine([NAMES["c_v"]], None if target else ["base_hard", "kpnsm"]), target)
    where = target or "config: tables.mine.methods"
    assert said.startswith(f"{where}: 'kpnsm' needs all its channels in frame_sets.quay: ")
    assert "a frame" in said and "has no MyGBuffer.cv.15." in said
    assert said.endswith("or name another image in `engine.channels.c_v`")


def test_only_what_a_method_needs_is_needed(engine):
    lacking = [NAMES[name] for name in ("msm", "n_x", "n_y", "n_z")]
    config = read_config(engine(lacking, methods=["base_hard"]))
    check_targets(["reports/answers/quay/base_hard.csv"], config, config_folder())
    assert "'base_msm' needs" in refused(engine(lacking, methods=["base_msm"]))


def test_a_channel_without_an_image_is_refused(engine):
    said = refused(engine(methods=["nsm_features_6"], radius_unit="metres"))
    assert "`engine.channels.agreement` names no image" in said


def test_names_may_begin_with_a_prefix(engine):
    said = refused(engine(methods=["base_hard"], prefix="Mogwai."))
    assert "has no Mogwai.MyShadowMap.color.15." in said
    images = {"hard": NAMES["hard"]}
    read_config(engine(methods=["base_hard"], prefix="Mogwai.", channels=images))


def test_lights_have_the_unit_of_the_training_and_are_no_larger(engine):
    said = refused(engine(radius_unit="metres"), "reports/answers/quay/kpnsm.csv")
    assert (
        "is trained on radii in scene_sizes" in said and "`engine.radius_unit: scene_sizes`" in said
    )
    said = refused(engine(radii=[0, 0.5]), "reports/answers/quay/kpnsm.csv")
    assert "is trained on lights of up to 0.01 scene_sizes" in said and "has one of 0.5" in said
    assert "End its `engine.radii` at 0.01, or train it" in said


def test_names_in_the_target_have_suggestions(engine):
    for target, words in (
        ("reports/answers/quai/kpnsm.csv", "'quai' (did you mean 'quay'?)"),
        ("reports/answers/quay/kpnsn.csv", "'kpnsn' (did you mean 'kpnsm'?)"),
    ):
        assert words in refused(engine(), target)


def test_arrays_have_their_channels_in_their_json(tmp_path):
    path = tmp_path / "quay/test_000.json"
    path.parent.mkdir()
    values = shipped()
    values["frame_sets"]["quay"] = {"path": str(tmp_path)}
    values["tables"]["mine"] = TABLE | {"methods": ["base_hard"]}
    path.write_text(json.dumps({"channels": ["z", "hard"]}))
    read_config(values)
    path.write_text(json.dumps({"channels": ["z"]}))
    assert re.search(r"test_000\.json has no channel hard\. Write it", refused(values))
