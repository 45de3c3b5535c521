"""The checked configuration as plain data with names followed: what rules look up."""

from typing import TYPE_CHECKING, Any

from neural_shadows.config import screen_experiments
from neural_shadows.config.claims import compared, networks_of_claim, rows_of_claim
from neural_shadows.config.experiments import formatted, network_of, seed_of, training_of
from neural_shadows.config.figures import (
    LossFigure,
    SoftPicturesFigure,
    TableFigure,
    radii_of,
    rows_of_figure,
    scene_of,
)
from neural_shadows.config.frame_sets import as_settings
from neural_shadows.config.learning_curves import points_of
from neural_shadows.config.scenes import mesh_name
from neural_shadows.config.soft_scenes import layout_seed
from neural_shadows.config.tables import rows_of
from neural_shadows.config.viewers import networks_of

if TYPE_CHECKING:
    from neural_shadows.config.whole import Config

Section = dict[str, Any]

# Figures of tables whose rows are no methods of a scene's frames.
WITHOUT_ROWS = ("cost", "soft_equal_time", "soft_radii")
WITHOUT_ROWS += ("screen_level_time", "screen_sensitivity", "screen_flicker")


def resolved(config: "Config") -> Section:
    """The sections of a configuration as Snakemake's `lookup` finds them.

    Sections are as in config.yaml, with every default, but: a scene has its `mesh_name`, `scene`
    (what `open_scene` takes beside the mesh) and `frames` (how its viewpoints are drawn and
    rendered); an experiment's `network` and `training` are sections, the former with what it takes
    from its scene, and the points of learning
    curves are experiments, too; a screen experiment has its sections and a `trunk`; `learning_curves` has those of each (`points_of`); seeds and
    labels are what holds; rows (also of a viewer's networks), curves, pairs and methods are as
    `rows_of` gives them.
    """
    names = config.learning_curves.experiments if config.learning_curves else []
    curves = {name: points_of(config, name) for name in names}
    return config.model_dump() | {
        "scenes": {name: _scene(config, name) for name in config.scenes},
        "soft_scenes": {name: _soft_scene(config, name) for name in config.soft_scenes},
        "frame_sets": {name: as_settings(config, name) for name in config.frame_sets},
        "experiments": {
            **{
                point["experiment"]: _experiment_at(config, name, point)
                for name, points in curves.items()
                for point in points
            },
            **{name: _experiment(config, name) for name in config.experiments},
        },
        "screen_experiments": {
            name: screen_experiments.as_settings(config, name) for name in config.screen_experiments
        },
        "learning_curves": curves,
        "tables": {
            name: table.model_dump() | {"rows": rows_of(config, name)}
            for name, table in config.tables.items()
        },
        "figures": {name: _figure(config, name) for name in config.figures},
        "viewers": {
            name: {"scene": viewer.scene, "rows": networks_of(config, name)}
            for name, viewer in config.viewers.items()
        },
        "claims": {name: _claim(config, name) for name in config.claims},
    }


def _scene(config: "Config", name: str) -> Section:
    scene = config.scenes[name].model_dump()
    scene["seed"] = config.seed if scene["seed"] is None else scene["seed"]
    size = {"width": config.rendering.width, "height": config.rendering.height}
    return scene | {
        "mesh_name": mesh_name(config.scenes[name]),
        "scene": {key: scene[key] for key in ("up", "ground", "light")},
        "frames": size | {key: scene[key] for key in ("view_sets", "least_shadow", "seed")},
    }


def _soft_scene(config: "Config", name: str) -> Section:
    """What `SoftScene` takes beside the meshes, of whose names it has the axes that point up."""
    scene = config.soft_scenes[name]
    ups = {inserted: config.scenes[inserted].up for inserted in scene.inserted}
    drawn = {"generate": scene.generate, "seed": layout_seed(config, name)}
    return drawn | {"inserted": ups, "penumbra": scene.penumbra}


def _experiment(config: "Config", name: str) -> Section:
    training, network = training_of(config, name), network_of(config, name)
    scene = config.scenes[config.experiments[name].scene]
    return config.experiments[name].model_dump() | {
        "network": network.model_dump() | {key: getattr(scene, key) for key in network.of_scene},
        "training": training and training.model_dump(),
        "seed": seed_of(config, name),
        "label": formatted(config, name),
    }


def _experiment_at(config: "Config", name: str, point: Section) -> Section:
    """An experiment as it is trained for a point of its learning curve."""
    section = _experiment(config, name)
    training = section["training"] | {"steps": point["steps"]}
    return section | {"training": training, "seed": point["seed"]}


def _figure(config: "Config", name: str) -> Section:
    figure = config.figures[name]
    section = figure.model_dump()
    if isinstance(figure, LossFigure):
        for curve in section["curves"]:
            curve["label"] = formatted(config, curve["experiment"], curve["label"])
    elif isinstance(figure, SoftPicturesFigure):
        section["radii"] = radii_of(config, figure)
    elif hasattr(figure, "table") and figure.kind not in WITHOUT_ROWS:
        section["rows"] = rows_of_figure(config, figure)
        if not isinstance(figure, TableFigure):
            section["scene"] = scene_of(config, figure)
    return section


def _claim(config: "Config", name: str) -> Section:
    claim = config.claims[name]
    rows = [rows_of_claim(config, methods) for methods in compared(claim)]
    if claim.kind in ("soft_better", "soft_equal_time", "ratio"):
        return claim.model_dump() | {"networks": networks_of_claim(config, claim)}
    if not rows:  # of printed numbers, or of a column
        return claim.model_dump()
    if claim.kind == "violations":
        return claim.model_dump() | {"methods": [row for (row,) in rows]}
    return claim.model_dump() | {"pairs": rows}
