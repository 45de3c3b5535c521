"""Which part of a stage's work a job does: shards of ray sets, batches of viewpoints."""

from collections.abc import Mapping
from typing import Any

HELD_OUT = "held_out"
"""The batch of viewpoints that only depth biases are found on."""


def part_range(total: int, parts: int, part: int) -> tuple[int, int]:
    """First and last (exclusive) of the `part`-th of `parts` nearly equal ranges of `total`."""
    return total * part // parts, total * (part + 1) // parts


def part_names(count: int) -> list[str]:
    """Names of numbered parts: 000, 001, …"""
    return [f"{part:03d}" for part in range(count)]


def batches(rendering: Mapping[str, Any]) -> list[str]:
    """The batches that a view set's viewpoints are rendered in."""
    return part_names(-(-rendering["views_per_set"] // rendering["batch"]))


def view_range(rendering: Mapping[str, Any], batch: str) -> tuple[int, int]:
    """First and last (exclusive) viewpoint of a batch, in each view set.

    Held-out viewpoints come after all that are evaluated.
    """
    views = rendering["views_per_set"]
    if batch == HELD_OUT:
        return views, views + rendering["held_out_views"]
    first = int(batch) * rendering["batch"]
    return first, min(first + rendering["batch"], views)
