"""Meshes, rays and frames of the scenes in a configuration, made where Snakemake is not."""

from collections.abc import Mapping
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np

from neural_shadows.layout.layout import Layout
from neural_shadows.meshes.generate_mesh import generate_mesh
from neural_shadows.meshes.prepare_mesh import prepare_mesh
from neural_shadows.rays.describe_rays import describe_rays
from neural_shadows.rays.draw_directions import draw_directions
from neural_shadows.rays.label_rays import label_rays
from neural_shadows.rays.ray_set import RaySet
from neural_shadows.rays.sample_rays import sample_rays
from neural_shadows.rendering.exact_shadow import exact_visibility
from neural_shadows.rendering.gbuffer import GBuffer, render_gbuffer
from neural_shadows.rendering.viewpoints import draw_viewpoints
from neural_shadows.scenes.scene import open_scene

Frames = list[tuple[GBuffer, np.ndarray]]
"""Frames with their exact visibility."""


@dataclass
class Data:
    """What a configuration's stages before training make; each is made when it is asked for.

    Args:
        settings: what `config.resolved` gives.
        folder: where files lie; those that are there already are used.
        threads: of rays, labels and frames.
        views: of each view set, the first of the configuration's.
    """

    settings: Mapping[str, Any]
    folder: Path
    threads: int
    views: int
    _frames: dict[str, Frames] = field(default_factory=dict)

    def mesh(self, scene: str) -> Path:
        """The prepared mesh of a scene."""
        about = self.settings["scenes"][scene]
        mesh_ply, source = self.folder / scene / "mesh.ply", about["mesh"].get("path")
        if not mesh_ply.exists():
            if source is None:
                source = self.folder / scene / "generated.ply"
                generate_mesh(source, about["mesh"])
            mesh_json = mesh_ply.with_suffix(".json")
            prepare_mesh(Path(source), mesh_ply, mesh_json, about["mesh"], about["mesh_name"])
        return mesh_ply

    def rays(self, scene: str, sampling: str) -> tuple[RaySet, Path]:
        """A ray set, and its description."""
        folder = self.folder / scene / sampling
        rays_json, directions = folder / "rays.json", folder / "directions.npy"
        origins, bounds = [folder / "origins.npy"], [folder / "bounds.npy"]
        if not rays_json.exists():
            about, settings = (
                self.settings["scenes"][scene],
                self.settings["samplings"][sampling],
            )
            light = Layout(self.settings).direction_light(scene, sampling)
            made = {"sampling": settings, "seed": about["seed"]}
            files = {"mesh_ply": self.mesh(scene), "directions_npy": directions}
            part = {"first": 0, "last": settings["directions"], "threads": self.threads}
            draw_directions(directions_npy=directions, light=light, up=about["up"], **made)
            sample_rays(**files, origins_npy=origins[0], **made, **part)
            label_rays(
                **files, origins_npy=origins[0], bounds_npy=bounds[0], seed=made["seed"], **part
            )
            describe_rays(**files, origins=origins, bounds=bounds, rays_json=rays_json, **made)
        return RaySet(directions, origins, bounds), rays_json

    def frames(self, scene: str) -> Frames:
        """The first viewpoints of each view set, as the pipeline draws and renders them."""
        if scene not in self._frames:
            about = self.settings["scenes"][scene]
            width, height = about["frames"]["width"], about["frames"]["height"]
            opened = open_scene(self.mesh(scene), **about["scene"])

            def render(which: tuple[str, int]) -> tuple[GBuffer, np.ndarray]:
                view_set, index = which
                drawn = about["frames"]["seed"], about["frames"]["least_shadow"]
                (view,) = draw_viewpoints(opened, [view_set], [index], width / height, *drawn)
                frame = render_gbuffer(opened, view, width, height)
                return frame, exact_visibility(opened.tracer, frame)

            views = [(name, i) for name in about["frames"]["view_sets"] for i in range(self.views)]
            with ThreadPoolExecutor(self.threads) as pool:
                self._frames[scene] = list(pool.map(render, views))
        return self._frames[scene]
