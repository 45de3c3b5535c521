"""Stage for interactive pages with a movable light."""

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

from neural_shadows.evaluation.memory import network_bytes
from neural_shadows.evaluation.ray_network import take_constants
from neural_shadows.files.whole_files import read_json, whole_file
from neural_shadows.networks.weight_file import load_network
from neural_shadows.rendering.gbuffer import GROUND_RADIUS, SHADING_OFFSET
from neural_shadows.rendering.shading import BACKGROUND
from neural_shadows.reports.data.phrases import describe_mesh, describe_run
from neural_shadows.representations.meshes.decimation import decimated
from neural_shadows.running.stage import run_stage
from neural_shadows.scenes.scene import open_scene
from neural_shadows.settings.records import Row, Run, SceneInfo, SceneSettings, ViewSettings
from neural_shadows.viewer.mesh_arrays import BITS, mesh_arrays
from neural_shadows.viewer.network_arrays import network_arrays
from neural_shadows.viewer.packed import packed
from neural_shadows.viewer.template import fill_template, shaders, write_html
from neural_shadows.viewer.views import poster, shown_views

# 3.4 bytes per triangle: with a 256³ field and a network of width 64 a viewer takes 2 MiB.
MOST_TRIANGLES, MOST_BYTES = 210_000, 2 << 20


def write_viewer(
    *,
    html: Path,
    png: Path,
    template: list[Path],
    mesh_ply: Path,
    mesh_json: Path,
    weights: list[Path],
    depth_biases: list[Path],
    name: str,
    rows: Sequence[Row],
    scene: SceneSettings,
    frames: ViewSettings,
    views: int,
    about: SceneInfo,
    run: Run,
) -> None:
    """Write a scene's viewer as one file, and its poster.

    Args:
        template: the files of `workflow/report/viewer`.
        weights: of the networks, in the order of their rows.
        depth_biases: held-out ones, named after their methods.
        name: of the scene.
        rows: `method`, `experiment`, `label` and `bias` of each network.
        scene: `up`, `ground` and `light`, see `open_scene`.
        frames: settings of the evaluation's viewpoints, see `render_references`.
        views: viewpoints per view set.
        about: the scene's argument of `describe_mesh`.

    Raises:
        InputError: an input file cannot be read.
    """
    opened = open_scene(mesh_ply, **scene)
    (mesh,) = opened.objects
    vertices, faces = decimated(mesh.vertices, mesh.faces, MOST_TRIANGLES)
    arrays = mesh_arrays(vertices, faces)
    image = poster(opened)
    with whole_file(png) as part:
        image.save(part, "PNG")
    report = read_json(mesh_json)
    paths = {path.parent.name: path for path in weights}
    biases = {path.stem: path for path in depth_biases}
    title = f"Shadows of {report['name']}"
    data = {
        "name": name,
        "mesh": {"bits": BITS, **{key: packed(array) for key, array in arrays._asdict().items()}},
        "scene": {
            "up": opened.up.tolist(),
            "ground": opened.ground,
            "ground_radius": GROUND_RADIUS,
            "light": scene["light"],
        },
        "constants": {
            key: f"{value:.9g}" if value % 1 else f"{value:.1f}"
            for key, value in (
                ("SHADING_OFFSET", SHADING_OFFSET),
                ("BACKGROUND", BACKGROUND),
            )
        },
        "views": shown_views(opened, frames, views),
        "networks": [_network(paths[row["experiment"]], row, biases) for row in rows],
        "shaders": shaders(template),
    }
    verb = "is decimated to" if len(faces) < report["faces"] else "has its"
    quantised = f"Here it {verb} {len(faces):,} triangles, with vertices in {BITS} bits."
    page = fill_template(
        template,
        "viewer.html",
        title=title,
        poster=image,
        about=f"Mesh: {describe_mesh(report, about)}. {quantised} {describe_run(run)}",
        data=data,
    )
    write_html(html, page, MOST_BYTES, "Use a field of fewer cells")


def _network(weights: Path, row: Row, depth_biases: Mapping[str, Path]) -> dict[str, Any]:
    """Description of a network for the viewer."""
    network, header = load_network(weights)
    depth_bias = row["bias"]
    if depth_bias == "held_out":
        depth_bias = take_constants(network, depth_biases[row["experiment"]])
    return {
        "key": row["method"],
        "name": row["label"],
        "encoding": header["network"]["encoding"],
        "depth_bias": depth_bias,
        "stored": network_bytes(weights),
        "resident": network.resident_bytes(),
        **network_arrays(network, trained=header["training"] is not None),
    }


if "snakemake" in globals():
    run_stage(snakemake, write_viewer)
