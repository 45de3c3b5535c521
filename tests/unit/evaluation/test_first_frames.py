import numpy as np
import pandas as pd
import pytest

from neural_shadows.errors import InputError
from neural_shadows.evaluation import first_frames
from neural_shadows.evaluation.first_frames import read_first_frames

SHAPE = (8, 12)


def batch(folder, name, view_set, methods):
    """Files of a batch: views 0 and 1 with a PSNR each, and the first view's frames."""
    images = {method: np.full(SHAPE, level, np.uint8) for method, level in methods.items()}
    np.savez_compressed(folder / f"{name}.npz", reference=np.zeros(SHAPE, np.uint8), **images)
    rows = [
        (view, view_set, method, "psnr", level + view / 2)
        for view in (0, 1)
        for method, level in methods.items()
    ]
    frame = pd.DataFrame(rows, columns=["view", "view_set", "method", "metric", "value"])
    frame.to_csv(folder / f"{name}.csv", index=False, lineterminator="\n")
    return folder / f"{name}.npz", folder / f"{name}.csv"


@pytest.fixture
def batches(tmp_path):
    return [
        batch(tmp_path, "a", "shadow", {"map": 10, "net": 20}),
        batch(tmp_path, "b", "surface", {"map": 30, "net": 40}),
        batch(tmp_path, "c", "shadow", {"other": 50}),
    ]


def test_evaluations_are_joined_by_view_set(batches):
    shadow, surface = read_first_frames(*zip(*batches, strict=True))
    assert shadow.caption == "aimed at the cast shadow"
    assert list(shadow.images) == ["reference", "map", "net", "other"]
    assert shadow.images["other"].tolist() == np.full(SHAPE, 50).tolist()
    assert shadow.scores["net"] == {"psnr": 20}  # of the first view alone
    assert list(surface.images) == ["reference", "map", "net"]
    assert surface.scores["net"] == {"psnr": 40}


@pytest.mark.parametrize("size", [0, 40, -30])
def test_frames_cut_short_are_named(batches, size):
    picture, _ = batches[0]
    picture.write_bytes(picture.read_bytes()[:size])
    with pytest.raises(InputError, match=r"a\.npz: not a whole file of frames"):
        read_first_frames(*zip(*batches, strict=True))


def test_frames_that_unpack_to_more_than_memory_are_refused(batches, monkeypatch):
    picture, _ = batches[0]
    frames = 3 * (SHAPE[0] * SHAPE[1] + 128)  # each with its header
    monkeypatch.setattr(first_frames, "MOST_ALL_BYTES", frames)
    read_first_frames(*zip(*batches, strict=True))
    monkeypatch.setattr(first_frames, "MOST_ALL_BYTES", frames - 1)
    with pytest.raises(InputError, match=rf"{picture.name}: .*unpacks to more than {frames - 1}"):
        read_first_frames(*zip(*batches, strict=True))
