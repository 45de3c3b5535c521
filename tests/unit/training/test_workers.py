"""Threads follow the idle cores; results keep their order, and weights do not depend on them."""

import time

import pytest

from neural_shadows.training.workers import Workers


def at_once(pool: Workers) -> int:
    """Most of four calls that ran at the same time."""
    running, most = set(), []

    def call(number: int) -> int:
        running.add(number)
        most.append(len(running))
        time.sleep(0.05)
        running.discard(number)
        return number

    assert list(pool.map(call, range(4))) == [0, 1, 2, 3]
    return max(most)


def test_more_threads_while_cores_are_idle(idle):
    idle(2, 1)
    with Workers(1, run_cores=2, chunks=2) as pool:
        assert [at_once(pool) for _ in range(3)] == [2, 1, 2]
        assert pool.most == 2


@pytest.mark.parametrize("arguments", [(1, 1, 2), (1, 0, 2)])
def test_its_own_alone_where_the_run_has_no_other(idle, arguments):
    idle(2)
    with Workers(*arguments) as pool:
        assert at_once(pool) == pool.most == 1
