"""Sentences of several reports; the page shows equal notes once."""

from collections.abc import Mapping, Sequence

import pandas as pd

from neural_shadows.reports.data.digits import short
from neural_shadows.settings.records import (
    DepthBias,
    FrameTimes,
    Lpips,
    MeshReport,
    Row,
    Run,
    SceneInfo,
    TrainingRecord,
)

AT_END = "at an end of the range tried: a better one may lie beyond it"
TEXTS = {"nsm": "Datta et al. 2022", "kpnsm": "Hu et al. 2025"}


def titled(title: str, published: str | None, mesh: MeshReport | None = None) -> str:
    """A table's heading with its mesh and its number in the text.

    Args:
        published: `4.3` of the thesis, `nsm.s2` or `kpnsm.1`; None for a table of our own.
        mesh: mesh.json; None for a table of several meshes or of none.
    """
    if mesh is not None and mesh["name"] not in title:
        title += f", mesh {mesh['name']}"
    if published is None:
        return title
    same = mesh is None or mesh["thesis_mesh"]
    paper, _, number = published.rpartition(".")
    source = (
        f"{number.upper()} of {TEXTS[paper]}" if paper in TEXTS else f"{published} of the thesis"
    )
    return f"{title} ({'' if same else 'after '}table {source})"


def section_of(claim: Mapping[str, str]) -> str:
    """A claim's text and section; of the thesis the number alone."""
    if claim["text"] == "own":
        return "ours"
    return f"{TEXTS.get(claim['text'], '')} {claim['section']}".strip()


def describe_run(run: Run) -> str:
    """Describe the scale, without a date: equal runs give equal bytes."""
    return f"Scale: {run['scale']}."


def describe_frames(run: Run) -> str:
    """Describe the measured frames and their reference."""
    shadow_map = "a 32768² shadow map, as in the thesis"
    reference = "an exact shadow ray per pixel" if run["reference"] == "exact" else shadow_map
    return f"Frames of {run['width']} × {run['height']}; reference: {reference}."


def is_own_mesh(mesh: MeshReport, scene: SceneInfo) -> bool:
    """Test for the thesis's own mesh.

    `thesis_mesh` is true also of procedural meshes made to its description: its numbers may stand
    beside them.
    """
    return mesh["thesis_mesh"] and not scene["procedural"]


def describe_mesh(mesh: MeshReport, scene: SceneInfo) -> str:
    """Describe a mesh: name, origin, size, watertight or not."""
    made = "generated, " if scene["procedural"] else ""
    kind = "" if is_own_mesh(mesh, scene) else f" ({made}not the thesis's mesh)"
    closed = "watertight" if mesh["watertight"] else "not watertight"
    return f"{mesh['name']}{kind}, {mesh['faces']:,} triangles, {closed}"


def describe_scene(name: str, mesh: MeshReport, scene: SceneInfo) -> str:
    """Describe a scene's mesh and the seed of its viewpoints."""
    least = scene["least_shadow"]
    rule = f", views with shadow on {least:.0%} of their pixels or more (ours)" if least else ""
    return f"Mesh of {name}: {describe_mesh(mesh, scene)}; seed {scene['seed']}{rule}."


def describe_shadows(scene: str, leaks: pd.DataFrame) -> str:
    """Describe the share of points in cast shadow.

    `leaks`: light leak of no shadow, a row a view, with its `view_set` in the index, and one column.
    """
    shares = leaks.groupby("view_set").mean().iloc[:, 0]
    sets = ", ".join(f"{100 * share:.2g} % in {name} views" for name, share in shares.items())
    return f"Cast shadow on {scene}, of visible points: {sets}."


def describe_training(record: TrainingRecord) -> str:
    """Describe the training or building of a network, and its machine."""
    training, machine, threads = record["training"], record["machine"], record["threads"]
    device = f"{machine['cpu']} CPU"
    training_text = "built without training"
    if training:
        device = machine["gpu"] if training["device"] == "cuda" else device
        training_text = (
            f"{training['steps']:,} steps of {training['batch_size']:,} samples "
            f"({training['optimiser'].capitalize()}, {training['schedule']} learning rate "
            f"{training['learning_rate']:g}, {training['precision']})"
        )
    step = record.get("died_at_step")
    end = "" if step is None else f" It diverged at step {step:,}, and is shown as of that step."
    return (
        f"Network {record['name']}: {record['parameters']:,} parameters, {training_text} in "
        f"{record['seconds']:.0f} s on {device}, {_threads(threads)}.{end}"
    )


def describe_budgets(records: Sequence[TrainingRecord]) -> list[str]:
    """Describe the training data of each kind of network beside others."""
    trained = [record for record in records if record["training"]]
    kinds = {record["network"]["encoding"] for record in trained}
    if not {"frequency", "occupancy_field"} <= kinds:
        return []
    samples = {
        kind: max(rec["samples"] for rec in trained if rec["network"]["encoding"] == kind) / 1e6
        for kind in kinds
    }
    return [
        "The networks of a scene learn from the same labelled rays, but not from the same data: a "
        "field also takes surface bricks, solid bricks and the normals of sheets from the mesh; "
        f"it trains on up to {short(samples['occupancy_field'])} M samples of 8 "
        f"points each, the thesis's network on {short(samples['frequency'])} M."
    ]


def describe_samples(seen: float, theirs: float) -> str:
    """Compare a run's training samples a network with the thesis's."""
    return (
        f"The thesis's networks saw at most {seen:,.0f} training samples each in this run, and "
        f"{theirs:,.0f} in the thesis: {theirs / seen:,.0f} times as many."
    )


def describe_printed(scenes: Sequence[str]) -> list[str]:
    """Describe rows of the thesis's own values; nothing without `scenes`."""
    if not scenes:
        return []
    return [
        "as printed: by the thesis, with its own views, machine and LPIPS network; its equal map is "
        "of its own shadow maps."
    ]


def describe_devices(devices: Sequence[str]) -> list[str]:
    """Warn of times of several devices."""
    if len(devices) < 2:
        return []
    return [
        f"**Not comparable**: some methods ran on {devices[0]}, others on {devices[1]}; compare "
        "times of one device only."
    ]


def describe_times(times: FrameTimes) -> str:
    """Describe the measurement of a scene's frame times."""
    machine, ran = times["machine"], {one["device"] for one in times["methods"].values()}
    where = {"cpu": f"one thread of {machine['cpu']}", "cuda": machine["gpu"]}
    return (
        f"Times of {times['scene']}: {times['repeats']} frames of {times['width']} × "
        f"{times['height']} from {times['views']} viewpoints after {times['warm_up']} to warm up, "
        f"on {' and '.join(where[device] for device in sorted(ran))}, networks in "
        f"{times['precision']}; a network evaluates {times['sphere_rays']:,.0f} rays a frame."
    )


def describe_biases(rows: Sequence[Row], biases: Mapping[tuple[str, str], DepthBias]) -> list[str]:
    """Describe the depth biases of rows; `biases`: of `read_biases`."""
    sentences = []
    for row in rows:
        bias = biases.get((row["scene"], row["method"]), {"depth_bias": 0})
        if row["bias"] == "held_out" or bias["depth_bias"]:
            push = f", its surface pushed out by {bias['push']:g} cells" if bias["push"] else ""
            sentences.append(
                f"{row['label']}: a depth bias of {bias['depth_bias']:g} sphere radii{push}"
                + (", the best on held-out views" if row["bias"] == "held_out" else "")
                + (f" ({AT_END})." if bias["at_end"] else ".")
            )
    return sentences


def describe_lpips(lpips: Lpips, beside_flip: bool = True) -> str:
    """Describe LPIPS's network, or how to install a missing one; `beside_flip`: the table has FLIP, too."""
    if lpips["available"]:
        return (
            f"LPIPS's network is `{lpips['net']}`; the thesis does not name its own, and values of "
            "different networks cannot be compared."
        )
    instead = "; FLIP takes its place" if beside_flip else ""
    return (
        f"LPIPS is missing (`lpips.json` among the results has the reason){instead}. Once it is "
        "installed, add `--forcerun find_lpips`."
    )


def _threads(count: int) -> str:
    return "1 thread" if count == 1 else f"up to {count} threads"
