"""Paths of results, with Snakemake's wildcards by default."""

from dataclasses import dataclass
from functools import cached_property, partialmethod

ALL = "all"
"""The group of frame sets other than views, whose groups are SCENE or SCENE.BATCH."""


@dataclass(frozen=True)
class Paths:
    """Paths of a run: below results/ and reports/.

    Scales other than the default, `desk`, have folders of their name there.
    """

    scale: str

    @cached_property
    def results(self) -> str:
        return "results" if self.scale == "desk" else f"results/{self.scale}"

    @cached_property
    def reports(self) -> str:
        return "reports" if self.scale == "desk" else f"reports/{self.scale}"

    def scene(self, file: str, scene: str = "{scene}") -> str:
        """`mesh.ply`, the prepared mesh; `mesh.json`, its description."""
        return f"{self.results}/scenes/{scene}/{file}"

    def rays(self, file: str, scene: str = "{scene}", sampling: str = "{sampling}") -> str:
        """`directions.npy`, `origins.000.npy`, `bounds.000.npy`, …, `rays.json`."""
        return f"{self.results}/rays/{scene}/{sampling}/{file}"

    def network(self, file: str, experiment: str = "{experiment}") -> str:
        """`weights.safetensors`, `loss.csv`, `training.json`, `network.onnx`, `network.json`."""
        return f"{self.results}/networks/{experiment}/{file}"

    def reference(self, scene: str = "{scene}", batch: str = "{batch}") -> str:
        """G-buffers and exact visibility of a batch of viewpoints."""
        return f"{self.results}/references/{scene}/{batch}.safetensors"

    def evaluation(
        self,
        ending: str,
        frame_set: str = "{frame_set}",
        method: str = "{method}",
        group: str = "{group}",
    ) -> str:
        """`csv`, metrics of a method on test frames; `npz`, visibilities."""
        return f"{self.results}/evaluations/{frame_set}/{group}/{method}.{ending}"

    def constants(
        self, frame_set: str = "{frame_set}", method: str = "{method}", group: str = "{group}"
    ) -> str:
        """Best constants of a method on validation frames."""
        return f"{self.results}/constants/{frame_set}/{group}/{method}.json"

    def times(self, table: str = "{table}", group: str = "{group}") -> str:
        """Times of a table's methods on a group of frames."""
        return f"{self.results}/times/{table}/{group}.json"

    def sun_hours(self, ending: str, table: str = "{table}", scene: str = "{scene}") -> str:
        """`json`, times and errors of a table's scene; `npz`, its picture."""
        return f"{self.results}/sun_hours/{table}/{scene}.{ending}"

    def frame_measure(self, measure: str = "{measure}", frame_set: str = "{frame_set}") -> str:
        """`widths.json`, `occluders.npy` of all test frames."""
        return f"{self.results}/frame_measures/{frame_set}/{measure}"

    def violations(
        self, scene: str = "{scene}", method: str = "{method}", batch: str = "{batch}"
    ) -> str:
        """Counts of labels' bounds that a network violates in a batch."""
        return f"{self.results}/violations/{scene}/{method}.{batch}.csv"

    def frames(
        self,
        ending: str,
        scene: str = "{scene}",
        frame_set: str = "{frame_set}",
        part: str = "{part}",
        folder: str = "frames",
    ) -> str:
        """`json`, `buffers.npy`, `targets.npy`, `valid.npy`, `edges.npy`, `rays.npy` of a part."""
        return f"{self.results}/{folder}/{frame_set}/{scene}/{part}.{ending}"

    imported_frames = partialmethod(frames, folder="imported_frames")  # of an engine

    def soft_fields(self, frame_set: str = "{frame_set}") -> str:
        """Signed-distance fields of the objects in a frame set's scenes."""
        return f"{self.results}/soft_fields/{frame_set}.npz"

    def screen_sensitivity(
        self, frame_set: str = "{frame_set}", experiment: str = "{experiment}"
    ) -> str:
        """Sensitivity of a screen-space network to each input feature."""
        return f"{self.results}/screen_sensitivities/{frame_set}/{experiment}.json"

    def screen_profile(self, network: str = "{network}") -> str:
        """Times of a screen-space network by level and part."""
        return f"{self.results}/screen_profiles/{network}.json"

    @cached_property
    def lpips(self) -> str:
        """Availability of LPIPS."""
        return f"{self.results}/lpips.json"

    @cached_property
    def lpips_model(self) -> str:
        """LPIPS as ONNX, empty where it is not available."""
        return f"{self.results}/lpips.onnx"

    @cached_property
    def logs(self) -> str:
        """Folder of all logs."""
        return f"{self.results}/logs"

    def log(self, rule: str, *wildcards: str) -> str:
        """Log of a rule's job."""
        return f"{self.logs}/{rule}/{_of(rule, wildcards)}.log"

    @cached_property
    def benchmarks(self) -> str:
        """Folder of all benchmarks."""
        return f"{self.results}/benchmarks"

    def benchmark(self, rule: str, *wildcards: str) -> str:
        """Seconds and memory of a rule's job."""
        return f"{self.benchmarks}/{rule}/{_of(rule, wildcards)}.tsv"

    def report(self, name: str) -> str:
        """A table, a figure, or the page."""
        return f"{self.reports}/{name}"


def _of(rule: str, wildcards: tuple[str, ...]) -> str:
    return ".".join(f"{{{name}}}" for name in wildcards) or rule
