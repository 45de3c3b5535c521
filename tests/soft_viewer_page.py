"""A small soft viewer, and the scene that it shows as the pipeline sees it."""

import shutil
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
from viewer_page import TEMPLATE, restored_mesh, unpacked

from neural_shadows.frames.buffers import channel_images
from neural_shadows.frames.soft_frame import SoftFrame
from neural_shadows.frames.soft_scene import SoftScene
from neural_shadows.layout.viewers import SHARED
from neural_shadows.meshes.prepared_mesh import all_with_normals
from neural_shadows.rendering.surface import see_surface
from neural_shadows.scenes.arrangement import UP
from neural_shadows.scenes.cameras import Camera
from neural_shadows.scenes.scene import Scene, make_scene
from neural_shadows.shadow_maps.light_map import cube_map
from neural_shadows.viewer.mesh_arrays import MeshArrays
from neural_shadows.viewer.soft_scene_arrays import shown_scene
from neural_shadows.viewer.write_soft_viewer import write_soft_viewer

REPORT = TEMPLATE.parent
WEIGHTS = TEMPLATE.parents[1] / "weights"
NETWORKS = ("kernels_enhanced", "kernels_rays", "nsm_layouts")
RUN = {"scale": "test", "seed": 3, "width": 64, "height": 32, "reference": "exact"}
MAP = 512  # texels along a side
FRAMES = {"fov": 55, "radii": [0, 0.01], "radius_unit": "scene_sizes"}


class SoftPage(NamedTuple):
    """A page, and the scene in it."""

    html: Path
    scene: Scene
    data: dict[str, Any]


def soft_template() -> list[Path]:
    """Files of the soft viewer's page."""
    shared = [path for path in (REPORT / "viewer").rglob("*.*") if path.name in SHARED]
    return shared + [path for path in (REPORT / "soft_viewer").rglob("*.*")]


def make_soft_viewer(folder: Path, scene: dict[str, Any], triangles: int = 500_000) -> SoftPage:
    """Write it, with shipped networks."""
    weights = []
    for name in NETWORKS:
        weights.append(folder / name / "weights.safetensors")
        weights[-1].parent.mkdir(parents=True, exist_ok=True)
        shutil.copy(WEIGHTS / f"{name}.safetensors", weights[-1])
    html = folder / "viewer_soft.html"
    write_soft_viewer(
        html=html,
        png=html.with_suffix(".png"),
        template=soft_template(),
        meshes=[],
        weights=weights,
        labels=NETWORKS,
        name=scene["generate"],
        scene=scene,
        frames=FRAMES,
        triangles=triangles,
        resolution=MAP,
        seed=3,
        run=RUN,
    )
    data, _, _ = shown_scene(SoftScene(scene, []), triangles)
    return SoftPage(html, _restored(data), data)


def _restored(data: dict[str, Any]) -> Scene:
    """The scene of a page's arrays."""
    meshes = []
    for shown in data["objects"]:
        arrays = MeshArrays(*(unpacked(shown["mesh"][key]) for key in ("steps", "codes")))
        arrays = arrays._replace(steps=arrays.steps.reshape(3, -1))
        vertices, faces = restored_mesh(arrays)
        meshes.append((np.float32(vertices * shown["half"] + shown["middle"]), faces))
    return make_scene(*all_with_normals(meshes), up=UP, ground=False, light=None)


def frame_of(page: SoftPage, view: dict[str, Any], size: tuple[int, int]) -> SoftFrame:
    """The pipeline's frame of a view of the page's data."""
    eye, target, light = (np.array(view[key]) for key in ("eye", "target", "light"))
    surface = see_surface(page.scene, Camera(eye, target, UP, view["fov"]), *size)
    return SoftFrame(page.scene, surface, light, cube_map(light, MAP))


def images_of(names: list[str], frame: SoftFrame) -> dict[str, np.ndarray]:
    """Buffers of a frame, (height, width) float32 by name."""
    return channel_images(names, frame)
