"""Where each result lies, and which part of the work each job does: all that rules look up."""

from collections.abc import Sequence
from typing import Any, get_args

from pydantic import BaseModel

from neural_shadows.config.figures import MethodFigure
from neural_shadows.config.frame_times import FrameTimes
from neural_shadows.config.rendering import Rendering
from neural_shadows.config.scenes import GeneratedMesh, MeshFile
from neural_shadows.config.whole import Config
from neural_shadows.evaluation.costs import STAGES
from neural_shadows.evaluation.method_names import (
    RAY_TRACED,
    experiment_of,
    is_shadow_map,
    resolution_of,
)

# A file name of each stage, in Snakemake's notation of wildcards.
SCENE = "scenes/{scene}"
RAYS = "rays/{scene}/{sampling}"
NETWORK = "networks/{experiment}"
EVALUATION = "evaluations/{evaluation}"
METHOD_FIGURES = get_args(MethodFigure.model_fields["kind"].annotation)
FRAME_TIMES = "frame_times/{table}/{scene}.json"
COST = "cost/{over}.{value}.json"


def part_range(total: int, parts: int, part: int) -> tuple[int, int]:
    """First and last (exclusive) of the `part`-th of `parts` nearly equal ranges of `total`."""
    return total * part // parts, total * (part + 1) // parts


def numbers(count: int) -> list[str]:
    """Names of numbered parts: 000, 001, …"""
    return [f"{part:03d}" for part in range(count)]


def one_of(names: Sequence[str]) -> str:
    """The regular expression of a wildcard that is one of `names`; nothing matches if none is."""
    return "|".join(names) or "(?!)"


def plain(value: Any) -> Any:
    """A config value as plain data, which Snakemake can compare between runs."""
    return value.model_dump() if isinstance(value, BaseModel) else value


class Layout:
    """Paths, parts and leaf parameters of one configuration, by the names in it.

    The default (`desk`) writes to results/ and reports/, overlays to a folder of their name
    in each.
    """

    def __init__(self, config: Config):
        self.config = config
        below = "" if config.scale == "desk" else f"/{config.scale}"
        self.results = f"results{below}"
        self.reports = f"reports{below}"

    def mesh_source(self, scene: str) -> str:
        """The file that a scene's mesh is read from: the user's own, or one that a rule makes."""
        mesh = self.config.scenes[scene].mesh
        if isinstance(mesh, MeshFile):
            return mesh.path
        made = "generated" if isinstance(mesh, GeneratedMesh) else "downloaded"
        return f"{self.results}/{SCENE.format(scene=scene)}/{made}.ply"

    def mesh(self, scene: str, ending: str) -> str:
        """The prepared mesh (`ply`) of a scene, or its description (`json`)."""
        return f"{self.results}/{SCENE.format(scene=scene)}/mesh.{ending}"

    def scene_param(self, scene: str, key: str) -> Any:
        """A value of a scene."""
        return plain(getattr(self.config.scenes[scene], key))

    def scene_frames(self, scene: str, size: Rendering | FrameTimes) -> dict[str, Any]:
        """How frames of a scene are drawn and rendered, as `open_scene` takes it."""
        return {
            **{key: self.scene_param(scene, key) for key in ("up", "ground", "light")},
            "width": size.width,
            "height": size.height,
            "seed": self.config.scene_seed(scene),
        }

    def ray_folder(self, scene: str, sampling: str) -> str:
        """The folder of a ray set."""
        return f"{self.results}/{RAYS.format(scene=scene, sampling=sampling)}"

    def ray_shards(self, scene: str, sampling: str, kind: str) -> list[str]:
        """The shards of a ray set: `origins` or `bounds`."""
        shards = numbers(self.config.samplings[sampling].shards)
        return [f"{self.ray_folder(scene, sampling)}/{kind}.{shard}.npy" for shard in shards]

    def shard_range(self, sampling: str, shard: str) -> tuple[int, int]:
        """First and last (exclusive) view direction of a shard."""
        settings = self.config.samplings[sampling]
        return part_range(settings.directions, settings.shards, int(shard))

    def training_rays(self, experiment: str) -> dict[str, Any]:
        """The ray set that an experiment trains on: `description`, `directions`, shards."""
        settings = self.config.experiments[experiment]
        names = settings.scene, settings.sampling
        return {
            "description": f"{self.ray_folder(*names)}/rays.json",
            "directions": f"{self.ray_folder(*names)}/directions.npy",
            "origins": self.ray_shards(*names, "origins"),
            "bounds": self.ray_shards(*names, "bounds"),
        }

    def training_mesh(self, experiment: str) -> list[str]:
        """The mesh that a training needs beside its rays, if its network does."""
        settings = self.config.experiments[experiment]
        needed = self.config.networks[settings.network].needs_mesh
        return [self.mesh(settings.scene, "ply")] if needed else []

    def network_settings(self, experiment: str) -> dict[str, Any]:
        """The settings of an experiment's network."""
        return plain(self.config.networks[self.config.experiments[experiment].network])

    def training_param(self, experiment: str, key: str) -> Any:
        """A value of an experiment's training."""
        training = self.config.trainings[self.config.experiments[experiment].training]
        return plain(getattr(training, key))

    def experiment_seed(self, experiment: str) -> int:
        """Seed of an experiment: its own, or its scene's."""
        settings = self.config.experiments[experiment]
        return self.config.scene_seed(settings.scene) if settings.seed is None else settings.seed

    def depth_biases(self, evaluation: str) -> list[str]:
        """The file of the depth biases that an evaluation uses, if it has them found."""
        if self.config.evaluations[evaluation].depth_bias != "held_out":
            return []
        return [f"{self.results}/{EVALUATION.format(evaluation=evaluation)}/depth_biases.json"]

    def export_evaluation(self, experiment: str) -> str | None:
        """The first evaluation of an experiment, whose depth bias its export names, if any."""
        evaluations = self.config.evaluations.items()
        return next((name for name, e in evaluations if experiment in e.networks), None)

    def export_biases(self, experiment: str) -> list[str]:
        """The file of the depth bias of an export, if it is one that was found."""
        evaluation = self.export_evaluation(experiment)
        return self.depth_biases(evaluation) if evaluation else []

    def export_bias(self, experiment: str) -> float:
        """The depth bias of an export where none was to be found."""
        evaluation = self.export_evaluation(experiment)
        given = self.config.evaluations[evaluation].depth_bias if evaluation else 0.0
        return 0.0 if given == "held_out" else given

    def given_biases(self, table: str) -> dict[str, float]:
        """The depth bias of each of a table's networks that has one given as a number."""
        evaluations = [self.config.evaluations[n] for n in self.config.tables[table].evaluations]
        return {
            name: evaluation.depth_bias
            for evaluation in evaluations
            if evaluation.depth_bias != "held_out"
            for name in evaluation.networks
        }

    def held_out_range(self) -> tuple[int, int]:
        """First and last (exclusive) viewpoint of a set that no evaluation renders."""
        rendering = self.config.rendering
        return rendering.views_per_set, rendering.views_per_set + rendering.held_out_views

    def networks(self, evaluation: str, file: str) -> list[str]:
        """A file (`weights.safetensors`, `training.json`) of each network of an evaluation."""
        names = self.config.evaluations[evaluation].networks
        return [self.network(name, file) for name in names]

    def network(self, experiment: str, file: str) -> str:
        """A file of a trained network: `weights.safetensors`, `loss.csv`, `training.json`."""
        return f"{self.results}/{NETWORK.format(experiment=experiment)}/{file}"

    def batches(self, evaluation: str, ending: str) -> list[str]:
        """Files of all batches: shadow.000, shadow.001, …, surface.000, …"""
        rendering = self.config.rendering
        count = -(-rendering.views_per_set // rendering.batch)
        return [
            f"{self.results}/{EVALUATION.format(evaluation=evaluation)}/{view_set}.{part}.{ending}"
            for view_set in self.config.evaluations[evaluation].view_sets
            for part in numbers(count)
        ]

    def view_range(self, batch: str) -> tuple[int, int]:
        """First and last (exclusive) viewpoint of a batch."""
        rendering = self.config.rendering
        first = int(batch) * rendering.batch
        return first, min(first + rendering.batch, rendering.views_per_set)

    def evaluation_scene(self, evaluation: str) -> str:
        """The scene that an evaluation renders."""
        return self.config.evaluations[evaluation].scene

    def table_batches(self, table: str, ending: str) -> list[str]:
        """Files of all batches of a table's evaluations."""
        names = self.config.tables[table].evaluations
        return [path for name in names for path in self.batches(name, ending)]

    def table_networks(self, table: str, scene: str | None = None) -> list[str]:
        """Methods of networks among a table's rows, or those of one scene."""
        methods = [row.method for row in self.config.tables[table].rows]
        return [
            method
            for method in methods
            if experiment_of(method) in self.config.experiments
            and scene in (None, self.config.experiments[experiment_of(method)].scene)
        ]

    def table_experiments(self, table: str, scene: str | None = None) -> list[str]:
        """The experiments of `table_networks`, each once."""
        return list(dict.fromkeys(map(experiment_of, self.table_networks(table, scene))))

    def table_files(self, table: str, file: str, scene: str | None = None) -> list[str]:
        """A file of each network that `table_networks` names, in its order."""
        return [
            self.network(experiment_of(method), file)
            for method in self.table_networks(table, scene)
        ]

    def table_trainings(self, table: str) -> list[str]:
        """The training record of each network among a table's rows, each once."""
        return list(dict.fromkeys(self.table_files(table, "training.json")))

    def table_biases(self, table: str) -> list[str]:
        """The files of depth biases of a table's evaluations."""
        names = self.config.tables[table].evaluations
        return [path for name in names for path in self.depth_biases(name)]

    def table_scene(self, table: str) -> str:
        """The scene that a comparison is about."""
        return self.evaluation_scene(self.config.tables[table].evaluations[0])

    def row_scenes(self, table: str) -> list[str]:
        """The scene of each row of a table of frame times."""
        return [
            self.config.experiments[experiment_of(row.method)].scene
            if row.scene is None
            else row.scene
            for row in self.config.tables[table].rows
        ]

    def frame_times(self, table: str) -> list[str]:
        """The files of a table's frame times, one a scene."""
        scenes = dict.fromkeys(self.row_scenes(table))
        return [
            f"{self.results}/{FRAME_TIMES.format(table=table, scene=scene)}" for scene in scenes
        ]

    def timed_shadow_maps(self, table: str, scene: str) -> list[int]:
        """Resolutions of the shadow maps that are timed on a scene for a table."""
        return [
            resolution_of(row.method)
            for row in self.config.tables[table].rows
            if is_shadow_map(row.method) and row.scene == scene
        ]

    def timed_view_sets(self, table: str, scene: str) -> list[str]:
        """The view sets whose viewpoints are timed: those of the table's evaluations, or all."""
        return next(
            (
                list(self.config.evaluations[name].view_sets)
                for name in self.config.tables[table].evaluations
                if self.evaluation_scene(name) == scene
            ),
            ["surface"],
        )

    def costs(self, table: str) -> list[str]:
        """The measurements of a table of costs, a file for each size."""
        settings = self.config.tables[table]
        return [
            f"{self.results}/{COST.format(over=over, value=value)}"
            for over in STAGES
            for value in getattr(settings, over)
        ]

    def batches_by_scene(self, table: str) -> dict[str, list[str]]:
        """Files of per-view metrics of a table's evaluations, by scene."""
        files: dict[str, list[str]] = {}
        for name in self.config.tables[table].evaluations:
            files.setdefault(self.evaluation_scene(name), []).extend(self.batches(name, "csv"))
        return files

    def memory_scene(self, table: str) -> str:
        """The scene whose shadow maps a table of memory measures: its first network's."""
        networks = self.table_networks(table)
        if not networks:
            return next(iter(self.config.scenes))
        return self.config.experiments[experiment_of(networks[0])].scene

    def table_scenes(self, table: str) -> list[str]:
        """The scenes of a table's rows, each once."""
        return list(dict.fromkeys(self.row_scenes(table)))

    def table_meshes(self, table: str) -> list[str]:
        """The description of the mesh of each of `table_scenes`."""
        return [self.mesh(scene, "json") for scene in self.table_scenes(table)]

    def figure_curves(self, figure: str) -> list[str]:
        """The loss curves of a figure."""
        curves = self.config.figures[figure].curves
        return [self.network(curve.experiment, "loss.csv") for curve in curves]

    def figure_table(self, figure: str) -> str:
        """The table that a figure draws."""
        return self.config.figures[figure].table

    def figure_sampling(self, figure: str) -> dict[str, Any]:
        """The sampling that a figure of the method shows."""
        return plain(self.config.samplings[self.config.figures[figure].sampling])

    def experiment_widths(self, figure: str) -> dict[str, int]:
        """Neurons per layer of the networks of a figure's table."""
        methods = self.table_networks(self.figure_table(figure))
        return {method: self.network_settings(experiment_of(method))["width"] for method in methods}

    def sampling_light(self, scene: str, sampling: str) -> dict[str, Any] | None:
        """The light domain that view directions are drawn from; None for the whole sphere."""
        match self.config.samplings[sampling].domain:
            case "light":
                return self.scene_param(scene, "light")
            case "hemisphere":
                return {"domain": "sphere", "min_elevation_deg": 0}
        return None

    def is_procedural(self, scene: str) -> bool:
        """Whether the pipeline makes a scene's mesh itself."""
        return isinstance(self.config.scenes[scene].mesh, GeneratedMesh)

    def table_rows(self, table: str) -> list[dict[str, Any]]:
        """The rows of a table as plain data."""
        return [plain(row) for row in self.config.tables[table].rows]

    def table_figures(self, table: str) -> list[str]:
        """The figures that are made beside a table."""
        return [f"{self.reports}/{name}.png" for name in self.config.tables[table].figures]

    def table_labels(self, table: str) -> dict[str, str]:
        """What Snakemake's report lists of a table: the thesis's number and the title."""
        settings = self.config.tables[table]
        return {"table": settings.published or table, "title": settings.title}

    def figure_labels(self, figure: str) -> dict[str, str]:
        """What Snakemake's report lists of a figure."""
        number = figure.removeprefix("figure_").replace("_", ".")
        return {"figure": number, "title": self.config.figures[figure].title}

    def tables_of(self, kind: str) -> list[str]:
        """Names of the tables of a kind."""
        return [name for name, table in self.config.tables.items() if table.kind == kind]

    def figures_of(self, *kinds: str) -> list[str]:
        """Names of the figures of some kinds."""
        return [name for name, figure in self.config.figures.items() if figure.kind in kinds]

    def first_batches(self, figure: str, ending: str) -> list[str]:
        """Files of the first batches of a figure's view sets; their first frames are shown."""
        settings = self.config.figures[figure]
        return [
            f"{self.results}/{EVALUATION.format(evaluation=evaluation)}/{view_set}.000.{ending}"
            for evaluation in self.config.tables[settings.table].evaluations
            if settings.scene in (None, self.evaluation_scene(evaluation))
            for view_set in settings.view_sets
        ]

    def figure_scene(self, figure: str) -> str:
        """The scene of a figure of pictures or of fronts."""
        settings = self.config.figures[figure]
        return settings.scene or self.table_scene(settings.table)

    def field_scene(self, figure: str) -> str:
        """The scene of a figure of an occupancy field."""
        return self.config.experiments[self.config.figures[figure].experiment].scene

    def figure_rows(self, figure: str) -> list[dict[str, Any]]:
        """The rows of a figure's table that are of its scene, and named by it if it names any."""
        table = self.figure_table(figure)
        rows = self.table_rows(table)
        if self.config.tables[table].kind == "networks":
            scene = self.figure_scene(figure)
            rows = [row for row, at in zip(rows, self.row_scenes(table)) if at == scene]
        named = getattr(self.config.figures[figure], "methods", None)
        return [row for row in rows if named is None or row["method"] in named]

    def picture_rows(self, figure: str) -> list[dict[str, Any]]:
        """The rows of a figure of pictures; ray tracing's is the reference, which is there anyway."""
        return [row for row in self.figure_rows(figure) if row["method"] != RAY_TRACED]

    def first_batches_by_scene(self, ending: str) -> dict[str, list[str]]:
        """Files of the first batches of all evaluations, by scene."""
        files: dict[str, list[str]] = {}
        for name in self.usual_evaluations():
            evaluation = self.config.evaluations[name]
            files.setdefault(evaluation.scene, []).extend(
                f"{self.results}/{EVALUATION.format(evaluation=name)}/{view_set}.000.{ending}"
                for view_set in evaluation.view_sets
            )
        return files

    def claim_batches(self) -> dict[str, list[str]]:
        """Files of per-view metrics by evaluation, of all evaluations that claims are about."""
        names = [
            name
            for claim in self.config.claims.values()
            for name in getattr(claim, "evaluations", [])
        ]
        return {name: self.batches(name, "csv") for name in dict.fromkeys(names)}

    def claim_experiments(self) -> list[str]:
        """The networks that claims are about, each once."""
        named = [
            method
            for claim in self.config.claims.values()
            for method in [*getattr(claim, "methods", []), *sum(getattr(claim, "pairs", []), [])]
        ]
        experiments = dict.fromkeys(map(experiment_of, named))
        return [name for name in experiments if name in self.config.experiments]

    def claim_losses(self) -> dict[str, str]:
        """The loss curve of each experiment whose loss a claim is about."""
        names = [
            name
            for claim in self.config.claims.values()
            if claim.kind == "lower_loss"
            for pair in claim.pairs
            for name in pair
        ]
        return {name: self.network(name, "loss.csv") for name in dict.fromkeys(names)}

    def claim_times(self) -> dict[str, list[str]]:
        """Files of frame times by table, of all tables that claims are about."""
        claims = self.config.claims.values()
        tables = [claim.table for claim in claims if claim.kind == "frame_time"]
        return {table: self.frame_times(table) for table in dict.fromkeys(tables)}

    def report_claims(self) -> list[str]:
        """The claims' Markdown, if there are claims."""
        return [f"{self.reports}/claims.md"] if self.config.claims else []

    def most_samples(self) -> int:
        """Samples of the longest training of a network that claims are about."""
        trainings = [
            self.config.trainings[self.config.experiments[name].training]
            for name in self.claim_experiments()
        ]
        return max(training.steps * training.batch_size for training in trainings)

    def usual_tables(self) -> list[str]:
        """Names of the tables that `rule all` makes and the page shows."""
        tables = self.config.tables.items()
        return [name for name, table in tables if not getattr(table, "on_request", False)]

    def usual_figures(self) -> list[str]:
        """Names of the figures that `rule all` makes and the page shows."""
        tables = self.usual_tables()
        return [
            name
            for name, figure in self.config.figures.items()
            if not hasattr(figure, "table") or figure.table in tables
        ]

    def beyond(self) -> list[str]:
        """Names of the tables and figures that are not the thesis's: those of other networks."""
        tables = self.tables_of("networks")
        return tables + [
            name
            for name, figure in self.config.figures.items()
            if figure.kind == "field_slice" or getattr(figure, "table", None) in tables
        ]

    def usual_evaluations(self) -> list[str]:
        """Names of the evaluations of those tables and of claims, or of no table at all."""
        tables = self.config.tables.items()
        usual, asked = (
            {
                evaluation
                for name, table in tables
                if getattr(table, "on_request", False) == on_request
                for evaluation in getattr(table, "evaluations", [])
            }
            for on_request in (False, True)
        )
        usual |= set(self.claim_batches())
        return [name for name in self.config.evaluations if name in usual or name not in asked]

    def usual_experiments(self) -> list[str]:
        """Names of the networks of `usual_evaluations` and `usual_figures`, each once."""
        figures = [self.config.figures[name] for name in self.usual_figures()]
        named = [
            *(n for e in self.usual_evaluations() for n in self.config.evaluations[e].networks),
            *(curve.experiment for figure in figures for curve in getattr(figure, "curves", [])),
            *(figure.experiment for figure in figures if hasattr(figure, "experiment")),
        ]
        return list(dict.fromkeys(named))

    def all_reports(self) -> list[str]:
        """Everything that `rule all` makes."""
        tables = [f"{name}{ending}" for name in self.usual_tables() for ending in (".csv", ".md")]
        figures = [
            f"{name}{ending}" for name in self.usual_figures() for ending in (".png", ".svg")
        ]
        previews = [f"scenes/{scene}.png" for scene in self.config.scenes]
        claims = ["claims.csv", "claims.md"] if self.config.claims else []
        names = tables + figures + previews + claims + ["index.html"]
        return [f"{self.reports}/{name}" for name in names]
