"""Sentences that several reports share, each worded once: equal notes are shown once on the page."""

import datetime
from collections.abc import Mapping, Sequence
from typing import Any


def titled(title: str, published: str | None, mesh: Mapping[str, Any] | None = None) -> str:
    """A table's heading: what it shows, on which mesh, and whether the thesis has the same.

    `mesh` is what `prepare_mesh` wrote; None for a table of several meshes or of none.
    """
    if mesh is not None and mesh["name"] not in title:
        title += f", mesh {mesh['name']}"
    if published is None:
        return title
    same = mesh is None or mesh["thesis_mesh"]
    return f"{title} ({'' if same else 'after '}table {published} of the thesis)"


def describe_run(run: Mapping[str, Any]) -> str:
    """One sentence on scale and date."""
    return f"Scale: {run['scale']}; made on {datetime.date.today().isoformat()}."


def describe_frames(run: Mapping[str, Any]) -> str:
    """One sentence on the frames whose quality is measured."""
    shadow_map = "a 32768² shadow map, as in the thesis"
    reference = "an exact shadow ray per pixel" if run["reference"] == "exact" else shadow_map
    return f"Frames of {run['width']} × {run['height']}; reference: {reference}."


def describe_mesh(mesh: Mapping[str, Any], scene: Mapping[str, Any]) -> str:
    """One phrase on a mesh: name, what it is, size, whether it is closed."""
    stand_in = "a procedural stand-in, " if scene["procedural"] else ""
    kind = "" if mesh["thesis_mesh"] else f" ({stand_in}not the thesis's mesh)"
    closed = "watertight" if mesh["watertight"] else "open"
    return f"{mesh['name']}{kind}, {mesh['faces']:,} triangles, {closed}"


def describe_scene(name: str, mesh: Mapping[str, Any], scene: Mapping[str, Any]) -> str:
    """One sentence on a scene's mesh and the seed of its viewpoints."""
    return f"Mesh of {name}: {describe_mesh(mesh, scene)}; seed {scene['seed']}."


def describe_training(record: Mapping[str, Any]) -> str:
    """One sentence on how a network was trained, and on what machine."""
    training, machine, threads = record["training"], record["machine"], record["threads"]
    device = machine["gpu"] if training["device"] == "cuda" else f"{machine['cpu']} CPU"
    return (
        f"Network {record['name']}: {record['parameters']:,} parameters, {training['steps']:,} "
        f"steps of {training['batch_size']:,} samples ({training['schedule']} learning rate "
        f"{training['learning_rate']:g}, {training['precision']}) in {record['seconds']:.0f} s on "
        f"{device}, {threads} thread{'s' if threads > 1 else ''}."
    )


def describe_times(times: Mapping[str, Any]) -> str:
    """One sentence on how the frame times of a scene were measured."""
    machine = times["machine"]
    device = machine["gpu"] if times["device"] == "cuda" else "the same thread"
    return (
        f"Times of {times['scene']}: {times['repeats']} frames of {times['width']} × "
        f"{times['height']} from {times['views']} viewpoints after {times['warm_up']} to warm up, "
        f"one thread of {machine['cpu']}, networks on {device} in {times['precision']}; a network "
        f"answers {times['sphere_rays']:,.0f} rays a frame."
    )


def describe_biases(rows: Sequence[Mapping[str, Any]], biases: Mapping[str, float]) -> list[str]:
    """A sentence for each row whose network is given a depth bias; `biases` by method."""
    return [
        f"{row['label']}: a depth bias of {biases[row['method']]:g} sphere radii"
        + (", the best on held-out views." if row["bias"] == "held_out" else ".")
        for row in rows
        if biases.get(row["method"])
    ]


def describe_lpips(lpips: Mapping[str, Any]) -> str:
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
