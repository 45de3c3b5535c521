"""A part of a frame set, from its stage to its reader; and what is wrong with one."""

import json
from unittest import mock

import numpy as np
import pytest
from rendered_frames import render_part

from neural_shadows.errors import InputError
from neural_shadows.frames import render_frames as render_frames_stage
from neural_shadows.frames.buffers import CHANNELS
from neural_shadows.frames.frame_set import FrameSetPart, check_values

TWINS = {"light": 0.007, "eye": 0.001, "turn_deg": 0.0}
FRAMES = {"width": 32, "height": 16, "blur": 0.7}


def render(folder, use="train", first=0, twins=2):
    frames = FRAMES | {"twins": TWINS | {"count": twins}}
    return FrameSetPart(render_part(folder, use, frames, first=first, last=2, samples=2))


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


def copied(part, folder, about=None, **arrays):
    """A copy of the part's files, with another JSON or other arrays."""
    copy = folder / part.frames_json.name
    copy.write_text(json.dumps(about or dict(part.about)))
    for stem in ("buffers", "targets", "valid"):
        np.save(copy.with_suffix(f".{stem}.npy"), arrays.get(stem, getattr(part, stem)))
    return copy


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
    with pytest.raises(InputError, match=told):
        _ = FrameSetPart(copied(part, tmp_path, about)).targets


@pytest.mark.parametrize(
    "frame, lacking", [({}, "fov_deg"), ({"setting": {"fov_deg": 55}}, "window")]
)
def test_a_setting_without_a_camera(part, tmp_path, frame, lacking):
    copy = copied(part, tmp_path, dict(part.about) | {"frames": [frame | {"twins": []}]})
    with pytest.raises(InputError, match=f"setting of frame 0 has no '{lacking}'"):
        FrameSetPart(copy).lens(0)


@pytest.mark.parametrize("left, problem", [(-100, "damaged"), (0, "damaged"), (None, "missing")])
@pytest.mark.parametrize("own", [False, True])
def test_an_array_that_is_not_whole(part, tmp_path, left, problem, own):
    """A job's part is written again without its JSON, which other jobs have as an input."""
    copy = copied(part, tmp_path)
    copy.write_text(json.dumps({k: v for k, v in part.about.items() if k != "scene" or not own}))
    array = copy.with_suffix(".buffers.npy")
    whole = array.read_bytes()
    array.unlink()
    if left is not None:
        array.write_bytes(whole[:left])
    with pytest.raises(InputError) as error:
        _ = FrameSetPart(copy).buffers
    assert str(error.value).startswith(f"{array}: {problem}")
    cure = "Write it anew" if own else f"Delete {copy} and run again"
    assert str(error.value).endswith(f". {cure}")


@pytest.mark.parametrize(
    "stem, place, value, told",
    [
        ("buffers", (1, 0, 0, 3, 4), np.nan, "buffers of frame 1 has NaN"),
        ("buffers", (1, 0, CHANNELS.index("hard"), 3, 4), 2, "hard of frame 1 is from 0 to 2"),
        ("buffers", (0, 1, CHANNELS.index("n_x"), 3, 4), -2, "n_x of frame 0 is from -2 to"),
        ("buffers", (0, 0, CHANNELS.index("d"), 3, 4), -2, "d of frame 0 .* should be 0 or more"),
        ("targets", (0, 1, 3, 4), 1.2, "a target of frame 0 is from 0 to 1.2"),
        ("valid", (1,), False, "no pixel of frame 1 is valid"),
    ],
)
def test_values_that_cannot_be(part, tmp_path, stem, place, value, told):
    array = np.array(getattr(part, stem))
    array[place] = value
    with pytest.raises(InputError, match=told):
        check_values(FrameSetPart(copied(part, tmp_path, **{stem: array})))


def test_pixels_without_a_surface_may_have_any_values(part, tmp_path):
    array = np.array(part.buffers)
    array[0, 0, CHANNELS.index("z"), 3, 4] = 0
    array[0, 0, CHANNELS.index("d"), 3, 4] = -2
    check_values(FrameSetPart(copied(part, tmp_path, buffers=array)))
