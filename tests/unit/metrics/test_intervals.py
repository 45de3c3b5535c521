import numpy as np
import pytest
from scipy import stats

from neural_shadows.metrics.intervals import (
    FEWEST_SCENES,
    mean_interval,
    paired_difference,
    pooled_psnr_difference,
    scenes_interval,
    t_interval,
    two_way_interval,
)
from neural_shadows.metrics.pooled_psnr import psnr_of

TRIALS = 10_000  # of which 95 % are 0.2 % off by chance


def test_a_share_gives_the_binomial_percentiles():
    # The resampled mean of k ones among n is exactly Binomial(n, k/n)/n. So few are skew:
    # percentiles 0 and 5 of 40 about a mean of 2, where other bootstraps give -1 and 4.
    mean, low, high = mean_interval(np.repeat([1.0, 0.0], [2, 38]), seed=3, resamples=20_000)
    exact, tail = stats.binom(40, 2 / 40), stats.norm.sf(np.sqrt(40 / 39) * stats.t.ppf(0.975, 39))
    assert mean == 2 / 40 and 0.02 < tail < 0.025
    assert low == pytest.approx(exact.ppf(tail) / 40, abs=1e-12)
    assert high == pytest.approx(exact.ppf(1 - tail) / 40, abs=1e-12)


@pytest.mark.parametrize("count", [10, 16])
def test_few_views_of_an_object_are_covered(count):
    """Percentiles at 95 % would cover 90.5 and 91.7 % (4,000 trials; at the level here 94.5)."""
    values = np.random.default_rng(count).normal(0, 1, (800, count))
    ends = [mean_interval(some, seed=i, resamples=500) for i, some in enumerate(values)]
    assert 0.925 <= np.mean([low <= 0 <= high for _, low, high in ends]) <= 0.97  # 0.8 % by chance


def test_two_views_have_an_interval_too():
    assert mean_interval([1.0, 3.0], seed=1) == pytest.approx((2, 1, 3))
    assert pooled_psnr_difference([20, 20], [30, 30], seed=1) == pytest.approx((-10, -10, -10))


def scenes_and_frames(trials, scenes, frames, *, trainings=1, skewed=False, seeds=0.3):
    """Values (trials, S, scenes × frames) about 0: scenes differ as much as frames within them,
    trainings by `seeds` times that, alike in all scenes and apart in each.
    """
    rng = np.random.default_rng(100 * scenes + frames)

    def drawn(*shape):
        if not skewed:
            return rng.normal(0, 1, shape)
        distribution = stats.lognorm(0.4)  # skewness 1.3
        return (distribution.rvs(shape, rng) - distribution.mean()) / distribution.std()

    values = drawn(trials, 1, scenes, 1) + drawn(trials, 1, scenes, frames)
    apart = rng.normal(0, seeds, (trials, trainings, 1, 1))
    apart = apart + rng.normal(0, seeds, (trials, trainings, scenes, 1))
    return (values + apart * (trainings > 1)).reshape(trials, trainings, -1)


def coverage(values, scenes):
    _, low, high, p = scenes_interval(values, scenes)
    assert ((p < 0.05) == ((low > 0) | (high < 0))).all()
    return np.mean((low <= 0) & (high >= 0))


@pytest.mark.parametrize("skewed", [False, True])
@pytest.mark.parametrize("scenes", [5, 10, 16])
@pytest.mark.parametrize("frames", [2, 3, 6])
def test_intervals_over_scenes_cover_what_they_say(scenes, frames, skewed):
    """Frames drawn anew within fixed scenes cover 47 to 62 % of these (400 trials)."""
    values = scenes_and_frames(TRIALS, scenes, frames, skewed=skewed)
    assert 0.93 <= coverage(values, np.repeat(np.arange(scenes), frames)) <= 0.97


@pytest.mark.parametrize("seeds", [0.1, 0.3, 1.0])
@pytest.mark.parametrize("scenes", [5, 10, 16])
def test_intervals_over_scenes_and_trainings_cover_what_they_say(scenes, seeds):
    values = scenes_and_frames(TRIALS, scenes, 3, trainings=3, seeds=seeds)
    assert 0.93 <= coverage(values, np.repeat(np.arange(scenes), 3)) <= 0.97


def test_unlike_numbers_of_frames_are_covered():
    """Two frames of five scenes, six of five others, as the windows have."""
    scenes = np.repeat(np.arange(10), [2] * 5 + [6] * 5)
    values = scenes_and_frames(TRIALS, 10, 6)[..., np.tile(np.arange(6), 10) < 2]
    some = np.concatenate([values[..., :10], scenes_and_frames(TRIALS, 5, 6)], axis=2)
    assert 0.93 <= coverage(some, scenes) <= 0.97


@pytest.mark.parametrize(("scenes", "frames"), [(1, 10), (1, 16), (2, 8), (4, 6)])
def test_frames_of_few_scenes_are_covered_in_these_scenes(scenes, frames):
    """What the scenes have in common is no error of a mean of these scenes."""
    rng = np.random.default_rng(scenes)
    level = 10 * np.arange(scenes) - 5 * (scenes - 1)
    values = np.repeat(level, frames) + rng.normal(0, 1, (TRIALS, 1, scenes * frames))
    assert scenes < FEWEST_SCENES
    assert 0.93 <= coverage(values, np.repeat(np.arange(scenes), frames)) <= 0.97


def test_scenes_have_the_same_weight_and_the_interval_of_student():
    values, scenes = [1.0, 3.0, 4.0, 5.0, 6.0, 7.0], ["a", "a", "b", "c", "d", "e"]
    means = [2.0, 4.0, 5.0, 6.0, 7.0]
    exact = stats.ttest_1samp(means, 0)
    found = scenes_interval([values], np.array(scenes))
    assert found == pytest.approx((4.8, *exact.confidence_interval(0.95), exact.pvalue))


@pytest.mark.parametrize("common", [0.0, 0.3, 0.9])
@pytest.mark.parametrize("sizes", [[4, 4, 1, 1, 1, 1, 1], [4, 4, *[1] * 10]])
def test_layouts_of_one_generator_are_no_units_of_their_own(sizes, common):
    """As `windows` and `frames` have them; scenes as units would cover 74 to 95 %."""
    rng = np.random.default_rng(sum(sizes))
    kind = np.repeat(np.arange(len(sizes)), sizes)
    scenes = np.array(["abcdefghijkl"[k] + f"_{i}" * (sizes[k] > 1) for i, k in enumerate(kind)])
    shared = rng.normal(0, common**0.5, (TRIALS, 1, len(sizes)))[..., kind]
    values = shared + rng.normal(0, (1 - common) ** 0.5, (TRIALS, 1, len(kind)))
    assert 0.925 <= coverage(values, scenes) <= 0.97


def test_one_frame_says_nothing_of_others():
    assert scenes_interval([[2.0]], np.array(["a"])) == (2.0, -np.inf, np.inf, 1.0)


def test_two_objects_are_compared_as_welch_does():
    first, second = np.random.default_rng(3).normal(1, [[1.0]] * 12), np.arange(6.0)
    values = np.concatenate([first[:, 0], second])[None]
    groups = np.repeat([0, 1], [12, 6])
    found = two_way_interval(values, lambda v: v[:, :12].mean() - v[:, 12:].mean(), groups)
    exact = stats.ttest_ind(first[:, 0], second, equal_var=False)
    assert found[3] == pytest.approx(exact.pvalue)
    assert found[1:3] == pytest.approx(tuple(exact.confidence_interval(0.95)))


@pytest.mark.parametrize("views", [2, 5, 12])
def test_small_view_sets_are_covered_with_a_statistic_of_theirs(views):
    """Gains in dB of pooled errors over two view sets, which differ far more than their views."""
    rng = np.random.default_rng(views)
    groups, level = np.repeat([0, 1], views), np.repeat([1.0, 5.0], views)
    errors = level[:, None] * rng.lognormal([0.0, 0.1], 0.2, (600, 2 * views, 2))
    ends = [two_way_interval(some[None], _gain, groups)[1:3] for some in errors]
    truth = psnr_of(np.exp(0.0)) - psnr_of(np.exp(0.1))
    covered = np.mean([low <= truth <= high for low, high in ends])
    assert 0.93 <= covered <= 0.97  # 0.9 % by chance


def _gain(values):
    return psnr_of(values[..., 0].mean()) - psnr_of(values[..., 1].mean())


def test_differences_of_the_same_views_are_paired():
    rng = np.random.default_rng(9)
    views = rng.normal(0, 5, 200)
    a, b = views + 1 + rng.normal(0, 0.1, 200), views + rng.normal(0, 0.1, 200)
    difference, low, high = paired_difference(a, b, seed=1)
    half = 1.96 * (a - b).std() / np.sqrt(200)
    assert (difference, high - low) == pytest.approx(((a - b).mean(), 2 * half), rel=0.1)


def test_one_value_a_training_is_students():
    values = [2.0, 4.0, 6.0]
    mean, low, high, p = t_interval(values)
    exact = stats.ttest_1samp(values, 0)
    assert (mean, p) == pytest.approx((4.0, exact.pvalue))
    assert (low, high) == pytest.approx(tuple(exact.confidence_interval(0.95)))
    assert t_interval([3.0]) == (3.0, -np.inf, np.inf, 1.0)
    assert t_interval([0.0, 0.0])[3] == 1.0  # methods that are alike differ in nothing


def test_three_trainings_and_few_views_are_covered():
    # Means of trainings differ more than means of views: views alone cover 70 %.
    rng, hits, rejected, views_alone = np.random.default_rng(1), 0, 0, 0
    groups = np.arange(16) % 2
    for _ in range(300):
        effects = rng.normal(0, 0.6, (3, 1)), rng.normal(0, 1, 16), rng.normal(0, 0.5, (3, 16))
        values = sum(effects) + 10 * groups - 5
        _, low, high, p = two_way_interval(values, groups=groups)
        hits += low <= 0 <= high
        rejected += p < 0.05
        assert (p < 0.05) == (not low <= 0 <= high)
        _, low, high, _ = two_way_interval(values.mean(0)[None], groups=groups)
        views_alone += low <= 0 <= high
    assert 279 <= hits <= 291 and rejected == 300 - hits
    assert views_alone < 250


def test_places_of_groups_are_kept_so_that_two_scenes_can_be_compared():
    # Of the first scene 4 views about 10, of the second 6 about 3; no spread within.
    values = np.tile(np.repeat([10.0, 3.0], [4, 6]), (3, 1))
    groups = np.repeat(["a", "b"], [4, 6])

    def difference(some):
        return some[:, :4].mean() - some[:, 4:].mean()

    assert two_way_interval(values, difference, groups) == pytest.approx((7, 7, 7, 0))
    # A method against itself is never said to differ.
    assert two_way_interval(0 * values, difference, groups)[3] == 1.0
    # One training: the interval of its views alone.
    row = np.random.default_rng(4).normal(0, 1, 300)
    _, low, high, _ = two_way_interval(row[None])
    assert (low, high) == pytest.approx(mean_interval(row, seed=5)[1:], abs=0.02)
