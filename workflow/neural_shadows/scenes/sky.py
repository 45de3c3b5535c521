"""Directions of the sun on a day, and of the patches of a sky.

In the axes of a scene: of `up` "y" east is x and south is z, of "z" east is x and north y, of "x" east
is y and north z.
"""

import numpy as np

from neural_shadows.errors import InputError

_AXES = {
    "x": [[0, 1, 0], [0, 0, 1], [1, 0, 0]],
    "y": [[1, 0, 0], [0, 0, -1], [0, 1, 0]],
    "z": [[1, 0, 0], [0, 1, 0], [0, 0, 1]],
}
# Patches in bands of 12°, from the horizon up; the last is a cap of 6° around the zenith (Tregenza
# 1987, Subdivision of the sky hemisphere for luminance measurements).
BANDS, BAND = (30, 30, 24, 24, 18, 12, 6, 1), 12.0
_DAY = 24 * 60


def sky_patches(up: str = "y") -> tuple[np.ndarray, np.ndarray]:
    """Middles (145, 3) of Tregenza's sky patches, unit vectors, and solid angles (145,).

    The angles add up to 2 π. From north on clockwise in each band.

    Args:
        up: vertical axis, "x", "y" or "z".

    Raises:
        InputError: another axis.
    """
    axes = scene_axes(up)
    directions, angles = [], []
    for band, count in enumerate(BANDS):
        low, high = np.radians(BAND * band), min(np.radians(BAND * (band + 1)), np.pi / 2)
        elevation = (low + high) / 2 if count > 1 else np.pi / 2
        directions.append(_directions(2 * np.pi * np.arange(count) / count, elevation))
        angles.append(np.full(count, 2 * np.pi * (np.sin(high) - np.sin(low)) / count))
    return np.concatenate(directions) @ axes, np.concatenate(angles)


def sun_directions(latitude: float, day: int, minutes: float = 10, up: str = "y") -> np.ndarray:
    """Unit vectors (n, 3) to the sun on a day while it is above the horizon.

    In solar time, in the middle of each step. Declination by Cooper 1969 (The absorption of radiation
    in solar stills), to half a degree.

    Args:
        latitude: degrees north. day: of the year, 1 to 366; 80, 172, 266 and 355 begin the seasons.
        minutes: of a step, a divisor of a day.
        up: see `sky_patches`.

    Raises:
        InputError: a value out of range.
    """
    steps = round(_DAY / minutes) if minutes > 0 else 0
    in_range = {
        "latitude": (latitude, -90 <= latitude <= 90, "degrees from −90 to 90"),
        "day": (day, 1 <= day <= 366, "a day of the year, 1 to 366"),
        "minutes": (minutes, steps >= 1 and steps * minutes == _DAY, "a divisor of 1440"),
    }
    for name, (value, valid, allowed) in in_range.items():
        if not valid:
            raise InputError(f"{name}: {value!r}: out of range. Give {allowed}.")
    axes = scene_axes(up)
    phi, delta = np.radians(latitude), np.radians(23.45) * np.sin(2 * np.pi * (284 + day) / 365)
    hour = 2 * np.pi * ((np.arange(steps) + 0.5) / steps - 0.5)  # 0 at noon
    east = -np.cos(delta) * np.sin(hour)
    north = np.sin(delta) * np.cos(phi) - np.cos(delta) * np.sin(phi) * np.cos(hour)
    height = np.sin(delta) * np.sin(phi) + np.cos(delta) * np.cos(phi) * np.cos(hour)
    return np.stack([east, north, height], axis=1)[height > 0] @ axes


def scene_axes(up: str) -> np.ndarray:
    """East, north and up of a scene, as rows.

    Raises:
        InputError: another vertical axis than "x", "y" or "z".
    """
    if up not in _AXES:
        raise InputError(f"up: {up!r}: no axis. Give one of {', '.join(_AXES)}.")
    return np.array(_AXES[up], float)


def _directions(azimuth: np.ndarray, elevation: float) -> np.ndarray:
    """Unit vectors east, north, up of azimuths from north on clockwise, in radians."""
    flat = np.stack([np.sin(azimuth), np.cos(azimuth), np.zeros_like(azimuth)], axis=1)
    return np.cos(elevation) * flat + np.sin(elevation) * np.array([0.0, 0.0, 1.0])
