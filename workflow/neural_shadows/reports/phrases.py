"""Phrases that several reports share."""

from collections.abc import Mapping
from typing import Any


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


REFERENCES = {
    "exact": "an exact shadow ray per pixel",
    "shadow_map": "a 32768² shadow map, as in the thesis",
}


def describe_mesh(report: Mapping[str, Any], procedural: bool) -> str:
    """One phrase on a prepared mesh: name, size, whether it is closed."""
    name = report["name"]
    kind = " (the pipeline's procedural stand-in, not the thesis's mesh)" if procedural else ""
    closed = "watertight" if report["watertight"] else "open"
    return f"{name}{kind}, {report['faces']:,} triangles, {closed}"


def describe_training(record: Mapping[str, Any]) -> str:
    """One sentence on how a network was trained, and on what machine."""
    training, machine = record["training"], record["machine"]
    device = machine["gpu"] if training["device"] == "cuda" else f"{machine['cpu']} CPU"
    return (
        f"{record['name']}: {record['parameters']:,} parameters, {training['steps']:,} steps of "
        f"{training['batch_size']:,} samples ({training['schedule']} learning rate "
        f"{training['learning_rate']:g}, {training['precision']}) in {record['seconds']:.0f} s on "
        f"{device}, {record['threads']} threads"
    )
