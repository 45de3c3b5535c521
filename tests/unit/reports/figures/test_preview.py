import trimesh
from matplotlib.image import imread
from shapes import SPHERE_OF_LIGHTS

from neural_shadows.files.whole_files import write_json
from neural_shadows.reports.figures.preview import draw

REPORT = {"name": "a mesh", "faces": 12, "watertight": True, "sheet": False}


def test_the_up_axis_and_a_sheet_are_said(tmp_path, capsys):
    trimesh.creation.box((1, 0.4, 0.6)).export(tmp_path / "mesh.ply")
    files = tmp_path / "mesh.ply", tmp_path / "mesh.json", tmp_path / "a.png"
    for up, sheet in (("y", False), ("z", True)):
        write_json(files[1], REPORT | {"sheet": sheet, "watertight": not sheet})
        draw(*files, scene={"up": up, "ground": True, "light": SPHERE_OF_LIGHTS})
        said = capsys.readouterr().out
        assert f"Up is {up}:" in said
        assert ("`surface: sheet`" in said) == sheet
    picture = imread(files[2])[..., :3]
    assert picture[-30:].min() < 0.5  # no blank strip at the foot
