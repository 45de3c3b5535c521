import numpy as np
import pytest

from neural_shadows.errors import InputError
from neural_shadows.evaluation.first_frames import read_first_frames, write_first_frames
from neural_shadows.evaluation.per_view_metrics import COLUMNS, read_metrics, write_metrics


@pytest.fixture
def batch(tmp_path):
    """Pictures of a reference and two methods; metrics of the methods in views 0 and 1."""
    pictures, metrics = [], []
    for method, level in {"reference": 0, "map": 10, "net": 20}.items():
        images = {s: np.full((8, 12), level / 255, np.float32) for s in ("shadow", "surface")}
        pictures.append(tmp_path / f"{method}.000.npz")
        write_first_frames(pictures[-1], method, images)
        rows = [
            dict(zip(COLUMNS, (view, view_set, method, "psnr", level + view / 3)))
            for view in (0, 1)
            for view_set in images
        ]
        metrics.append(tmp_path / f"{method}.000.csv")
        write_metrics(metrics[-1], rows)
    return pictures, metrics[1:]


def test_methods_are_joined_by_view_set(batch):
    shadow, surface = read_first_frames(*batch)
    assert shadow.caption == "aimed at the cast shadow"
    for frame in (shadow, surface):
        assert list(frame.images) == ["reference", "map", "net"]
        assert (frame.images["net"] == 20).all() and frame.images["net"].dtype == np.uint8
        assert frame.scores == {"map": {"psnr": 10}, "net": {"psnr": 20}}  # of the first view


def test_metrics_come_back_to_the_bit(batch):
    metrics = read_metrics(batch[1])
    assert list(metrics.columns) == list(COLUMNS)
    last = metrics[(metrics["method"] == "net") & (metrics["view"] == 1)]
    assert last["value"].tolist() == [20 + 1 / 3] * 2


def test_damaged_files_are_named(batch):
    pictures, metrics = batch
    pictures[0].write_bytes(pictures[0].read_bytes()[:-30])
    with pytest.raises(InputError, match=r"reference\.000\.npz: cannot be read"):
        read_first_frames(pictures, metrics)
    metrics[0].write_text("view,view_set\n1,shadow\n")
    with pytest.raises(InputError, match=r"map\.000\.csv: cannot be read"):
        read_metrics(metrics)
