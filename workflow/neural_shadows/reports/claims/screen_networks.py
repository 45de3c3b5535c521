"""Trained screen-space networks of claims, from several seeds."""

from collections.abc import Iterable, Iterator, Sequence

from neural_shadows.layout.layout import Layout
from neural_shadows.reports.claims.measured import Claim, Measured, trained_screen_networks
from neural_shadows.reports.data.digits import short
from neural_shadows.sections.sections import Sections

OtherSeeds = Sequence[tuple[str, Sequence[str]]]  # a network, and those from other seeds


def check_seeds(config: Sections, key: str, other_seeds: OtherSeeds) -> None:
    """Check that networks differ in their seed alone. Of one per scene each with its counterparts."""
    for network, others in _by_experiment(config, key, other_seeds):
        again_key, seeds = f"{key}.again.{network}", {}
        for name in others:
            if unlike := config.differences(network, name):
                raise ValueError(
                    f"{again_key}: {name!r} has another {unlike[0]} than {network!r}. Let it "
                    "differ in `seed` and `label` alone"
                )
        for name in (network, *others):
            seed = config.seed_of(name)
            if seed in seeds:
                raise ValueError(
                    f"{again_key}: {name!r} has the seed {seed} of {seeds[seed]!r}. Give each "
                    "its own"
                )
            seeds[seed] = name


def _by_experiment(
    config: Sections, key: str, other_seeds: OtherSeeds
) -> Iterator[tuple[str, Sequence[str]]]:
    for network, others in other_seeds:
        own, *counterparts = (_experiments(config, name) for name in (network, *others))
        for name, experiments in zip(others, counterparts):
            if len(experiments) != len(own):
                raise ValueError(
                    f"{key}.again.{network}: {name!r} has {len(experiments)} networks, not {len(own)}. List "
                    "one for each scene, in the same order"
                )
        for number, experiment in enumerate(own):
            yield experiment, [experiments[number] for experiments in counterparts]


def all_seeds(config: Sections, named: Iterable[str], other_seeds: OtherSeeds) -> list[str]:
    """Networks and those from other seeds, as experiments."""
    names = [*named, *(name for _, names in other_seeds for name in names)]
    return [experiment for name in names for experiment in _experiments(config, name)]


def _experiments(config: Sections, name: str) -> list[str]:
    by_scene = config.networks_by_scene
    return by_scene[name].experiments if name in by_scene else [name]


def files(layout: Layout, claim: Claim) -> dict[str, list[str]]:
    """The training.json of each of a claim's networks."""
    names = trained_screen_networks(claim)
    paths = [layout.paths.network("training.json", name) for name in names]
    return {"screen_trainings": paths}


def not_learned(claim: Claim, data: Measured) -> str:
    """Name the networks no better than null predictors.

    By the squared error on validation frames, over all lights of their training; the null predictors
    are no shadow, the hard map and their own base.
    """
    failures = (_failure(name, data) for name in trained_screen_networks(claim))
    return "; ".join(filter(None, failures))


def _failure(name: str, data: Measured) -> str:
    record = data.screen_trainings[name]
    if record["died_at_step"] is not None:
        return f"{name}: diverged at step {record['died_at_step']:,}"
    lights = record.get("training", {}).get("lights") or range(len(record["validation_mse"]))
    errors = [record["validation_mse"][light] for light in lights]
    nulls = record["null_mse"].items()
    nulls = {null: sum(by_light[light] for light in lights) for null, by_light in nulls}
    least = min(nulls, key=nulls.get)
    if None in errors:
        return f"{name}: its predictions are not finite"
    if sum(errors) < nulls[least]:
        return ""
    ours, theirs = (1e4 * total / len(errors) for total in (sum(errors), nulls[least]))
    return f"{name}: MSE {short(ours)} × 10⁻⁴ on validation frames, {least} {short(theirs)}"
