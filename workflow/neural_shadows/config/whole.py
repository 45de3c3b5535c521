"""The typed configuration: what every key means, its unit and its range.

`python -m neural_shadows.config` prints the JSON schema made from it
(workflow/schemas/config.schema.json).
"""

from collections.abc import Iterable
from pathlib import Path
from typing import Annotated

from pydantic import Field, model_validator

from neural_shadows.config.base import Model, Name
from neural_shadows.config.claims import (
    BetterClaim,
    Claim,
    FrameTimeClaim,
    LowerLossClaim,
    MoreClaim,
)
from neural_shadows.config.compute import Compute
from neural_shadows.config.evaluations import Evaluation
from neural_shadows.config.experiments import Experiment
from neural_shadows.config.figures import (
    CostFigure,
    FieldSliceFigure,
    Figure,
    FrontsFigure,
    LossFigure,
    MethodFigure,
    PicturesFigure,
    WidthsFigure,
)
from neural_shadows.config.frame_times import FrameTimes
from neural_shadows.config.metrics import Metrics
from neural_shadows.config.networks import Network
from neural_shadows.config.rendering import Rendering
from neural_shadows.config.samplings import Sampling
from neural_shadows.config.scenes import (
    DownloadedMesh,
    GeneratedMesh,
    MeshFile,
    Scene,
    SingleAxisLight,
)
from neural_shadows.config.tables import (
    AnyTableKind,
    CostTable,
    FrameTimesTable,
    MemoryTable,
    NetworksTable,
    Table,
    TimedRow,
)
from neural_shadows.config.trainings import Training
from neural_shadows.evaluation.costs import STAGES
from neural_shadows.evaluation.method_names import (
    BIASED_SUFFIX,
    RAY_TRACED,
    SHADOW_MAP_PREFIX,
    biased_key,
    experiment_of,
    is_shadow_map,
    shadow_map_key,
)

# Folders below results/ and reports/, where an overlay's own folder of this name would mix with
# the default's files.
RESERVED_SCALES = {
    *("scenes", "rays", "networks", "evaluations", "frame_times", "cost"),
    *("logs", "benchmarks", "reference"),
}


class Config(Model):
    """The whole configuration."""

    scale: Name = Field(description="name of this configuration; overlays write below it")
    seed: int = Field(ge=0, lt=2**32, description="seed of everything that is drawn")
    dragon: str | None = Field(
        None,
        min_length=1,
        description="short for scenes.dragon.mesh: `wyrm`, `stanford`, or a mesh file",
    )
    compute: Compute = Field(Compute(), description="what the networks run on")
    scenes: dict[Name, Scene] = Field(description="meshes, how they stand and are lit, by name")
    samplings: dict[Name, Sampling] = Field(description="ways to draw training rays, by name")
    networks: dict[Name, Network] = Field(description="network shapes, by name")
    trainings: dict[Name, Training] = Field(description="optimiser settings, by name")
    experiments: dict[Name, Experiment] = Field(description="networks to train, by name")
    evaluations: dict[Name, Evaluation] = Field(description="comparisons to render, by name")
    rendering: Rendering = Field(description="frames and viewpoints of all evaluations")
    metrics: Metrics = Field(Metrics(), description="settings of the image metrics")
    frame_times: FrameTimes = Field(FrameTimes(), description="how frame times are measured")
    tables: dict[Name, AnyTableKind] = Field(
        description="tables to write, by name: of the thesis's, `table_` and its number"
    )
    figures: dict[Annotated[str, Field(pattern=r"^figure_[a-z0-9_]+$")], Figure] = Field(
        {}, description="figures to draw, by name: `figure_` and the thesis's number"
    )
    claims: dict[Name, Claim] = Field({}, description="what the thesis concludes, by name")

    @model_validator(mode="after")
    def _check_names(self):
        def known(section: str, name: str, key: str) -> None:
            if name not in getattr(self, section):
                raise ValueError(
                    f"{key}: no such name in `{section}`: {name!r}; "
                    f"allowed: {', '.join(sorted(getattr(self, section)))}"
                )

        for name in self.tables:
            if name in ("claims", "index"):
                raise ValueError(
                    f"tables.{name}: a report has this name; allowed: any other than claims, index"
                )
        if self.scale in RESERVED_SCALES:
            raise ValueError(
                f"scale = {self.scale!r}: is the name of a folder of results or reports; "
                f"allowed: any other than {', '.join(sorted(RESERVED_SCALES))}"
            )
        settings: dict[tuple[str, ...], str] = {}
        for name, experiment in self.experiments.items():
            if name in ("reference", RAY_TRACED) or name.startswith(SHADOW_MAP_PREFIX):
                raise ValueError(
                    f"experiments.{name}: tables and pictures have a method of this name; allowed: "
                    f"any other than 'reference', '{RAY_TRACED}' and '{SHADOW_MAP_PREFIX}…'"
                )
            if name.endswith(BIASED_SUFFIX):
                raise ValueError(
                    f"experiments.{name}: tables call a network with its depth bias so; allowed: a "
                    f"name that does not end in '{BIASED_SUFFIX}'"
                )
            for key in ("scene", "sampling", "network", "training"):
                known(f"{key}s", getattr(experiment, key), f"experiments.{name}.{key}")
            same = settings.setdefault(tuple(experiment.model_dump().values()), name)
            if same != name:
                raise ValueError(
                    f"experiments.{name}: is the same as experiments.{same}, and would train the "
                    "same network twice; use that one, or change a name or the seed"
                )
        for name, evaluation in self.evaluations.items():
            known("scenes", evaluation.scene, f"evaluations.{name}.scene")
            for network in evaluation.networks:
                known("experiments", network, f"evaluations.{name}.networks")
                scene = self.experiments[network].scene
                if scene != evaluation.scene:
                    raise ValueError(
                        f"evaluations.{name}.networks: {network!r} belongs to the scene {scene!r}, "
                        f"not to {evaluation.scene!r}"
                    )
            if not self.scenes[evaluation.scene].ground and "shadow" in evaluation.view_sets:
                raise ValueError(
                    f"evaluations.{name}.view_sets: 'shadow' needs a scene with ground: true; "
                    "allowed here: 'surface', 'centre'"
                )
        for name, table in self.tables.items():
            for evaluation in getattr(table, "evaluations", []):
                known("evaluations", evaluation, f"tables.{name}.evaluations")
            for figure in getattr(table, "figures", []):
                known("figures", figure, f"tables.{name}.figures")
            self._check_table(name, table)
        for name, figure in self.figures.items():
            match figure:
                case PicturesFigure() | WidthsFigure() | FrontsFigure() | CostFigure():
                    known("tables", figure.table, f"figures.{name}.table")
                    wanted = {
                        "pictures": ("comparison", "networks"),
                        "widths": ("frame_times",),
                        "fronts": ("networks",),
                        "cost": ("cost",),
                    }[figure.kind]
                    if self.tables[figure.table].kind not in wanted:
                        raise ValueError(
                            f"figures.{name}.table: {figure.table!r} is a table of "
                            f"{self.tables[figure.table].kind}; "
                            f"allowed: one of {' or '.join(wanted)}"
                        )
                    if not isinstance(figure, CostFigure):
                        self._check_figure_scene(name, figure)
                case FieldSliceFigure():
                    known("experiments", figure.experiment, f"figures.{name}.experiment")
                    network = self.experiments[figure.experiment].network
                    if self.networks[network].encoding != "occupancy_field":
                        raise ValueError(
                            f"figures.{name}.experiment: {figure.experiment!r} is a network of "
                            f"{self.networks[network].encoding}; allowed: one of occupancy_field"
                        )
                case LossFigure():
                    for curve in figure.curves:
                        known("experiments", curve.experiment, f"figures.{name}.curves")
                case MethodFigure():
                    known("scenes", figure.scene, f"figures.{name}.scene")
                    known("samplings", figure.sampling, f"figures.{name}.sampling")
            if isinstance(figure, PicturesFigure):
                rows = [row.method for row in self.tables[figure.table].rows]
                for method in figure.methods or []:
                    if method not in rows or method == RAY_TRACED:
                        raise ValueError(
                            f"figures.{name}.methods: {method!r} has no pictures in "
                            f"{figure.table}; allowed: "
                            f"{', '.join(row for row in rows if row != RAY_TRACED)}"
                        )
                rendered = next(
                    evaluation.view_sets
                    for evaluation in map(
                        self.evaluations.get, self.tables[figure.table].evaluations
                    )
                    if figure.scene in (None, evaluation.scene)
                )
                missing = [view_set for view_set in figure.view_sets if view_set not in rendered]
                if missing:
                    raise ValueError(
                        f"figures.{name}.view_sets: {missing[0]!r} is not rendered for "
                        f"{figure.table}; allowed: {', '.join(rendered)}"
                    )
        for name, claim in self.claims.items():
            self._check_claim(name, claim)
        for name, scene in self.scenes.items():
            if isinstance(scene.light, SingleAxisLight) and scene.light.axis == scene.up:
                raise ValueError(
                    f"scenes.{name}.light.axis = {scene.light.axis!r}: must be horizontal, not `up`; "
                    f"allowed: {', '.join(sorted({'x', 'y', 'z'} - {scene.up}))}"
                )
        return self

    def _check_figure_scene(
        self, name: str, figure: "PicturesFigure | WidthsFigure | FrontsFigure"
    ) -> None:
        table = self.tables[figure.table]
        scene = getattr(figure, "scene", None)
        if table.kind == "networks":
            scenes = [self.evaluations[key].scene for key in table.evaluations]
            if scene not in scenes:
                raise ValueError(
                    f"figures.{name}.scene: {scene!r} is not in {figure.table}; "
                    f"allowed: {', '.join(dict.fromkeys(scenes))}"
                )
        elif scene is not None:
            raise ValueError(
                f"figures.{name}.scene: {figure.table!r} has one scene; leave `scene` out"
            )

    def _check_table(
        self, name: str, table: "Table | FrameTimesTable | NetworksTable | MemoryTable | CostTable"
    ) -> None:
        if isinstance(table, CostTable):
            self._check_sizes(name, table)
            return
        keys = [(row.method, getattr(row, "scene", None)) for row in table.rows]
        for key in keys:
            if keys.count(key) > 1:
                raise ValueError(f"tables.{name}.rows: {key[0]!r}: must name each method only once")
        match table:
            case Table():
                self._check_comparison(name, table)
            case FrameTimesTable() | NetworksTable():
                for row in table.rows:
                    self._check_timed_row(name, table, row)
                if isinstance(table, NetworksTable):
                    self._check_labels(name, table)
                    self._check_same_scene_views(f"tables.{name}.evaluations", table.evaluations)
            case MemoryTable():
                for row in table.rows:
                    if row.method not in self.experiments and not is_shadow_map(row.method):
                        raise ValueError(
                            f"tables.{name}.rows: no such method: {row.method!r}; "
                            f"allowed: shadow_map_N, {', '.join(self.experiments)}"
                        )

    def _check_sizes(self, name: str, table: CostTable) -> None:
        sizes = {key: getattr(table, key) for key in STAGES}
        for key, values in sizes.items():
            if values != sorted(set(values)):
                raise ValueError(f"tables.{name}.{key} = {values}: must grow from each to the next")
        if not any(sizes.values()):
            raise ValueError(f"tables.{name}: needs a size; give one of {', '.join(sizes)}")

    def _check_comparison(self, name: str, table: Table) -> None:
        first = self.evaluations[table.evaluations[0]]
        for evaluation in table.evaluations[1:]:
            for key in ("scene", "view_sets"):
                value, other = getattr(first, key), getattr(self.evaluations[evaluation], key)
                if value != other:
                    raise ValueError(
                        f"tables.{name}.evaluations: {table.evaluations[0]!r} and {evaluation!r} "
                        f"differ in `{key}`: {value!r} and {other!r}; allowed: the same"
                    )
        methods = self.methods(table.evaluations)
        twice = sorted({method for method in methods if methods.count(method) > 1})
        if twice:
            raise ValueError(
                f"tables.{name}.evaluations: {twice[0]!r} is in more than one of them; "
                "allowed: each method in one"
            )
        for row in table.rows:
            if row.method not in methods:
                raise ValueError(
                    f"tables.{name}.rows: no such method in the evaluations "
                    f"{', '.join(table.evaluations)}: {row.method!r}; allowed: {', '.join(methods)}"
                )

    def _check_timed_row(
        self, name: str, table: "FrameTimesTable | NetworksTable", row: TimedRow
    ) -> None:
        methods = self.methods(table.evaluations)
        networks = [method for method in methods if not is_shadow_map(method)]
        if row.method in networks:
            if row.scene is not None:
                raise ValueError(
                    f"tables.{name}.rows: {row.method!r} has its own scene; leave `scene` out"
                )
        elif row.method == RAY_TRACED or is_shadow_map(row.method):
            if row.scene not in self.scenes:
                raise ValueError(
                    f"tables.{name}.rows: {row.method!r} needs a `scene`, not {row.scene!r}; "
                    f"allowed: {', '.join(self.scenes)}"
                )
        else:
            raise ValueError(
                f"tables.{name}.rows: no such method: {row.method!r}; "
                f"allowed: {RAY_TRACED}, shadow_map_N, {', '.join(networks)}"
            )

    def _check_claim(
        self, name: str, claim: "BetterClaim | MoreClaim | LowerLossClaim | FrameTimeClaim"
    ) -> None:
        for evaluation in getattr(claim, "evaluations", []):
            if evaluation not in self.evaluations:
                raise ValueError(
                    f"claims.{name}.evaluations: no such name in `evaluations`: {evaluation!r}; "
                    f"allowed: {', '.join(self.evaluations)}"
                )
        match claim:
            case BetterClaim() | MoreClaim():
                allowed = self.methods(claim.evaluations)
            case LowerLossClaim():
                allowed = list(self.experiments)
            case FrameTimeClaim():
                table = self.tables.get(claim.table)
                if not isinstance(table, FrameTimesTable):
                    tables = [
                        key for key, value in self.tables.items() if value.kind == "frame_times"
                    ]
                    raise ValueError(
                        f"claims.{name}.table: {claim.table!r} is no table of frame_times; "
                        f"allowed: {', '.join(tables)}"
                    )
                allowed = [row.method for row in table.rows]
        named = getattr(claim, "methods", None) or [m for pair in claim.pairs for m in pair]
        for method in named:
            if method not in allowed:
                raise ValueError(
                    f"claims.{name}: no such method: {method!r}; allowed: {', '.join(allowed)}"
                )
            if isinstance(claim, BetterClaim | MoreClaim) and allowed.count(method) > 1:
                raise ValueError(
                    f"claims.{name}: {method!r} is in more than one of its evaluations; "
                    "allowed: each method in one"
                )
        for first, second in getattr(claim, "pairs", []):
            if first == second:
                raise ValueError(
                    f"claims.{name}.pairs: {first!r} is compared with itself; allowed: two methods"
                )
        if isinstance(claim, BetterClaim):
            self._check_same_scene_views(f"claims.{name}.evaluations", claim.evaluations)
        if isinstance(claim, FrameTimeClaim):
            for first, second in claim.pairs:
                shared = self._timed_scenes(claim.table, first) & self._timed_scenes(
                    claim.table, second
                )
                if len(shared) != 1:
                    raise ValueError(
                        f"claims.{name}.pairs: {first!r} and {second!r} are timed together in "
                        f"{len(shared)} scenes; allowed: two methods of one scene"
                    )

    def _check_labels(self, name: str, table: NetworksTable) -> None:
        scenes = [
            self.experiments[experiment_of(row.method)].scene if row.scene is None else row.scene
            for row in table.rows
        ]
        labels = [(scene, row.label) for scene, row in zip(scenes, table.rows)]
        for scene, label in labels:
            if labels.count((scene, label)) > 1:
                raise ValueError(
                    f"tables.{name}.rows: {scene} has two rows with the label {label!r}; "
                    "allowed: one of each"
                )

    def _check_same_scene_views(self, key: str, evaluations: Iterable[str]) -> None:
        settings = {name: self.evaluations[name] for name in evaluations}
        for name, one in settings.items():
            for other_name, other in settings.items():
                if one.scene == other.scene and set(one.view_sets) != set(other.view_sets):
                    raise ValueError(
                        f"{key}: {name!r} and {other_name!r} differ in `view_sets`: "
                        f"{one.view_sets!r} and {other.view_sets!r}; "
                        "allowed: the same for one scene"
                    )

    def _timed_scenes(self, table: str, method: str) -> set[str]:
        return {
            self.experiments[experiment_of(method)].scene if row.scene is None else row.scene
            for row in self.tables[table].rows
            if row.method == method
        }

    def methods(self, evaluations: Iterable[str]) -> list[str]:
        """Keys of the methods of evaluations: of each its shadow maps, then its networks."""
        return [
            method
            for settings in (self.evaluations[name] for name in evaluations)
            for method in (
                *map(shadow_map_key, settings.shadow_maps),
                *self.network_methods(settings),
            )
        ]

    def network_methods(self, evaluation: Evaluation) -> list[str]:
        """Keys of the networks of an evaluation, which tell whether it seeks their depth bias."""
        if evaluation.depth_bias == "held_out":
            return [biased_key(name) for name in evaluation.networks]
        return list(evaluation.networks)

    def scene_seed(self, scene: str) -> int:
        """The seed of everything drawn for a scene."""
        own = self.scenes[scene].seed
        return self.seed if own is None else own

    def mesh_name(self, scene: str) -> str:
        """What a scene's mesh is called in tables: what it is, not what it stands for."""
        mesh = self.scenes[scene].mesh
        match mesh:
            case GeneratedMesh():
                return mesh.generate
            case DownloadedMesh():
                return mesh.download
            case MeshFile():
                name = Path(mesh.path).name.removesuffix(".gz")
                return Path(name).stem
