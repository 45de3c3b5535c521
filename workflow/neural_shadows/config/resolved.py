"""The configuration as plain data for rules."""

import re
from typing import Any

from neural_shadows.sections.any_report import Chapter
from neural_shadows.sections.frame_sets import VIEWS
from neural_shadows.sections.own_frames import OwnFrames, own_settings
from neural_shadows.sections.rows import row_of
from neural_shadows.sections.scenes import mesh_name
from neural_shadows.sections.sections import Sections
from neural_shadows.sections.viewers import HardViewer, SoftViewer

Section = dict[str, Any]


def resolved(config: Sections) -> Section:
    """Sections with names replaced by their entries.

    Sections are as in config.yaml, with every default, but: a scene has its `arrangement` in metres,
    and a mesh `mesh_name`, `scene` (arguments of `open_scene` besides the mesh) and `frames` (settings
    of its viewpoints); an experiment's `network` and `training` are sections, the former with keys of
    its scene, and points of learning curves are experiments as well; one on frames has a `trunk`;
    `learning_curves` has the `points` of each experiment; seeds and labels are the
    effective ones; tables, figures and claims are resolved by their kinds.
    """
    curves = config.points
    return config.model_dump() | {
        "scenes": {name: _scene(config, name) for name in config.scenes},
        "frame_sets": {name: _frame_set(config, name) for name in config.frame_sets},
        "experiments": {
            **{
                point["experiment"]: _experiment_at(config, name, point)
                for name, points in curves.items()
                for point in points
            },
            **{name: _experiment(config, name) for name in config.experiments},
        },
        "learning_curves": curves,
        "viewers": {name: _viewer(config, viewer) for name, viewer in config.viewers.items()},
        "tables": {
            name: table.resolved(config) | {"chapter": table.chapter_of()}
            for name, table in config.tables.items()
        },
        "figures": {name: _figure(config, name) for name in config.figures},
        "claims": {name: claim.resolved(config) for name, claim in config.claims.items()},
    }


def _viewer(config: Sections, viewer: HardViewer | SoftViewer) -> Section:
    if isinstance(viewer, SoftViewer):
        return viewer.model_dump()
    rows = [row_of(config, viewer.scene, row) for row in viewer.networks]
    return {"scene": viewer.scene, "rows": rows}


def _figure(config: Sections, name: str) -> Section:
    figure = config.figures[name]
    return figure.resolved(config) | {
        "chapter": _chapter(config, name),
        "folded": figure.folded,
        "needs_opengl": figure.needs_opengl,
    }


def _chapter(config: Sections, figure: str) -> Chapter:
    if own := config.figures[figure].own_chapter:
        return own
    if re.fullmatch(r"figure_\d+_\d+", figure):
        return "thesis"
    table = getattr(config.figures[figure], "table", None)
    return config.tables[table].chapter_of() if table else "extensions"


def _scene(config: Sections, name: str) -> Section:
    arrangement = {
        "arrangement": _arrangement(config, name),
        "new_layouts": config.arrangement(name).new_layouts,
    }
    if name not in config.mesh_scenes:
        return arrangement
    scene = config.scenes[name].model_dump()
    scene["seed"] = config.seed if scene["seed"] is None else scene["seed"]
    size = {"width": config.views.width, "height": config.views.height}
    return (
        scene
        | arrangement
        | {
            "mesh_name": mesh_name(config.scenes[name]),
            "scene": {key: scene[key] for key in ("up", "ground", "light")},
            "frames": size | {key: scene[key] for key in ("view_sets", "least_shadow", "seed")},
        }
    )


def _arrangement(config: Sections, name: str) -> Section:
    """Arguments of `SoftScene` besides meshes, with the meshes' vertical axes."""
    scene = config.arrangement(name)
    return {
        "generate": scene.generate,
        "seed": config.layout_seed(name),
        "inserted": {inserted: config.scenes[inserted].up for inserted in scene.inserted},
        "penumbra": scene.penumbra,
    }


def _frame_set(config: Sections, name: str) -> Section:
    frames = config.frame_sets[name]
    if isinstance(frames, OwnFrames):
        return own_settings(frames)
    settings = frames.model_dump()
    if name == VIEWS:
        return settings
    return settings | {"of": settings["of"] and [*settings["of"].values()], "path": None}


def _experiment(config: Sections, name: str) -> Section:
    if name in config.screen_experiments:
        return _screen_experiment(config, name)
    training, network = config.training_of(name), config.network_of(name).model_dump()
    scene = config.scenes[config.experiments[name].scene]
    for key in config.network_of(name).of_scene:
        network[key] = network[key] or getattr(scene, key)
    return config.experiments[name].model_dump() | {
        "network": network,
        "training": training and training.model_dump(),
        "seed": config.seed_of(name),
        "label": config.label_of(name),
    }


def _experiment_at(config: Sections, name: str, point: Section) -> Section:
    """Experiment of a point of a learning curve."""
    section = _experiment(config, name)
    training = section["training"] | {"steps": point["steps"]}
    # A network with shipped weights is trained for its curve.
    on_frames = {"frames": point["frames"], "weights": None} if "frames" in point else {}
    return section | {"training": training, "seed": point["seed"]} | on_frames


def _screen_experiment(config: Sections, name: str) -> Section:
    """Sections of an experiment on frames, with `trunk`.

    Without weights (`trunk`) the perceptual loss is `none`.
    """
    experiment = config.screen_experiments[name]
    training = config.training_of(name).model_dump()
    perceptual, lpips = training["perceptual"], config.metrics.lpips
    trunk = perceptual.get("trunk")
    if perceptual["net"] == "squeeze":
        trunk = lpips.trunk if lpips.net == "squeeze" else None
        if trunk is None:
            training["perceptual"] = {"net": "none"}
    return experiment.model_dump() | {
        "network": config.network_of(name).model_dump(),
        "training": training,
        "trunk": trunk,
        "seed": config.seed_of(name),
        "label": config.label_of(name),
    }
