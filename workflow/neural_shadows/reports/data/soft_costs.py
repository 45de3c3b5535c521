"""Costs of soft-shadow methods, from `time_methods`."""

import numpy as np

from neural_shadows.settings.records import SoftTimes


def cost(times: SoftTimes, method: str, number: int) -> dict[str, float]:
    """Milliseconds and bytes at a radius, counted from 0; NaN where nothing was timed."""
    if method not in times["methods"]:
        return dict.fromkeys(("own_ms", "map_ms", "ms", "bytes"), np.nan)
    timed = times["methods"][method]
    light_map = times["maps"].get(timed["map"], {"ms": 0.0, "texels": 0})
    own, map_ms = timed["ms"][number], light_map["ms"]
    held = 4 * timed["texel_floats"] * light_map["texels"] + timed["held_bytes"]
    return {"own_ms": own, "map_ms": map_ms, "ms": own + map_ms, "bytes": held}


def describe_times(times: SoftTimes) -> list[str]:
    """Describe the timing; nothing without times."""
    if not times["methods"]:
        return []
    share = times["share"]
    maps = ", ".join(f"{one['ms']:.1f} of {side}²" for side, one in times["maps"].items())
    part = (
        f"; all are {share:.1%} of those of whole frames, which are timed in their windows' place"
        if share < 1
        else ""
    )
    return [
        f"ms: median of {times['frames']} frames, each the least of up to {times['repeats']}, or one of what "
        f"takes more than {times['once_above_ms']} ms, one thread of {times['machine']['cpu']}; with a light map "
        f"its rasterisation is included ({maps}){part}."
    ]


def describe_bytes(times: SoftTimes) -> list[str]:
    """Describe the bytes; nothing without times."""
    if not times["methods"]:
        return []
    return [
        "KiB: the light map with its moments, or the fields. Ray methods count none: all methods hold "
        "the mesh and its tree for primary rays."
    ]
