"""Files and parameters of several kinds of figures."""

from typing import Any

from neural_shadows.layout.layout import Layout


def table_csv(layout: Layout, figure: str) -> dict[str, Any]:
    """The CSV of a figure's table."""
    return {"table": layout.paths.report(f"{layout.entry('figures', figure)['table']}.csv")}


def run(layout: Layout, figure: str) -> dict[str, Any]:
    """The scale, seed and machine of a run."""
    return {"run": layout.run()}


def rows_and_run(layout: Layout, figure: str) -> dict[str, Any]:
    """A figure's rows of methods, and its run."""
    return {"rows": layout.entry("figures", figure)["rows"], "run": layout.run()}


def scene_files(layout: Layout, figure: str) -> dict[str, Any]:
    """The mesh of a figure's scene, and its report."""
    scene, paths = layout.entry("figures", figure)["scene"], layout.paths
    return {
        "mesh_ply": paths.scene("mesh.ply", scene),
        "mesh_json": paths.scene("mesh.json", scene),
    }


def scene(layout: Layout, figure: str) -> dict[str, Any]:
    """The settings of a figure's scene."""
    name = layout.entry("figures", figure)["scene"]
    return {"scene": layout.entry("scenes", name)["scene"]}


def scene_and_sampling(layout: Layout, figure: str) -> dict[str, Any]:
    """The settings of a figure's scene and sampling, with seed."""
    settings = layout.entry("figures", figure)
    scene = layout.entry("scenes", settings["scene"])
    sampling = layout.entry("samplings", settings["sampling"])
    return {"scene": scene["scene"], "sampling": sampling, "seed": scene["seed"]}


def experiment_files(layout: Layout, figure: str) -> dict[str, Any]:
    """The mesh and weights of a figure's experiment."""
    experiment = layout.entry("figures", figure)["experiment"]
    scene = layout.entry("experiments", experiment)["scene"]
    return {
        "mesh_ply": layout.paths.scene("mesh.ply", scene),
        "weights": layout.paths.network("weights.safetensors", experiment),
    }


def experiment_scene(layout: Layout, figure: str) -> dict[str, Any]:
    """The settings of the scene of a figure's experiment."""
    experiment = layout.entry("figures", figure)["experiment"]
    scene = layout.entry("experiments", experiment)["scene"]
    return {"scene": layout.entry("scenes", scene)["scene"]}


def experiment_encodings(layout: Layout, figure: str) -> set[str]:
    """The encoding of a figure's experiment."""
    return layout.encodings([layout.entry("figures", figure)["experiment"]])
