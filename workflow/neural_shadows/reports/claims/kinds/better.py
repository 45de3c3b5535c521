"""Pairs (better, worse) of methods by metrics."""

from types import ModuleType
from typing import Any, Literal

from pydantic import Field

from neural_shadows.evaluation.registry import is_network
from neural_shadows.metrics.kinds import sequences
from neural_shadows.reports.claims import frames, losses, screen_networks, setting_types, views
from neural_shadows.reports.claims.measured import Claim
from neural_shadows.reports.data.frame_means import OFF_EDGES
from neural_shadows.reports.tables import soft_methods, soft_summary
from neural_shadows.sections.any_report import AnyClaim
from neural_shadows.sections.own_frames import OwnFrames
from neural_shadows.sections.sections import Sections
from neural_shadows.settings.base import Name, check_among

ALL_METRICS = dict.fromkeys([*views.METRICS, *losses.METRICS, *frames.METRICS])


class Settings(AnyClaim):
    """Methods with smaller errors than others, or networks with smaller losses.

    On scenes' viewpoints, or on the frames of a table of methods for soft shadows.
    """

    kind: Literal["better"] = Field(description="`better`")
    pairs: setting_types.Pairs = Field(
        description="methods, the claimed winner first: on viewpoints one of them a network, else "
        f"those of `table`; {' and '.join(f'`{rays}`' for rays in frames.EQUAL_TIME)}, plain and filtered, are "
        "those of the other's time: the claim must hold, or fail, with the most that take no longer and with "
        "the next larger number, whichever is worse, or better, for it"
    )
    metrics: setting_types.metrics(*ALL_METRICS) | None = Field(
        None,
        description="the claim must hold in all of them. On viewpoints `lpips` by default, "
        "or `loss` alone, the end of a training's; FLIP replaces LPIPS where its backbone is missing. "
        "Of `table` `mse_off_edges` by default, of pixels without edges of surfaces (the evidence "
        "names the verdict by `mse`, of all pixels, if it differs); `flip` and `lpips` are measured "
        "for the middle light alone, as all of sequences",
    )
    table: Name | None = Field(
        None, description="a table of `soft_methods` or `soft_summary` in `tables`"
    )
    radii: list[setting_types.Radius] | None = Field(
        None,
        min_length=1,
        description="of `table`: numbers of the frame set's radii, from 0; the claim must hold at all "
        "of them; without it the mean over all is compared",
    )
    over: Literal["all", "trained", "unseen"] = Field(
        "all",
        description="of `table`: which of its scenes count, all, those of the frame set's `scenes` or of its `unseen`",
    )
    again: setting_types.again(Name) = Field(
        {},
        description="of `table`: by network, one of `experiments` or of `networks_by_scene`, its counterparts "
        "trained from other seeds",
    )

    def check(self, config: Sections, key: str) -> None:
        metrics = self.resolved_metrics()
        units = source({"metrics": metrics, "table": self.table})
        for metric in metrics:
            check_among(f"{key}.metrics", metric, units.METRICS)
        if self.table:
            self._check_table(config, key)
        elif self.radii or self.again or self.over != "all":
            unused = "radii" if self.radii else "again" if self.again else "over"
            raise ValueError(f"{key}.{unused}: it needs `table`. Name one")
        else:
            units.check_methods(config, f"{key}.pairs", self.pairs)

    def _check_table(self, config: Sections, key: str) -> None:
        kinds, equal_time = [soft_methods.Settings, soft_summary.Settings], set()
        for pair in self.pairs:
            if {*pair} <= frames.EQUAL_TIME.keys():
                raise ValueError(
                    f"{key}.pairs: {pair} have no time to be equal to. Name a method as one of the two"
                )
            equal_time |= frames.EQUAL_TIME.keys() & {*pair}
        if equal_time:
            kinds = kinds[:1]  # have times by radius
        tables = [n for n, table in config.tables.items() if isinstance(table, tuple(kinds))]
        check_among(f"{key}.table", self.table, tables)
        if equal_time and not self.radii:
            raise ValueError(f"{key}.radii: `{min(equal_time)}` needs radii. List some")
        table = config.tables[self.table]
        frame_set = config.frame_sets[table.frame_set]
        if isinstance(frame_set, OwnFrames):
            raise ValueError(
                f"{key}.table: {self.table!r} is of a user's own frames. Choose another table"
            )
        for method in self._table_methods():
            check_among(f"{key}: {self.table}.methods", method, table.methods_shown())
        for method, others in self.again.items():
            check_among(f"{key}.again", method, [*filter(is_network, self._table_methods())])
            for other in others:
                networks = [*config.screen_experiments, *config.networks_by_scene]
                check_among(f"{key}.again.{method}", other, networks)
        if in_motion := [
            metric for metric in self.resolved_metrics() if metric in sequences.METRICS
        ]:
            middle = len(frame_set.radii) // 2
            if not frame_set.sequence or self.radii != [middle]:
                raise ValueError(
                    f"{key}.metrics: {in_motion[0]} is measured in sequences, by the middle light. Write "
                    f"`radii: [{middle}]`, and a `sequence` in frame_sets.{table.frame_set}"
                )
        if self.over == "unseen" and not frame_set.unseen:
            raise ValueError(f"{key}.over: {table.frame_set!r} has no unseen scenes. Choose `all`")
        for k in self.radii or ():
            if k >= len(frame_set.radii):
                raise ValueError(
                    f"{key}.radii: {k} is not below {len(frame_set.radii)}, the number of radii of "
                    f"{table.frame_set!r}"
                )
        screen_networks.check_seeds(config, key, [*self.again.items()])

    def resolved_metrics(self) -> list[str]:
        """The metrics, or the default one."""
        return self.metrics or [OFF_EDGES if self.table else "lpips"]

    def resolved(self, config: Sections) -> dict[str, Any]:
        """The settings with `rows` of `pairs`, or with `networks` and by network `bases`."""
        claim = self.model_dump() | {"metrics": self.resolved_metrics()}
        if not self.table:
            return claim | {"rows": [views.compared_rows(config, names) for names in self.pairs]}
        named = filter(is_network, self._table_methods())
        networks = screen_networks.all_seeds(config, named, [*self.again.items()])
        frame_set = config.frame_sets[config.tables[self.table].frame_set]
        scenes = {"trained": frame_set.scenes, "unseen": getattr(frame_set, "unseen", None)}.get(
            self.over
        )
        return claim | {
            "networks": networks,
            "bases": frames.bases(config, networks),
            "scenes": scenes,
        }

    def _table_methods(self) -> list[str]:
        """The methods of all pairs but rays of equal time."""
        return [m for pair in self.pairs for m in pair if m not in frames.EQUAL_TIME]


def source(claim: Claim) -> ModuleType:
    """The module of a claim's units: frames, trainings or views."""
    if claim.get("table"):
        return frames
    return losses if claim["metrics"] == [*losses.METRICS] else views
