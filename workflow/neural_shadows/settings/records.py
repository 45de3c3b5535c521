"""Plain data of stages: resolved settings and JSON records."""

from typing import Any, Literal, TypedDict

Bias = float | Literal["held_out"] | None
RadiusUnit = Literal["metres", "scene_sizes", "degrees"]


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
    steps: int  # of a learning curve over frames


class SceneInfo(TypedDict):
    """Description of a hard scene in reports."""

    mesh_name: str
    procedural: bool  # a mesh built from a description
    seed: int  # of the viewpoints
    least_shadow: float  # share of a view's pixels


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


class FrameTimesSettings(TypedDict):
    """Size and number of timed frames."""

    width: int  # pixels
    height: int
    repeats: int


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


class TunedRadius(TypedDict, total=False):
    """Constants of a method for a radius."""

    constants: dict[str, float]
    at_end: list[str]  # those at the first or last candidate


class Tuned(TypedDict, total=False):
    """Constants of a method, of `tune`."""

    method: str
    candidates: dict[str, list[float]]
    radii: list[TunedRadius]
    history: TunedRadius  # for sequences, of a method with a history
    of_history: dict[str, list[float]]  # candidates of its further constants


class FeatureShare(TypedDict):
    """Sensitivity of a network to a feature, of `measure_sensitivity`."""

    sensitivity: float
    share: float  # of all features'
    as_printed: float


class TrainingSettings(TypedDict, total=False):
    """A training's settings, as in the header of its weights."""

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


class WeightsHeader(TypedDict, total=False):
    """Header of a network's weights; `features` to `perceptual` of one of frames."""

    name: str
    network: dict[str, Any]
    training: TrainingSettings | None
    data: dict[str, Any] | None
    features: list[str]
    radii: list[float]
    radius_unit: str
    light: dict[str, Any] | None  # of a `LightShape`; None of a sphere
    scenes: list[str]
    perceptual: str


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
    train_null_mse: dict[str, list[float]]
    data: dict[str, Any]  # of `describe_data`
    shipped: dict[str, str]  # path and SHA-256 of weights that were restored


class FrameTimes(TypedDict, total=False):
    """Times of methods on a scene, of `time_methods`."""

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
    """Times of methods for soft shadows, of `time_methods`."""

    methods: dict[str, dict[str, Any]]
    maps: dict[str, dict[str, float]]
    share: float
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
    formats: list[str]  # asked for
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
    radius_unit: RadiusUnit
    size: float
    channels: list[str]
    scene: "GeneratedScene"
    light: dict[str, Any]  # of a `LightShape`; a sphere without it
    light_map: "LightMapSettings"
    frames: "list[FrameRecord]"
    source: str  # of an engine's frame: its folder
    targets: bool
    edges: bool


class SettingRecord(TypedDict, total=False):
    """A `Setting`; of an engine's frame its lens alone."""

    eye: list[float]  # metres
    target: list[float]
    fov_deg: float
    window: dict[str, int] | None  # of a larger frame
    light: list[float]  # its centre
    motion: list[list[float]]  # of the mover, (4, 4)


class FrameRecord(TypedDict):
    """A frame of a part."""

    setting: SettingRecord
    twins: list[SettingRecord]  # its perturbed frames


class GeneratedScene(TypedDict, total=False):
    """A scene in metres, see `SoftScene`."""

    generate: str
    seed: int | list[int]  # a part's own, of a scene with new layouts
    inserted: dict[str, str]  # up axes by name
    penumbra: float | None
    height: float


class LightMapSettings(TypedDict, total=False):
    """A light's map, see `sections.frame_sets`."""

    kind: Literal["perspective", "cube"]
    resolution: int
    fov: float  # degrees


class Perturbation(TypedDict, total=False):
    """Amplitudes of perturbed frames, see `twin_of`."""

    count: int
    light: float
    eye: float
    turn_deg: float
    light_texels: float
    light_radii: float
    eye_pixels: float


class FrameSettings(TypedDict, total=False):
    """Settings common to the frames of a set."""

    width: int  # pixels
    height: int
    fov: float  # vertical, of the whole frame, degrees
    of: list[int] | None  # width and height of the whole frame
    light: dict[str, Any]  # of a `LightShape`; a sphere without it
    light_map: LightMapSettings
    radii: list[float]
    radius_unit: RadiusUnit
    twins: Perturbation
    blur: float  # σ in pixels


class CurvePoint(TypedDict, total=False):
    """A training of a learning curve."""

    experiment: str
    steps: int
    seed: int
    frames: int  # of each scene, of an experiment on frames
    samples: int  # rays, steps × batch; or different frames
