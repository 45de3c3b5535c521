"""Where each result lies, and which part of the work each job does: all that rules look up."""

from collections.abc import Sequence
from typing import Any

from pydantic import BaseModel

from neural_shadows.config import Config, GeneratedMesh, MeshFile

# A file name of each stage, in Snakemake's notation of wildcards.
SCENE = "scenes/{scene}"
RAYS = "rays/{scene}/{sampling}"
NETWORK = "networks/{experiment}"
EVALUATION = "evaluations/{evaluation}"


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

    def network_param(self, experiment: str, key: str) -> Any:
        """A value of an experiment's network."""
        return getattr(self.config.networks[self.config.experiments[experiment].network], key)

    def training_param(self, experiment: str, key: str) -> Any:
        """A value of an experiment's training."""
        return getattr(self.config.trainings[self.config.experiments[experiment].training], key)

    def experiment_seed(self, experiment: str) -> int:
        """Seed of an experiment: its scene's."""
        return self.config.scene_seed(self.config.experiments[experiment].scene)

    def networks(self, evaluation: str, file: str) -> list[str]:
        """A file (`weights.safetensors`, `training.json`) of each network of an evaluation."""
        names = self.config.evaluations[evaluation].networks
        return [f"{self.results}/{NETWORK.format(experiment=name)}/{file}" for name in names]

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

    def table_networks(self, table: str, file: str) -> list[str]:
        """A file of each network among a table's rows."""
        methods = [row.method for row in self.config.tables[table].rows]
        names = [name for name in methods if name in self.config.experiments]
        return [f"{self.results}/{NETWORK.format(experiment=name)}/{file}" for name in names]

    def table_scene(self, table: str) -> str:
        """The scene that a table is about."""
        return self.evaluation_scene(self.config.tables[table].evaluations[0])

    def sampling_light(self, scene: str, sampling: str) -> dict[str, Any] | None:
        """The light domain that view directions are drawn from; None for the whole sphere."""
        only_light = self.config.samplings[sampling].domain == "light"
        return self.scene_param(scene, "light") if only_light else None

    def is_procedural(self, scene: str) -> bool:
        """Whether the pipeline makes a scene's mesh itself."""
        return isinstance(self.config.scenes[scene].mesh, GeneratedMesh)

    def table_rows(self, table: str) -> list[dict[str, Any]]:
        """The rows of a table as plain data."""
        return [plain(row) for row in self.config.tables[table].rows]

    def table_figures(self, table: str) -> list[str]:
        """The figures that are made beside a table."""
        return [f"{self.reports}/{name}.png" for name in self.config.tables[table].figures]

    def tables_of(self, kind: str) -> list[str]:
        """Names of the tables of a kind."""
        return [name for name, table in self.config.tables.items() if table.kind == kind]

    def figures_of(self, *kinds: str) -> list[str]:
        """Names of the figures of some kinds."""
        return [name for name, figure in self.config.figures.items() if figure.kind in kinds]

    def pictures_table(self, figure: str) -> str:
        """The table whose rows a figure of pictures shows."""
        return self.config.figures[figure].table

    def first_batches(self, figure: str, ending: str) -> list[str]:
        """Files of the first batches of a figure's view sets; their first frames are shown."""
        settings = self.config.figures[figure]
        return [
            path
            for evaluation in self.config.tables[settings.table].evaluations
            for path in self.batches(evaluation, ending)
            for view_set in settings.view_sets
            if path.endswith(f"/{view_set}.000.{ending}")
        ]

    def all_reports(self) -> list[str]:
        """Everything that `rule all` makes."""
        tables = [f"{name}{ending}" for name in self.config.tables for ending in (".csv", ".md")]
        figures = [f"{name}{ending}" for name in self.config.figures for ending in (".png", ".svg")]
        previews = [f"scenes/{scene}.png" for scene in self.config.scenes]
        return [f"{self.reports}/{name}" for name in tables + figures + previews]
