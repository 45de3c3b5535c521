"""Facts of a run: scale, meshes, hardware, versions, commits, durations."""

from collections.abc import Mapping, Sequence
from importlib.metadata import version
from pathlib import Path
from platform import python_version

from neural_shadows.files.whole_files import read_json
from neural_shadows.reports.data.inputs import by_folder, read_seconds
from neural_shadows.running.origin import CHECKOUT, commit_of
from neural_shadows.running.provenance import describe_hardware
from neural_shadows.settings.records import Run, SceneInfo, TrainingRecord

PACKAGES = ("snakemake", "torch", "embreex", "trimesh", "numpy", "lpips")


def run_facts(
    run: Run,
    meshes: Mapping[str, str],
    trainings: Sequence[Path],
    lpips_json: Path | None,
    benchmarks: Path,
) -> dict[str, str]:
    """Names and values of the facts, in the order to show them; `meshes`: a phrase on each."""
    records = [read_json(path) for path in trainings]
    facts = {"scale": run["scale"]}
    facts |= {f"mesh of {scene}": text for scene, text in meshes.items()}
    facts["frames"] = f"{run['width']} × {run['height']}"
    if records:
        facts["networks"] = _networks(records)
        facts["networks made on"] = "; ".join(
            dict.fromkeys(describe_hardware(record["machine"]) for record in records)
        )
        facts["networks made at"] = "; ".join(dict.fromkeys(record["commit"] for record in records))
    if lpips_json:
        lpips = read_json(lpips_json)
        facts["LPIPS"] = f"network {lpips['net']}" if lpips["available"] else "not available"
    facts["seed"] = str(run["seed"])
    packages = ", ".join(f"{package} {version(package)}" for package in PACKAGES)
    facts["versions"] = f"Python {python_version()}, {packages}"
    facts["page made at"] = commit_of(CHECKOUT)
    if spent := by_folder(sorted(benchmarks.glob("*/*.tsv"))):
        facts["durations"] = "; ".join(_duration(*rule) for rule in spent.items())
    return facts


def run_sentence(run: Run, scenes: Mapping[str, SceneInfo], facts: Mapping[str, str]) -> str:
    """Describe a run in one sentence; `facts`: of `run_facts`, `scenes`: those with a mesh."""
    if not scenes:
        return ""
    *first, last = dict.fromkeys(scene["mesh_name"] for scene in scenes.values())
    meshes = f"meshes {', '.join(first)} and {last}" if first else f"mesh {last}"
    networks = facts.get("networks", "").split(",")[0]
    methods = f"{networks} on rays beside shadow maps" if networks else "Shadows without a network"
    machines = facts.get("networks made on", "").replace("; ", " and on ")
    return (
        f"{methods}, on the {meshes} ({run['scale']} scale, frames of "
        f"{facts['frames']}){machines and f'; networks made on {machines}'}."
    )


def _networks(records: Sequence[TrainingRecord]) -> str:
    """Count trained networks, their samples, and networks built without training."""
    trained = [record for record in records if record["training"]]
    built = len(records) - len(trained)
    if not trained:
        return f"{_counted(built, 'network')}, built without training"
    samples = sorted({record["samples"] for record in trained})
    counts = " or ".join(f"{count:,}" for count in samples)
    text = f"{_counted(len(trained), 'network')}, {counts} samples each"
    return f"{text}; {built} more built without training" if built else text


def _duration(rule: str, jobs: Sequence[Path]) -> str:
    """Total time and number of a rule's jobs, from its benchmarks."""
    seconds = read_seconds(jobs)
    time = f"{seconds / 60:.0f} min" if seconds < 7200 else f"{seconds / 3600:.1f} h"
    time = f"{seconds:.0f} s" if seconds < 120 else time
    return f"{rule.replace('_', ' ')} {time} ({_counted(len(jobs), 'job')})"


def _counted(count: int, noun: str) -> str:
    return f"{count} {noun}{'s' if count != 1 else ''}"
