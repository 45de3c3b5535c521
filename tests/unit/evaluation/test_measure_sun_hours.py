"""Hours of sun and sky of a plate and a wall, and what table and figure make of them."""

import json

import numpy as np
import pandas as pd
import pytest
import trimesh
from threadpoolctl import threadpool_info, threadpool_limits

from neural_shadows.evaluation.measure_sun_hours import Daylight, measure_sun_hours
from neural_shadows.files.whole_files import write_json
from neural_shadows.reports.figures import sun_hours as figure
from neural_shadows.reports.tables import sun_hours as table

PLATE = trimesh.creation.box((1.6, 0.2, 1.1))
# Half as high as the plate is deep, at its south side (+z).
WALL = trimesh.creation.box(
    (1.6, 0.5, 0.1), trimesh.transformations.translation_matrix([0, 0.3, 0.5])
)


def measured(folder, shape, **settings):
    """The record, and the picture's arrays."""
    shape.export(folder / "mesh.ply")
    files = folder / "mesh.ply", folder / "hours.npz", folder / "hours.json"
    given = {"up": "y", "resolution": 128, "points": 4000, "width": 200, "latitude": 0.0}
    given |= {"day": 81, "minutes": 20, "seed": 1}
    measure_sun_hours(*files, **given | settings)
    with np.load(folder / "hours.npz") as arrays:
        return json.loads((folder / "hours.json").read_text()), dict(arrays)


def test_a_plate_sees_all_the_sun_and_all_the_sky(tmp_path):
    record, picture = measured(tmp_path, PLATE)
    assert record["faces"] == 12 and not record["sheet"] and record["sun_directions"] == 36
    assert record["unlike"] < 0.003
    top = picture["sky"] > 0.9
    assert 0.2 < top.mean() < 0.8 and np.isnan(picture["hours"]).any()
    assert picture["hours"][top] == pytest.approx(12, abs=0.02)
    assert picture["sky"][top] == pytest.approx(1, abs=0.01)
    # A side sees half of the sky.
    seen = picture["sky"][~np.isnan(picture["sky"])]
    assert np.mean((seen > 0.95) | (np.abs(seen - 0.5) < 0.03)) > 0.97


def test_a_wall_takes_the_winter_s_sun_from_the_ground_behind_it(tmp_path):
    """At noon the sun is 16.6° high: it shades 1.5 behind it, more than the plate."""
    winter = {"latitude": 50.0, "day": 355}
    walled, _ = measured(tmp_path, trimesh.util.concatenate([PLATE, WALL]), **winter)
    assert walled["hours_difference"] < 0.05 and walled["sky_difference"] < 0.01
    # Of 24 rays to the sun of that day, hours of an open plate are 8 on its top, half of its area.
    alone, picture = measured(tmp_path, PLATE, **winter)
    assert np.median(picture["hours"][picture["sky"] > 0.9]) == pytest.approx(8, abs=0.4)
    assert walled["hours"] < 0.75 * alone["hours"]


def test_the_same_with_another_axis_up(tmp_path):
    lying = PLATE.copy()
    lying.apply_transform(trimesh.transformations.rotation_matrix(np.pi / 2, [1, 0, 0]))
    a, b = (tmp_path / name for name in "ab")
    a.mkdir(), b.mkdir()
    records = [measured(a, PLATE)[0], measured(b, lying, up="z")[0]]
    for name in ("hours", "sky"):
        assert records[0][name] == pytest.approx(records[1][name], rel=0.03)


def test_no_second_thread_waits_while_a_method_is_timed(tmp_path, monkeypatch):
    """Its waiting counted as processor time: twice the time of each method from 250,000 points up."""
    add, threads = Daylight.add, []

    def watched(*given):
        threads.extend(library["num_threads"] for library in threadpool_info())
        return add(*given)

    monkeypatch.setattr(Daylight, "add", watched)
    with threadpool_limits(2):
        measured(tmp_path, PLATE, points=500, resolution=32)
    assert threads and set(threads) == {1}


@pytest.fixture(scope="module")
def files(tmp_path_factory):
    folder = tmp_path_factory.mktemp("hours")
    measured(folder, PLATE, points=500, resolution=32)
    write_json(folder / "mesh.json", {"name": "plate"})
    return folder


def test_table(files):
    made = table.table([files / "hours.json"] * 2, [files / "mesh.json"] * 2)
    row = made.data.iloc[0]
    assert list(made.data["mesh"]) == ["plate", "plate"] and row["points"] == 500
    assert row["ratio"] == pytest.approx(row["embree_s"] / row["field_s"])
    whole = row["field_s"] + row["field_build_s"]
    assert row["ratio_with_build"] == pytest.approx(
        (row["embree_s"] + row["embree_build_s"]) / whole
    )
    assert 0 < row["rays"] < 500 * (36 + 145)
    shown = pd.DataFrame({heading: column.cells for heading, column in made.shown().items()})
    assert shown["mesh"][0] == "plate, closed" and shown["triangles"][0] == "12"
    assert "500 points on each surface, 36 directions" in made.notes[0]


def test_figure(files, tmp_path):
    of_scene = [files / "hours.npz"], [files / "hours.json"], [files / "mesh.json"]
    drawn = figure.draw(*of_scene, "Hours (test scale)")
    assert drawn.axes[0].get_title("left") == "plate, 12 triangles"
    image = drawn.axes[0].images[0].get_array()
    assert np.all(image[0, 0] == 1)  # no surface
    assert image.min() < 0.9 and image.shape[1] < 200  # the margins are cut off
    drawn.savefig(tmp_path / "hours.png")


def test_less_sky_is_darker():
    hours, sky = np.array([[6.0, 6.0, np.nan]]), np.array([[1.0, 0.25, np.nan]])
    image = figure.shaded(np.full((1, 3, 4), 0.8), hours, sky)
    assert image[0, :, 0] == pytest.approx([0.8, 0.8 * (0.25 + 0.75 * 0.5), 1])
