"""Which scenes of the shipped frame sets share a camera and a light: none of one set."""

from itertools import combinations
from pathlib import Path

import numpy as np
import pytest
from shipped import shipped

from neural_shadows.config.reading import read_config
from neural_shadows.config.resolved import resolved
from neural_shadows.frames.draw_settings import FrameKind
from neural_shadows.frames.render_frames import draw, streams_of
from neural_shadows.frames.soft_scene import SoftScene
from neural_shadows.layout import frame_sets
from neural_shadows.layout.layout import Layout
from neural_shadows.scenes.generated import arrange

FRAMES = 3


@pytest.fixture(scope="module")
def layout():
    return Layout(resolved(read_config(shipped())))


def settings_of(layout, scene, frame_set, use):
    """The first settings of a scene's part as its stage draws them, without inserted objects."""
    told = frame_sets.frame_settings(layout, scene, frame_set, f"{use}_000")
    opened = SoftScene(told["scene"] | {"inserted": {}}, [])
    keys = ("width", "height", "fov", "of", "light_map")
    kind = FrameKind(**{key: told["frames"][key] for key in keys}, radius=0.25)
    return draw(opened, kind, use, 0, FRAMES, streams_of(told["name"], told["seed"]))


@pytest.mark.parametrize("use", ["train", "validation", "test"])
def test_scenes_of_one_layout_have_settings_of_their_own(layout, use):
    scenes = frame_sets.measured_scenes(layout, "nsm")
    assert scenes == ["room", "room_dragon", "room_fence"]  # one room, one seed
    drawn = {scene: settings_of(layout, scene, "nsm", use) for scene in scenes}
    for (_, one), (_, other) in combinations(drawn.items(), 2):
        for each in one:
            for twin in other:
                assert np.linalg.norm(each.camera.eye - twin.camera.eye) > 1e-3
                assert np.linalg.norm(each.centre - twin.centre) > 1e-3


def test_sets_that_share_a_scene_share_its_test_frames(layout):
    first, second = (settings_of(layout, "room", name, "test") for name in ("nsm", "nsm_between"))
    assert [one.as_json() for one in first] == [one.as_json() for one in second]


@pytest.mark.parametrize("frame_set", ["frames", "windows", "nsm", "nsm_plates"])
def test_each_scene_of_a_set_has_streams_of_its_own(layout, frame_set):
    told = [
        frame_sets.frame_settings(layout, scene, frame_set, "test_000")
        for scene in frame_sets.measured_scenes(layout, frame_set)
    ]
    assert len({streams_of(one["name"], one["seed"]) for one in told}) == len(told)


def test_at_least_twelve_scenes_are_unseen(layout):
    """Scenes are what a statement on scenes never seen counts."""
    for frame_set in ("frames", "windows"):
        unseen = layout.entry("frame_sets", frame_set)["unseen"]
        scenes = [layout.entry("scenes", name)["arrangement"] for name in unseen]
        assert len({(one["generate"], one["seed"]) for one in scenes}) == len(unseen) >= 12


def test_new_layouts_are_those_of_no_other_part(layout):
    """Of training windows by 16, of validation by two; a fixed scene has one layout throughout."""
    names = {
        use: [Path(path).stem for path in frame_sets.parts(layout, "courts", "layouts", use)]
        for use in ("train", "validation")
    }
    assert {use: len(parts) for use, parts in names.items()} == {"train": 7, "validation": 2}
    parts = [part for parts in names.values() for part in parts]
    told = [frame_sets.frame_settings(layout, "courts", "layouts", part) for part in parts]
    assert [each["last"] - each["first"] for each in told] == [16] * 7 + [2] * 2
    assert [each["rays"] for each in told] == [2] * 9
    drawn = [arrange("court", each["scene"]["seed"]) for each in told]
    sizes = {np.ptp(one.objects[0].vertices, axis=0).tobytes() for one in drawn}
    assert len(sizes) == len(drawn)
    fixed = [
        frame_sets.frame_settings(layout, "hall", "windows", f"{use}_000")["scene"]
        for use in ("train", "test")
    ]
    assert fixed[0] == fixed[1]
