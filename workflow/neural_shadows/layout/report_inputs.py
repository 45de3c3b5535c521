"""Files and settings of tables and figures, by argument of their functions."""

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Any

from neural_shadows.evaluation.registry import UNLEARNED, available, is_network
from neural_shadows.layout import frame_methods, frame_sets, tables
from neural_shadows.layout.layout import Layout
from neural_shadows.layout.paths import ALL


@dataclass(frozen=True)
class Report:
    """A table or a figure, with its entry in the settings."""

    layout: Layout
    name: str
    settings: Mapping[str, Any]

    @property
    def table(self) -> str:
        """Name of the table, of a figure that of its table."""
        return self.settings.get("table", self.name)

    @property
    def rows(self) -> list[tables.Row]:
        """Rows of methods for hard shadows."""
        return self.settings.get("rows", [])

    @property
    def experiments(self) -> list[str]:
        """Experiments on rays, each once."""
        own = [self.settings["experiment"]] if "experiment" in self.settings else []
        return own or tables.experiments_of(self.rows)

    @property
    def scenes(self) -> list[str]:
        """Scenes of the report or of its rows, each once."""
        if scene := self.settings.get("scene"):
            return [scene]
        if "scenes" in self.settings:
            return self.settings["scenes"]
        if "experiment" in self.settings:
            return [self.layout.entry("experiments", self.settings["experiment"])["scene"]]
        return tables.unique(row["scene"] for row in self.rows)

    @property
    def frame_set(self) -> str:
        """Frame set, of a figure that of its table."""
        return self.settings.get("frame_set") or tables.frame_set(self.layout, self.table)

    @property
    def methods(self) -> list[str]:
        """Methods for soft shadows available on this machine, each once."""
        settings = self.settings
        keys = settings.get("networks") or settings.get("columns", {}).values()
        rows = keys or settings.get("methods", [])
        names = (row if isinstance(row, str) else row["method"] for row in rows)
        return tables.unique(filter(available, names))

    def mesh(self, file: str) -> list[str]:
        """A file of the mesh of each scene."""
        return [self.layout.paths.scene(file, scene) for scene in self.scenes]

    def network(self, file: str) -> list[str]:
        """A file of each network on rays."""
        return [self.layout.paths.network(file, name) for name in self.experiments]

    def evaluated(self, ending: str, methods: list[str]) -> list[str]:
        """An evaluation file of methods for soft shadows."""
        path = self.layout.paths.evaluation
        return [path(ending, self.frame_set, method, ALL) for method in methods]

    def labels(self) -> dict[str, str]:
        """Labels of the methods for soft shadows."""
        return {
            method: frame_methods.label(self.layout, method, self.frame_set)
            for method in self.methods
        }

    def screen_trainings(self) -> list[str]:
        """training.json files of the screen-space networks."""
        names = [
            name
            for method in filter(is_network, self.methods)
            for name in frame_methods.experiments(self.layout, method)
        ]
        return [self.layout.paths.network("training.json", name) for name in names]


def _source(name: str) -> Callable[[Report], str]:
    return lambda report: report.layout.source(f"config/{name}.csv")


# Of methods on rays and in light maps, by the report's `rows`, `scene` or `experiment`.
FILES: dict[str, Callable[[Report], Any]] = {
    "metrics": lambda report: tables.evaluations(report.layout, report.rows, "csv"),
    "visibilities": lambda report: tables.evaluations(report.layout, report.rows, "npz"),
    "references": lambda report: tables.references(report.layout, report.scenes),
    "depth_biases": lambda report: tables.depth_biases(report.layout, report.rows),
    "weights": lambda report: report.network("weights.safetensors"),
    "trainings": lambda report: report.network("training.json"),
    "meshes": lambda report: report.mesh("mesh.json"),
    "mesh_json": lambda report: report.mesh("mesh.json")[0],
    "mesh_ply": lambda report: report.mesh("mesh.ply")[0],
    "times": lambda report: [
        report.layout.paths.times(report.name, scene) for scene in report.scenes
    ],
    "lpips_json": lambda report: report.layout.paths.lpips,
    "published_csv": _source("published"),
    "published_nsm_csv": _source("published_nsm"),
    "published_kpnsm_csv": _source("published_kpnsm"),
    "table_csv": lambda report: report.layout.paths.report(f"{report.table}.csv"),
}
# Of methods for soft shadows, by its `methods`, `networks` or `columns`, and `frame_set`.
FILES |= {
    "soft_metrics": lambda report: report.evaluated("csv", report.methods),
    "null_metrics": lambda report: report.evaluated(
        "csv", [null for null in UNLEARNED if null not in report.methods]
    ),
    "soft_answers": lambda report: report.evaluated("npz", report.methods),
    "soft_times": lambda report: tables.times(report.layout, report.name),
    "soft_constants": lambda report: tables.constants(report.layout, report.name),
    "screen_trainings": Report.screen_trainings,
    "sensitivities": lambda report: [
        report.layout.paths.screen_sensitivity(report.frame_set, method)
        for method in report.methods
    ],
    "profile_json": lambda report: report.layout.paths.screen_profile(report.settings["network"]),
    "widths_json": lambda report: tables.widths(report.layout, report.frame_set),
    "frames_json": lambda report: frame_sets.tests(report.layout, report.frame_set)[0],
    "test_parts": lambda report: frame_sets.tests(report.layout, report.frame_set),
    "first_parts": lambda report: frame_sets.first_tests(report.layout, report.frame_set),
    "sequences": lambda report: frame_sets.sequences(report.layout, report.frame_set),
    "soft_meshes": lambda report: frame_sets.all_meshes(report.layout, report.frame_set),
}

# All others are settings of the entry.
PARAMS: dict[str, Callable[[Report], Any]] = {
    "run": lambda report: report.layout.run(),
    "seed": lambda report: report.layout.settings["seed"],
    "scene": lambda report: report.layout.entry("scenes", report.scenes[0])["scene"],
    "scenes": lambda report: report.layout.scenes(report.scenes),
    "scene_seed": lambda report: report.layout.entry("scenes", report.scenes[0])["seed"],
    "sampling": lambda report: report.layout.entry("samplings", report.settings["sampling"]),
    "device": lambda report: report.layout.settings["compute"]["device"],
    "precision": lambda report: report.layout.settings["compute"]["precision"],
    "labels": Report.labels,
}
