import numpy as np
import pytest
from shapes import prepared

from neural_shadows.errors import InputError
from neural_shadows.rays import label_rays as stage
from neural_shadows.rays import shards
from neural_shadows.rays.labels import dual_bounds


@pytest.fixture
def label(mesh_ply, ray_set, tmp_path):
    """A function that labels the rays of the second shard into an empty folder."""

    def label(first=11):
        stage.label_rays(
            mesh_ply=mesh_ply,
            directions_npy=ray_set / "directions.npy",
            origins_npy=ray_set / "origins.001.npy",
            bounds_npy=tmp_path / "bounds.001.npy",
            seed=3,
            first=first,
            last=30,
        )

    return label


def test_labels_are_those_of_the_rays(ray_set, everything, shape):
    origins, directions, t_lb, t_ub = everything(ray_set)
    cosines = np.sum(origins.astype(float) * directions, axis=1)
    assert ((t_lb > 0) & (t_lb <= -2 * cosines + 1e-6) & (t_lb <= t_ub)).all()
    expected = dual_bounds(prepared(shape)[1], origins, directions)
    assert np.array_equal([t_lb, t_ub], expected)


def test_a_shard_with_impossible_bounds_stops_the_run(label, tmp_path, monkeypatch):
    tasks = []

    def wrong_once(*arguments):
        """`dual_bounds`, but for a NaN at the ray 123 of the third task."""
        t_lb, t_ub = dual_bounds(*arguments)
        tasks.append(1)
        if len(tasks) == 3:
            t_lb[123] = np.nan
        return t_lb, t_ub

    monkeypatch.setattr(stage, "dual_bounds", wrong_once)
    monkeypatch.setattr(shards, "_TASK_RAYS", 4 * 400)
    with pytest.raises(RuntimeError, match="t_lb = nan, t_ub = ") as caught:
        label()
    start = f"labels {tmp_path}/bounds.001.npy (seed 3): ray 123 of direction {11 + 2 * 4} from ["
    assert str(caught.value).startswith(start)
    assert list(tmp_path.iterdir()) == []  # no shard, and no part of one


def test_origins_of_another_range_are_refused(label):
    with pytest.raises(InputError, match=r"origins.001.npy: holds .*\(19, 400, 3\)"):
        label(first=0)
