"""A part of a frame set, from its stage to its reader; and what is wrong with one."""

import json
from unittest import mock

import numpy as np
import pytest

from neural_shadows.errors import InputError
from neural_shadows.frames import render_frames as render_frames_stage
from neural_shadows.frames.buffers import CHANNELS
from neural_shadows.frames.frame_set import FrameSetPart, check_values
from neural_shadows.frames.render_frames import render_frames

FRAMES = {
    **{"width": 32, "height": 16, "fov": 55, "of": None, "blur": 0.7},
    "light_map": {"kind": "perspective", "fov": 120, "resolution": 64},
    **{"radii": [0, 0.1, 0.25], "radius_unit": "metres"},
    "twins": {"count": 3, "light": 0.007, "eye": 0.001, "turn_deg": 0.0},
}
SCENE = {"generate": "blinds", "seed": 3, "inserted": {}}


def render(folder, first=0, last=2, use="train", **changed):
    ends = ("json", "buffers.npy", "targets.npy", "valid.npy", "edges.npy")
    paths = [folder / f"{use}_000.{end}" for end in ends]
    told = {"use": use, "first": first, "last": last, "samples": 2, "twins": 2} | changed
    told = {"scene": SCENE, "name": "blinds", "seed": 3, "frames": FRAMES} | told
    render_frames([], *paths, **told)
    return FrameSetPart(paths[0])


@pytest.fixture(scope="module")
def part(tmp_path_factory):
    return render(tmp_path_factory.mktemp("part"))


def test_what_is_kept(part):
    assert len(part) == 2 and part.radii == [0, 0.1, 0.25]
    assert part.buffers.shape == (2, 3, len(CHANNELS), 16, 32)
    assert part.targets.shape == (2, 3, 16, 32) and part.valid.shape == (2, 3, 16, 32)
    assert part.targets.min() >= 0 and part.targets.max() <= 1
    check_values(part)
    # A hard shadow has no blur, but eight places a pixel.
    assert np.all(np.round(8 * part.targets[:, 0].astype(float)) == 8 * part.targets[:, 0])


def test_twins_are_other_pictures_of_nearly_the_same(part):
    d = part.buffers[:, :, CHANNELS.index("d")].astype(float)
    z = part.buffers[:, :, CHANNELS.index("z")].astype(float)
    assert np.all(np.abs(z[:, 1:] - z[:, :1]).max((2, 3)) > 0)
    assert np.median(np.abs(d[:, 1:] - d[:, :1])) < 0.01


def test_a_frame_does_not_depend_on_its_part(part, tmp_path):
    alone = render(tmp_path, first=1)
    assert np.array_equal(alone.buffers[0], part.buffers[1])
    assert np.array_equal(alone.targets[0], part.targets[1])


def test_uses_have_frames_of_their_own(part, tmp_path):
    other = render(tmp_path, use="test", twins=0)
    assert other.setting(0).as_json() != part.setting(0).as_json()
    assert other.buffers.shape[1] == 1


def test_nothing_is_left_where_a_frame_fails_after_others(tmp_path, monkeypatch):
    fails = mock.Mock(side_effect=[(np.zeros((3, 16, 32)), np.zeros((16, 32))), MemoryError])
    monkeypatch.setattr(render_frames_stage, "render_target", fails)
    with pytest.raises(MemoryError):
        render(tmp_path)
    assert [*tmp_path.iterdir()] == []


@pytest.mark.parametrize(
    "change, told",
    [
        ({"width": 31}, "is float16 .*, not float16"),
        ({"radii": [0, -0.1, 0.2]}, "radius below 0"),
        ({"channels": ["z", "depth"]}, "channels z, depth; should be z and others of z, gap"),
        ({"size": None}, "'size'"),
        ({"frames": [{"setting": {"fov_deg": 55, "window": None}}]}, "frame 0 has no 'twins'"),
    ],
)
def test_a_json_that_does_not_fit(part, tmp_path, change, told):
    about = {key: value for key, value in (dict(part.about) | change).items() if value is not None}
    copy = tmp_path / part.frames_json.name
    copy.write_text(json.dumps(about))
    for stem in ("buffers", "targets", "valid"):
        name = f"{part.frames_json.stem}.{stem}.npy"
        (tmp_path / name).symlink_to(part.frames_json.with_name(name))
    with pytest.raises(InputError, match=told):
        _ = FrameSetPart(copy).targets


@pytest.mark.parametrize(
    "frame, lacking", [({}, "fov_deg"), ({"setting": {"fov_deg": 55}}, "window")]
)
def test_a_setting_without_a_camera(part, tmp_path, frame, lacking):
    copy = tmp_path / part.frames_json.name
    copy.write_text(json.dumps(dict(part.about) | {"frames": [frame | {"twins": []}]}))
    with pytest.raises(InputError, match=f"setting of frame 0 has no '{lacking}'"):
        FrameSetPart(copy).lens(0)


def test_a_truncated_shard(part, tmp_path):
    copy = tmp_path / part.frames_json.name
    copy.write_bytes(part.frames_json.read_bytes())
    whole = part.frames_json.with_suffix(".buffers.npy").read_bytes()
    copy.with_suffix(".buffers.npy").write_bytes(whole[:-100])
    with pytest.raises(InputError, match=r"test_000|train_000.buffers.npy: damaged"):
        _ = FrameSetPart(copy).buffers


@pytest.mark.parametrize(
    "stem, place, value, told",
    [
        ("buffers", (1, 0, 0, 3, 4), np.nan, "buffers of frame 1 has NaN"),
        ("buffers", (1, 0, CHANNELS.index("hard"), 3, 4), 2, "values of hard of frame 1 leave"),
        ("targets", (0, 1, 3, 4), 1.2, "targets of frame 0 leave"),
        ("valid", (1,), False, "no pixel of frame 1 is valid"),
    ],
)
def test_values_that_cannot_be(part, tmp_path, stem, place, value, told):
    copy = tmp_path / part.frames_json.name
    copy.write_bytes(part.frames_json.read_bytes())
    for name in ("buffers", "targets", "valid"):
        array = np.array(getattr(part, name))
        if name == stem:
            array[place] = value
        np.save(copy.with_suffix(f".{name}.npy"), array)
    with pytest.raises(InputError, match=told):
        check_values(FrameSetPart(copy))
