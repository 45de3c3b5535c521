"""Claims on trained screen-space networks from several seeds."""

from typing import Any

from neural_shadows.layout.layout import Layout
from neural_shadows.reports.claims.measured import Claim, trained_screen_networks
from neural_shadows.sections.any_report import AnyClaim
from neural_shadows.sections.sections import Sections


class NetworksClaim(AnyClaim):
    """A claim on trained screen-space networks.

    Its kind has `named_networks()` and `other_seeds(config)`, pairs of a network and its
    counterparts.
    """

    def all_networks(self, config: Sections) -> list[str]:
        """Its networks from all seeds, as experiments."""
        others = [name for _, names in self.other_seeds(config) for name in names]
        by_scene = config.networks_by_scene
        return [
            experiment
            for name in (*self.named_networks(), *others)
            for experiment in (by_scene[name].experiments if name in by_scene else [name])
        ]

    def check(self, config: Sections, key: str) -> None:
        for network, others in self.other_seeds(config):
            again_key, seeds = f"{key}.again.{network}", {}
            for name in others:
                if unlike := config.differences(network, name):
                    raise ValueError(
                        f"{again_key}: {name!r} has another {unlike[0]} than {network!r}. Let it "
                        "differ in `seed` and `label` alone"
                    )
            for name in (network, *others):
                seed = config.screen_seed_of(name)
                if seed in seeds:
                    raise ValueError(
                        f"{again_key}: {name!r} has the seed {seed} of {seeds[seed]!r}. Give each "
                        "its own"
                    )
                seeds[seed] = name

    def resolved(self, config: Sections) -> dict[str, Any]:
        return super().resolved(config) | {"networks": self.all_networks(config)}


def training_files(layout: Layout, claim: Claim) -> dict[str, list[str]]:
    """The training.json of each of a claim's networks."""
    names = trained_screen_networks(claim)
    paths = [layout.paths.screen_network("training.json", name) for name in names]
    return {"screen_trainings": paths}
