"""Paths of results, with Snakemake's wildcards by default."""

from dataclasses import dataclass
from functools import cached_property


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
        self, ending: str, scene: str = "{scene}", method: str = "{method}", batch: str = "{batch}"
    ) -> str:
        """`csv`, metrics of a method on a batch; `npz`, visibilities."""
        return f"{self.results}/evaluations/{scene}/{method}.{batch}.{ending}"

    def answers(
        self, scene: str = "{scene}", method: str = "{method}", batch: str = "{batch}"
    ) -> str:
        """Predictions of a network for a batch."""
        return f"{self.results}/answers/{scene}/{method}.{batch}.npz"

    def depth_bias(self, scene: str = "{scene}", method: str = "{method}") -> str:
        """Held-out depth bias of a method on a scene."""
        return f"{self.results}/depth_biases/{scene}/{method}.json"

    def frame_times(self, table: str = "{table}", scene: str = "{scene}") -> str:
        """Times of a table's methods on a scene."""
        return f"{self.results}/frame_times/{table}/{scene}.json"

    def frames(
        self,
        ending: str,
        scene: str = "{scene}",
        frame_set: str = "{frame_set}",
        part: str = "{part}",
    ) -> str:
        """`json`, `buffers.npy`, `targets.npy`, `valid.npy`, `edges.npy` of a part."""
        return f"{self.results}/frames/{frame_set}/{scene}/{part}.{ending}"

    def imported_frames(
        self,
        ending: str,
        scene: str = "{scene}",
        frame_set: str = "{frame_set}",
        part: str = "{part}",
    ) -> str:
        """Files like `frames` for an engine's frame."""
        return f"{self.results}/imported_frames/{frame_set}/{scene}/{part}.{ending}"

    def soft_constants(self, frame_set: str = "{frame_set}", method: str = "{method}") -> str:
        """Best constants of a method on validation frames."""
        return f"{self.results}/soft_constants/{frame_set}/{method}.json"

    def soft_fields(self, frame_set: str = "{frame_set}") -> str:
        """Signed-distance fields of the objects in a frame set's scenes."""
        return f"{self.results}/soft_fields/{frame_set}.npz"

    def soft_evaluation(
        self, ending: str, frame_set: str = "{frame_set}", method: str = "{method}"
    ) -> str:
        """`csv`, errors of a method on test frames; `npz`, visibilities."""
        return f"{self.results}/soft_evaluations/{frame_set}/{method}.{ending}"

    def occluders(
        self, scene: str = "{scene}", frame_set: str = "{frame_set}", part: str = "{part}"
    ) -> str:
        """Occluders of the light in the frames of a part."""
        return f"{self.results}/occluders/{frame_set}/{scene}/{part}.npy"

    def penumbra_widths(self, frame_set: str = "{frame_set}") -> str:
        """Penumbra widths of a frame set's test frames."""
        return f"{self.results}/penumbra_widths/{frame_set}.json"

    def screen_sensitivity(
        self, frame_set: str = "{frame_set}", experiment: str = "{experiment}"
    ) -> str:
        """Sensitivity of a screen-space network to each input feature."""
        return f"{self.results}/screen_sensitivities/{frame_set}/{experiment}.json"

    def soft_times(self, table: str = "{table}") -> str:
        """Times of a table's methods for soft shadows."""
        return f"{self.results}/soft_times/{table}.json"

    def screen_network(self, file: str, experiment: str = "{experiment}") -> str:
        """`weights.safetensors`, `loss.csv`, `training.json` of a screen-space network."""
        return f"{self.results}/screen_networks/{experiment}/{file}"

    def screen_profile(self, network: str = "{network}") -> str:
        """Times of a screen-space network by level and part."""
        return f"{self.results}/screen_profiles/{network}.json"

    @cached_property
    def lpips(self) -> str:
        """Availability of LPIPS."""
        return f"{self.results}/lpips.json"

    def log(self, rule: str, *wildcards: str) -> str:
        """Log of a rule's job."""
        return f"{self.results}/logs/{rule}/{_of(rule, wildcards)}.log"

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
