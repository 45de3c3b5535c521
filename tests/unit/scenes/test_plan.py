"""Where things stand: clear of each other, on the floor, and with room for what hangs over them."""

import numpy as np

from neural_shadows.scenes.pieces.plan import Plan, furnish
from neural_shadows.scenes.pieces.shapes import box


def test_what_is_placed_is_clear_of_all_else():
    rng, plan = np.random.default_rng(0), Plan(6, 4)
    plan.take([-1, -1], [1, 1])
    for width, depth in rng.uniform(0.2, 1.2, (30, 2)):
        plan.place(rng, width, depth)
    lows, highs, _ = (np.array(one) for one in zip(*plan.taken))
    assert 10 < len(lows) < 31
    assert (lows >= [-3, -2]).all() and (highs <= [3, 2]).all()
    for k in range(len(lows)):
        overlaps = (highs > lows[k]).all(1) & (lows < highs[k]).all(1)
        assert np.flatnonzero(overlaps).tolist() == [k]


def test_where_the_middle_may_be():
    rng, plan = np.random.default_rng(0), Plan(6, 4)
    for _ in range(5):
        place = plan.place(rng, 0.2, 0.2, [-1, 0.5], [1, 9])
        assert abs(place[0]) <= 1 and 0.5 <= place[2] <= 1.9 and place[1] == 0
    assert plan.place(rng, 0.2, 0.2, [5, 0], [6, 1]) is None


def test_a_full_floor_has_no_place():
    rng, plan = np.random.default_rng(0), Plan(2, 2)
    plan.take([-1, -1], [0.8, 1])
    assert plan.place(rng, 0.4, 0.4) is None and plan.place(rng, 3, 0.4) is None


def test_what_may_hang_over_what_stands():
    plan = Plan(4, 4)
    plan.take([0, 0], [1, 1], top=0.8)
    plan.take([-1, 0], [0, 1])
    low, high = np.array([0.2, 0.2]), np.array([0.4, 0.4])
    assert plan.is_under(low, high, 0.9) and not plan.is_under(low, high, 0.7)
    assert not plan.is_under(low - 0.5, high, 9)  # there nothing may hang
    assert plan.is_under(low + 2, high + 2, 0)


def test_pieces_are_turned_by_quarters_and_stand_where_they_were_placed():
    rng, plan = np.random.default_rng(0), Plan(5, 5)
    long = lambda _: (box((-0.6, 0, -0.1), (0.6, 0.5, 0.1)), 1.4, 0.4)  # noqa: E731
    objects = furnish(rng, plan, [long], 20, [])
    assert len(objects) == len(plan.taken) > 5
    for one, (low, high, top) in zip(objects, plan.taken):
        corners = one.vertices[:, [0, 2]]
        assert (corners > low).all() and (corners < high).all() and top == 0.5
    sizes = {tuple((np.ptp(one.vertices, axis=0)[[0, 2]] > 1).tolist()) for one in objects}
    assert sizes == {(True, False), (False, True)}
