"""Hours of sun and view of the sky: a field's rays beside Embree's packets."""

from pathlib import Path
from typing import Any, Literal

import pandas as pd
from pydantic import Field

from neural_shadows.files.whole_files import read_json
from neural_shadows.layout.layout import Layout
from neural_shadows.reports.data.table import Table, numbers
from neural_shadows.sections.any_report import AnyTable
from neural_shadows.sections.scenes import MeshName

SUN, SKY = "hours_difference", "sky_difference"


class Settings(AnyTable):
    """Time and error of sun hours and sky view by a field, beside Embree."""

    own_chapter = "extensions"
    kind: Literal["sun_hours"] = Field(description="`sun_hours`")
    scenes: list[MeshName] = Field(min_length=1, description="meshes in `scenes`")
    resolution: int = Field(512, ge=8, le=1024, multiple_of=4, description="cells of the field")
    points: int = Field(100_000, ge=100, le=10_000_000, description="points on each surface")
    width: int = Field(1600, ge=64, le=8192, description="of the figure's pictures, pixels")
    latitude: float = Field(48.1, ge=-90, le=90, description="degrees north")
    day: int = Field(81, ge=1, le=366, description="of the year; 81 is an equinox")
    minutes: int = Field(10, ge=1, le=240, description="a step of the sun; divides a day")

    def check(self, config: Any, key: str) -> None:
        if 1440 % self.minutes:
            raise ValueError(f"{key}.minutes: {self.minutes} does not divide a day. Give 10 or 20.")


def files(layout: Layout, table: str) -> dict[str, Any]:
    scenes = layout.entry("tables", table)["scenes"]
    return {
        "measured": [layout.paths.sun_hours("json", table, scene) for scene in scenes],
        "meshes": [layout.paths.scene("mesh.json", scene) for scene in scenes],
    }


def table(measured: list[Path], meshes: list[Path]) -> Table:
    """Tabulate records of `measure_sun_hours`, a row a scene.

    CSV: `mesh, faces, sheet, resolution, field_bytes, points, rays`, `field_build_s, field_s, embree_build_s,
    embree_s`, `ratio` (Embree's over the field's seconds), `ratio_with_build`, `unlike`, `hours`, `sky` and
    their mean absolute differences.
    """
    records = [read_json(path) for path in measured]
    names = [read_json(path)["name"] for path in meshes]
    data = pd.DataFrame(_row(name, record) for name, record in zip(names, records))
    columns = {
        "mesh": [
            f"{name}, {'open' if sheet else 'closed'}"
            for name, sheet in zip(data["mesh"], data["sheet"])
        ],
        "triangles": numbers(data["faces"], "{:,.0f}"),
        "field, MiB": numbers(data["field_bytes"] / 2**20, "{:.1f}"),
        "rays, 10⁶": numbers(data["rays"] / 1e6, "{:.1f}"),
        "field: fit s": numbers(data["field_build_s"], "{:.1f}"),
        "rays s ↓": numbers(data["field_s"], "{:.2f}"),
        "Embree: tree s": numbers(data["embree_build_s"], "{:.1f}"),
        "packets s ↓": numbers(data["embree_s"], "{:.2f}"),
        "packets / rays ↑": numbers(data["ratio"], "{:.2f}"),
        "with fit and tree ↑": numbers(data["ratio_with_build"], "{:.2f}"),
        "rays unlike %": numbers(data["unlike"], "{:.2f}", 100),
        "sun hours": numbers(data["hours"], "{:.2f}"),
        "difference": numbers(data[SUN], "{:.3f}"),
        "sky seen %": numbers(data["sky"], "{:.1f}", 100),
        "difference, %": numbers(data[SKY], "{:.2f}", 100),
    }
    first = records[0]
    notes = [
        f"{first['points']:,} points on each surface, {first['sun_directions']} directions of the sun (day "
        f"{first['day']}, {first['latitude']:g}° north) and the 145 patches of Tregenza's sky; of each the "
        "points that face it. Processor seconds of one thread, both in turn for each direction.",
        f"The field has {first['resolution']}³ cells; its rays start a third of a cell off the surface, "
        "Embree's (packets of eight) at the triangles. *unlike*: of these rays. Differences: mean of their "
        "absolute values over the points. *sky seen*: light of a uniform sky, of that on open level ground.",
    ]
    return Table(data, columns, notes)


def _row(name: str, record: dict[str, Any]) -> dict[str, Any]:
    by_field, embree = record["field"], record["embree"]
    whole = by_field["seconds"] + by_field["build_seconds"]
    keys = ("faces", "sheet", "resolution", "points", "unlike", "hours", SUN, "sky", SKY)
    return {
        "mesh": name,
        **{key: record[key] for key in keys},
        "field_bytes": by_field["bytes"],
        "rays": by_field["rays"],
        "field_build_s": by_field["build_seconds"],
        "field_s": by_field["seconds"],
        "embree_build_s": embree["build_seconds"],
        "embree_s": embree["seconds"],
        "ratio": embree["seconds"] / by_field["seconds"],
        "ratio_with_build": (embree["seconds"] + embree["build_seconds"]) / whole,
    }
