"""What each kind of figure is made of: its files, and what its function is told."""

from typing import Any

from neural_shadows.layout import tables
from neural_shadows.layout.layout import Layout


def files(layout: Layout, figure: str) -> dict[str, Any]:
    """The files that a figure is made of, as its kind's function names them."""
    settings = layout.entry("figures", figure)
    paths = layout.paths
    match settings["kind"]:
        case "pictures":
            first = [(settings["scene"], row["method"], "000") for row in settings["rows"]]
            return {
                "metrics": [paths.evaluation("csv", *names) for names in first],
                "pictures": [
                    paths.reference("npz", settings["scene"], "000"),
                    *(paths.evaluation("npz", *names) for names in first),
                ],
                "mesh_json": paths.scene("mesh.json", settings["scene"]),
            }
        case "loss":
            curves = settings["curves"]
            return {"losses": [paths.network("loss.csv", one["experiment"]) for one in curves]}
        case "widths" | "pareto":
            return {"table": paths.report(f"{settings['table']}.csv")}
        case "cost":
            return {"costs": tables.costs(layout, settings["table"])}
        case "field_slice":
            experiment = settings["experiment"]
            scene = layout.entry("experiments", experiment)["scene"]
            return {
                "mesh_ply": paths.scene("mesh.ply", scene),
                "weights": paths.network("weights.safetensors", experiment),
            }
        case _:  # a picture of the method
            scene = settings["scene"]
            return {
                "mesh_ply": paths.scene("mesh.ply", scene),
                "mesh_json": paths.scene("mesh.json", scene),
            }


def arguments(layout: Layout, figure: str) -> dict[str, Any]:
    """What the function of a figure's kind is told beside its files."""
    settings = layout.entry("figures", figure)
    title, run = {"title": settings["title"]}, {"run": layout.run()}
    match settings["kind"]:
        case "pictures":
            return title | run | {key: settings[key] for key in ("rows", "view_sets")}
        case "loss":
            return title | run | {"curves": settings["curves"]}
        case "widths":
            return title | run | {"rows": settings["rows"]}
        case "pareto":
            return title | run | {key: settings[key] for key in ("scene", "rows")}
        case "cost":
            return title | run
        case "field_slice":
            scene = layout.entry("experiments", settings["experiment"])["scene"]
            return title | {"scene": layout.entry("scenes", scene)["scene"]}
        case _:
            scene = layout.entry("scenes", settings["scene"])
            sampling = layout.entry("samplings", settings["sampling"])
            return title | {"scene": scene["scene"], "sampling": sampling, "seed": scene["seed"]}


def kind(layout: Layout, figure: str) -> str:
    """A figure's kind."""
    return layout.entry("figures", figure)["kind"]


def labels(layout: Layout, figure: str) -> dict[str, str]:
    """What Snakemake's report lists of a figure."""
    number = figure.removeprefix("figure_").replace("_", ".")
    return {"figure": number, "title": layout.entry("figures", figure)["title"]}


def experiments(layout: Layout, figure: str) -> list[str]:
    """The networks whose weights a figure reads."""
    settings = layout.entry("figures", figure)
    return [settings["experiment"]] if "experiment" in settings else []
