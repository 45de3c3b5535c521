"""Plain data of stages: resolved settings and JSON records."""

from typing import Any, Literal, TypedDict

Bias = float | Literal["held_out"] | None


class Run(TypedDict):
    """Run of a report: scale, seed and hard frames."""

    scale: str
    seed: int  # of the bootstrap
    width: int  # pixels
    height: int
    reference: Literal["exact", "shadow_map"]


class Row(TypedDict, total=False):
    """A method on a scene: a row of a report."""

    method: str  # key
    label: str
    published: str | None  # its key in published.csv
    scene: str
    experiment: str | None  # of a network
    encoding: str | None
    trained: bool
    bias: Bias  # of the depth test, sphere radii
    width: int  # neurons a layer, in a figure of widths


class SceneInfo(TypedDict):
    """Description of a hard scene in reports."""

    mesh_name: str
    procedural: bool  # a mesh built from a description
    seed: int  # of the viewpoints


class SceneSettings(TypedDict):
    """Arguments of `open_scene` besides the mesh."""

    up: Literal["x", "y", "z"]
    ground: bool
    light: "LightSettings"


class LightSettings(TypedDict, total=False):
    """A domain of directional lights."""

    domain: Literal["sphere", "single_axis"]
    min_elevation_deg: float
    axis: Literal["x", "y", "z"]


class ViewSettings(TypedDict):
    """Viewpoints of a scene and their frames."""

    width: int  # pixels
    height: int
    view_sets: list[str]
    least_shadow: float  # share of a viewpoint's surface
    seed: int


class SamplingSettings(TypedDict, total=False):
    """Sampling of training rays, see `sections.samplings.Sampling`."""

    sampler: str
    domain: str
    directions: int
    points_per_direction: int
    silhouette_resolution: int
    min_quad: int
    shards: int


class MeshSource(TypedDict, total=False):
    """Source of a mesh, see `sections.scenes.Mesh`."""

    generate: str
    download: str
    path: str
    cells: int
    wires: int
    wire_radius: float


class MeshReport(TypedDict, total=False):
    """mesh.json, of `prepare_mesh`."""

    name: str
    faces: int
    watertight: bool
    sheet: bool
    thesis_mesh: bool
    centre: list[float]
    radius: float


class DepthBias(TypedDict):
    """The depth bias of a method."""

    depth_bias: float  # sphere radii
    push: float  # cells
    at_end: bool  # at the first or last candidate


class TrainingSettings(TypedDict, total=False):
    """A training's settings, see `sections.trainings` and `sections.screen_trainings`."""

    optimiser: str
    steps: int
    batch_size: int
    learning_rate: float
    adam_rate: float
    schedule: str
    loss: dict[str, float]
    crops: int
    crop: int
    tenth_from: list[int]
    alpha: float
    perceptual: dict[str, Any]
    perturbation: float
    perturbation_from: float
    aligned: bool
    flips: bool
    lights: list[int] | None
    seed: int
    device: str
    precision: str


class TrainingRecord(TypedDict, total=False):
    """training.json of a network."""

    name: str
    network: dict[str, Any]
    training: TrainingSettings | None
    parameters: int
    samples: int
    seconds: float
    threads: int
    machine: dict[str, Any]
    commit: str
    unfit: bool
    died_at_step: int | None
    no_shadow_loss: float
    scenes: list[str]
    radii: list[float]
    perceptual: str
    train_mse: list[float | None]
    validation_mse: list[float | None]
    validations: list[dict[str, Any]]
    null_mse: dict[str, list[float]]


class FrameTimes(TypedDict, total=False):
    """Times of methods on a scene, of `measure_frame_times`."""

    scene: str
    methods: dict[str, dict[str, Any]]
    rays_per_second: dict[str, list[float]]
    repeats: int
    warm_up: int
    views: int
    width: int
    height: int
    precision: str
    sphere_rays: float
    machine: dict[str, Any]


class SoftTimes(TypedDict, total=False):
    """Times of methods for soft shadows, of `time_soft_methods`."""

    methods: dict[str, dict[str, Any]]
    maps: dict[str, dict[str, float]]
    map_share: float
    frames: int
    repeats: int
    once_above_ms: float
    machine: dict[str, Any]


class ProfileRun(TypedDict, total=False):
    """A screen-space network timed on a device, in a number format."""

    device: str
    threads: int
    precision: str
    whole_ms: float
    product_macs: float
    parts: list[dict[str, Any]]


class Profile(TypedDict, total=False):
    """The times of a screen-space network, of `profile_screen_network`."""

    network: dict[str, Any]
    width: int
    height: int
    repeats: int
    warm_up: int
    product_size: int
    levels: list[dict[str, Any]]
    runs: list[ProfileRun]
    machine: dict[str, Any]


class Lpips(TypedDict, total=False):
    """lpips.json, of `find_lpips`."""

    available: bool
    net: str


class PartRecord(TypedDict, total=False):
    """The JSON of a part of a frame set."""

    width: int
    height: int
    radii: list[float]  # scene's unit
    given_radii: list[float]  # as configured
    radius_unit: Literal["metres", "scene_sizes"]
    size: float
    channels: list[str]


class CurvePoint(TypedDict):
    """A training of a learning curve."""

    experiment: str
    steps: int
    seed: int
    samples: int
