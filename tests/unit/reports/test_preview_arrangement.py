"""Pictures of arrangements: inserted objects can be seen and measured."""

import numpy as np
import pytest
from matplotlib.colors import to_rgb
from matplotlib.image import imread
from trimesh.creation import icosphere

from neural_shadows.errors import InputError
from neural_shadows.reports.drawing.preview_arrangement import INSERTED, draw


def draw_room(folder, count):
    """A room with spheres inserted, and the picture's pixels in the hue of each."""
    icosphere(2).export(folder / "mesh.ply")
    names = [f"ball_{k}" for k in range(count)]
    scene = {"generate": "room", "seed": 1, "inserted": dict.fromkeys(names, "y"), "penumbra": None}
    files = folder / "a.png", folder / "a.svg"
    meshes = [folder / "mesh.ply"] * count
    draw(meshes, *files, name="mine", scene=scene, seed=1, advice="Next: a table.")
    picture = imread(files[0])[:1150, :, :3].reshape(-1, 3)  # without the notes
    chroma = picture - picture.mean(1, keepdims=True)
    length = np.linalg.norm(chroma, axis=1)
    hues = np.array([to_rgb(colour) for colour in INSERTED[:count]]).reshape(-1, 3)
    hues -= hues.mean(1, keepdims=True)
    hues /= np.linalg.norm(hues, axis=1, keepdims=True)
    return [int(np.sum((chroma @ hue > 0.98 * length) & (length > 0.1))) for hue in hues]


def test_inserted_objects_are_in_colour_and_their_size_is_printed(tmp_path, capsys):
    first, second = draw_room(tmp_path, 2)
    assert first > 5000 and second > 500
    notes = capsys.readouterr().out
    # On the room's first spots, of 0.5 and 0.9 m; a third is free.
    assert "ball_0 0.5 × 0.5 × 0.5 m, ball_1 0.89 × 0.9 × 0.89 m" in notes
    assert "Free spots: 0.6 m." in notes and "Next: a table." in notes


def test_an_empty_arrangement_has_a_picture_and_too_many_objects_none(tmp_path, capsys):
    assert draw_room(tmp_path, 0) == []
    assert "Inserted: nothing" in capsys.readouterr().out
    with pytest.raises(InputError, match="4 inserted objects .* but 3 spots"):
        draw_room(tmp_path, 4)
