"""Sentences that several reports share, each worded once: equal notes are shown once on the page."""

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

AT_END = "the first or last that was tried: a better one may lie beyond"


def titled(title: str, published: str | None, mesh: MeshReport | None = None) -> str:
    """A table's heading: what it shows, on which mesh, and whether the thesis has the same.

    `mesh` is what `prepare_mesh` wrote; None for a table of several meshes or of none.
    """
    if mesh is not None and mesh["name"] not in title:
        title += f", mesh {mesh['name']}"
    if published is None:
        return title
    same = mesh is None or mesh["thesis_mesh"]
    return f"{title} ({'' if same else 'after '}table {published} of the thesis)"


TEXTS = {"nsm": "Datta et al. 2022", "kpnsm": "Hu et al. 2025"}


def section_of(claim: Mapping[str, str]) -> str:
    """The section that a claim's `text` draws it in; of the thesis the number alone."""
    if claim["text"] == "own":
        return "ours"
    return f"{TEXTS.get(claim['text'], '')} {claim['section']}".strip()


def describe_run(run: Run) -> str:
    """One sentence on the scale; no date, with which the same run would give other bytes."""
    return f"Scale: {run['scale']}."


def describe_frames(run: Run) -> str:
    """One sentence on the frames whose quality is measured."""
    shadow_map = "a 32768² shadow map, as in the thesis"
    reference = "an exact shadow ray per pixel" if run["reference"] == "exact" else shadow_map
    return f"Frames of {run['width']} × {run['height']}; reference: {reference}."


def is_own_mesh(mesh: MeshReport, scene: SceneInfo) -> bool:
    """Whether a scene has the thesis's own mesh, and none made to its description.

    Of the latter `thesis_mesh` is true, too: the thesis's numbers may stand beside it.
    """
    return mesh["thesis_mesh"] and not scene["procedural"]


def describe_mesh(mesh: MeshReport, scene: SceneInfo) -> str:
    """One phrase on a mesh: name, what it is, size, whether it is closed."""
    stand_in = "a procedural stand-in, " if scene["procedural"] else ""
    kind = "" if is_own_mesh(mesh, scene) else f" ({stand_in}not the thesis's mesh)"
    closed = "watertight" if mesh["watertight"] else "open"
    return f"{mesh['name']}{kind}, {mesh['faces']:,} triangles, {closed}"


def describe_scene(name: str, mesh: MeshReport, scene: SceneInfo) -> str:
    """One sentence on a scene's mesh and the seed of its viewpoints."""
    return f"Mesh of {name}: {describe_mesh(mesh, scene)}; seed {scene['seed']}."


def describe_shadows(scene: str, leaks: pd.DataFrame) -> str:
    """One sentence on how much there is to get wrong; `leaks`: the views' light leak of no shadow.

    `leaks` has a row a view, with its `view_set` in the index, and one column.
    """
    shares = leaks.groupby("view_set").mean().iloc[:, 0]
    sets = ", ".join(f"{100 * share:.2g} % in {name} views" for name, share in shares.items())
    return f"Cast shadow on {scene}, of the points that are seen: {sets}."


def describe_training(record: TrainingRecord) -> str:
    """One sentence on how a network was trained or built, and on what machine."""
    training, machine, threads = record["training"], record["machine"], record["threads"]
    device = f"{machine['cpu']} CPU"
    made = "built without training"
    if training:
        device = machine["gpu"] if training["device"] == "cuda" else device
        made = (
            f"{training['steps']:,} steps of {training['batch_size']:,} samples "
            f"({training['optimiser'].capitalize()}, {training['schedule']} learning rate "
            f"{training['learning_rate']:g}, {training['precision']})"
        )
    died = record.get("died_at_step")
    end = "" if died is None else f" It died at step {died:,}, and is shown as it was then."
    return (
        f"Network {record['name']}: {record['parameters']:,} parameters, {made} in "
        f"{record['seconds']:.0f} s on {device}, {_threads(threads)}.{end}"
    )


def describe_budgets(records: Sequence[TrainingRecord]) -> list[str]:
    """One sentence on what each kind of network learned from, where several kinds stand together."""
    trained = [record for record in records if record["training"]]
    kinds = {record["network"]["encoding"] for record in trained}
    if not {"frequency", "occupancy_field"} <= kinds:
        return []
    samples = {
        kind: max(one["samples"] for one in trained if one["network"]["encoding"] == kind) / 1e6
        for kind in kinds
    }
    return [
        "The networks of a scene learn from the same labelled rays, but not from the same data: a "
        "field also takes from the mesh which bricks hold a surface, which are solid, and the "
        f"normals of sheets; it trains on up to {short(samples['occupancy_field'])} M samples of 8 "
        f"points each, the thesis's network on {short(samples['frequency'])} M."
    ]


def describe_samples(seen: float, theirs: float) -> str:
    """One sentence on a run's training samples a network, beside the thesis's."""
    return (
        f"The thesis's networks saw at most {seen:,.0f} training samples each in this run, and "
        f"{theirs:,.0f} in the thesis: {theirs / seen:,.0f} times as many."
    )


def describe_printed(scenes: Sequence[str]) -> list[str]:
    """One sentence on rows of the thesis's own values, if there are some."""
    if not scenes:
        return []
    return [
        "as printed: by the thesis, with its own views, machine and LPIPS network; its equal map is "
        "of its own shadow maps."
    ]


def describe_devices(devices: Sequence[str]) -> list[str]:
    """One sentence where times do not compare, since methods ran on several devices."""
    if len(devices) < 2:
        return []
    return [
        f"**Not comparable**: some methods ran on {devices[0]}, others on {devices[1]}; compare "
        "times of one device only."
    ]


def describe_times(times: FrameTimes) -> str:
    """One sentence on how the frame times of a scene were measured."""
    machine, ran = times["machine"], {one["device"] for one in times["methods"].values()}
    where = {"cpu": f"one thread of {machine['cpu']}", "cuda": machine["gpu"]}
    return (
        f"Times of {times['scene']}: {times['repeats']} frames of {times['width']} × "
        f"{times['height']} from {times['views']} viewpoints after {times['warm_up']} to warm up, "
        f"on {' and '.join(where[device] for device in sorted(ran))}, networks in "
        f"{times['precision']}; a network answers {times['sphere_rays']:,.0f} rays a frame."
    )


def describe_biases(rows: Sequence[Row], biases: Mapping[tuple[str, str], DepthBias]) -> list[str]:
    """A sentence for each row that is given a depth bias; `biases` as `read_biases` gives them."""
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


def describe_lpips(lpips: Lpips) -> str:
    """One sentence on LPIPS's network, or on how to get it where it is missing."""
    if lpips["available"]:
        return (
            f"LPIPS's network is `{lpips['net']}`; the thesis does not name its own, and values of "
            "different networks cannot be compared."
        )
    return (
        "LPIPS is missing (`lpips.json` among the results says why), FLIP takes its place. Once "
        "solved, add `--forcerun find_lpips`."
    )


def _threads(count: int) -> str:
    return f"{count} thread{'s' if count > 1 else ''}"
