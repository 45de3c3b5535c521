"""Parts of work per job: shards of rays, batches of viewpoints."""

from neural_shadows.sections.views import Views

HELD_OUT = "held_out"
"""Batch of viewpoints for depth biases only."""


def part_range(total: int, parts: int, part: int) -> tuple[int, int]:
    """First and last (exclusive) of one of nearly equal ranges."""
    return total * part // parts, total * (part + 1) // parts


def part_names(count: int) -> list[str]:
    """Names of numbered parts: 000, 001, …"""
    return [f"{part:03d}" for part in range(count)]


def batches(views: Views) -> list[str]:
    """Names of the batches of a view set."""
    return part_names(-(-views.views_per_set // views.batch))


def view_range(views: Views, batch: str) -> tuple[int, int]:
    """First and last (exclusive) viewpoint of a batch, per view set.

    Held-out viewpoints follow the evaluated ones.
    """
    count = views.views_per_set
    if batch == HELD_OUT:
        return count, count + views.held_out_views
    first = int(batch) * views.batch
    return first, min(first + views.batch, count)
