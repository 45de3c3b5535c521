"""Pictures of scenes: a mesh's or an arrangement's, and what to do next."""

import pytest
from shipped import shipped

from neural_shadows.config.reading import read_config
from neural_shadows.config.resolved import resolved
from neural_shadows.errors import InputError
from neural_shadows.layout import previews
from neural_shadows.layout.layout import Layout
from neural_shadows.scenes.generated import generator_module

STATUE = {
    "statue": {"mesh": {"path": "meshes/statue.obj"}, "up": "z"},
    "room_statue": {"generate": "room", "inserted": ["statue"]},
}


@pytest.fixture
def layout():
    table = {"kind": "soft_methods", "title": "Mine", "frame_set": "frames", "methods": ["pcss"]}
    values = shipped(scenes=STATUE, tables={"mine": table})
    values["frame_sets"]["frames"]["unseen"].append("room_statue")
    return Layout(resolved(read_config(values)))


def test_an_arrangement_needs_its_inserted_meshes_alone(layout):
    assert previews.kind(layout, "room_statue") == "preview_arrangement"
    assert previews.files(layout, "room_statue") == {"meshes": ["results/scenes/statue/mesh.ply"]}
    assert previews.modules(layout, "room_statue") == [generator_module("room")]
    settings = previews.settings(layout, "room_statue")
    assert settings["scene"]["inserted"] == {"statue": "z"}
    # Shipped tables have the frame set, too: a user's own is the last.
    first, last = settings["advice"].split(", or another of ")
    assert first == "Next, with the same options: snakemake reports/soft_methods.csv"
    assert last.endswith("tables with it, the last reports/mine.csv.")


def test_a_mesh_is_drawn_by_itself(layout):
    assert previews.kind(layout, "statue") == "preview"
    assert previews.modules(layout, "dragon") == []
    assert previews.files(layout, "statue").keys() == {"mesh_ply", "mesh_json"}
    assert "snakemake reports/table_4_1.csv" in previews.settings(layout, "dragon")["advice"]
    # No table has it yet.
    assert "a table (`tables`) with statue" in previews.settings(layout, "statue")["advice"]
    with pytest.raises(InputError, match="'room_statu' \\(did you mean 'room_statue'"):
        previews.kind(layout, "room_statu")
