import shutil

import numpy as np
import pytest
from shapes import prepared

from neural_shadows.errors import InputError
from neural_shadows.rays import label_rays as stage
from neural_shadows.rays import shards
from neural_shadows.rays.labels import dual_bounds


def test_labels_are_those_of_the_rays(ray_set, everything, shape):
    origins, directions, t_lb, t_ub = everything(ray_set)
    cosines = np.sum(origins.astype(float) * directions, axis=1)
    assert ((t_lb > 0) & (t_lb <= -2 * cosines + 1e-6) & (t_lb <= t_ub)).all()
    expected = dual_bounds(prepared(shape)[1], origins, directions)
    assert np.array_equal([t_lb, t_ub], expected)


def wrong_once(*arguments):
    """`dual_bounds`, but for a NaN at the ray 123 of the third task."""
    t_lb, t_ub = dual_bounds(*arguments)
    wrong_once.tasks += 1
    if wrong_once.tasks == 3:
        t_lb[123] = np.nan
    return t_lb, t_ub


def half_of_the_tasks(task, directions, *_):
    """`run_tasks`, but for a second half that is never done: the file has zeros there."""
    task(0, directions // 2)


@pytest.mark.parametrize(
    ("name", "stand_in", "ray", "values"),
    [
        ("dual_bounds", wrong_once, f"ray 123 of direction {11 + 2 * 4}", "t_lb = nan, t_ub = "),
        ("run_tasks", half_of_the_tasks, f"ray 0 of direction {11 + 9}", "t_lb = 0.0, t_ub = 0"),
    ],
)
def test_a_shard_with_impossible_bounds_stops_the_run(
    part_of_first, ray_set, tmp_path, monkeypatch, name, stand_in, ray, values
):
    monkeypatch.setattr(stage, name, stand_in)
    monkeypatch.setattr(shards, "_TASK_RAYS", 4 * 400)
    wrong_once.tasks = 0
    origins, bounds = tmp_path / "origins.001.npy", tmp_path / "bounds.001.npy"
    shutil.copy(ray_set / origins.name, origins)
    part = part_of_first | {"first": 11, "last": 30}
    with pytest.raises(RuntimeError) as caught:
        stage.label_rays(**part, origins_npy=origins, bounds_npy=bounds)
    message = str(caught.value)
    assert message.startswith(f"labels {bounds} (seed 3): {ray} from [")
    assert values in message
    assert list(tmp_path.iterdir()) == [origins]  # no shard, and no part of one


def test_origins_of_another_range_are_refused(part_of_first, ray_set, tmp_path):
    origins, bounds = ray_set / "origins.001.npy", tmp_path / "out.npy"
    with pytest.raises(InputError, match=r"origins.001.npy: holds .*\(19, 400, 3\)"):
        stage.label_rays(**part_of_first, origins_npy=origins, bounds_npy=bounds)
