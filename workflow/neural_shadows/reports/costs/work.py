"""Work of a job before it runs, one function a rule.

Constants are from jobs of the shipped configuration, measured on `REFERENCE`: a job of
another machine takes longer or shorter as what `rates` measures there does.
"""

import math
import re
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Any

from neural_shadows.evaluation.method import ROUNDS_OF_HISTORY
from neural_shadows.evaluation.registry import is_network, method_of, unbiased
from neural_shadows.frames.uses import RUN_IN
from neural_shadows.layout import evaluations, frame_methods, frame_sets, tables
from neural_shadows.layout.layout import Layout
from neural_shadows.layout.parts import HELD_OUT
from neural_shadows.networks.screen_space.screen_forms import layers_of
from neural_shadows.networks.screen_space.widths import total
from neural_shadows.networks.settings.networks import screen_network
from neural_shadows.sections.frame_sets import VIEWS

REFERENCE = "two cores of an AMD EPYC (Zen 1, 2 GHz) with AVX2 alone"
# Its `Rates`, of one thread. That of loops was not measured there: with 255 jobs there and on an EPYC of
# 543 · 10⁶ exponentials, AVX2 alone too, agree.
REFERENCE_RATES = {
    "products": 20.4,
    "convolutions": 21.5,
    "rays": 3.0,
    "loops": 255.0,
    "start": 4.1,
}

START = 4.5  # seconds of a process that imports torch
LIGHT_START = 1.5  # of one that does not


@dataclass(frozen=True)
class Work:
    """Work of a job.

    Args:
        start: seconds on `REFERENCE` that its process takes to start.
        seconds: on `REFERENCE`, of all that the others do not count.
        products: multiply-adds of a network on rays, 10⁹.
        convolutions: of a screen-space network, 10⁹.
        rays: occlusion rays, 10⁶.
    """

    start: float = 0.0
    seconds: float = 0.0
    products: float = 0.0
    convolutions: float = 0.0
    rays: float = 0.0

    def __add__(self, other: "Work") -> "Work":
        return Work(*(a + b for a, b in zip(vars(self).values(), vars(other).values())))

    def __mul__(self, factor: float) -> "Work":
        return Work(*(factor * value for value in vars(self).values()))


# Rays.


def sample_rays(layout: Layout, scene: str, sampling: str, shard: str) -> Work:
    settings, ends = layout.entry("samplings", sampling), layout.shard_range(sampling, shard)
    samples = (ends["last"] - ends["first"]) * settings["points_per_direction"]
    return Work(LIGHT_START, 1.3e-6 * samples)


# Trainings.

# Seconds of a grid's and a field's sample in training, and of a grid's ray in a query, on one thread.
# Two threads train a grid 1.66 times and a field 1.46 times as fast, which is not counted.
GRID_SAMPLE, FIELD_SAMPLE, GRID_RAY = 28e-6, 1.6e-6, 35e-6
BUILT = {"mesh": 1.5, "occupancy_field": 8.5, "voxel_dag": 20.5, "height_map": 0.5}
# Rate of a training on frames, its loss and optimiser included, as a share of that of convolutions.
SHARE_OF_CONVOLUTIONS = 0.38


def train(layout: Layout, experiment: str) -> Work:
    entry = layout.entry("experiments", experiment)
    if "frame_set" in entry:
        return _train_on_frames(entry["network"], entry["training"])
    network, training = entry["network"], entry["training"]
    if training is None:
        return Work(START, BUILT.get(network["encoding"], 0.0))
    samples = training["steps"] * training["batch_size"]
    if network["encoding"] == "occupancy_field":
        distances = 8.0 * (network["start"] != "undecided")
        return Work(START, distances + FIELD_SAMPLE * samples)
    if network["encoding"] != "frequency":
        return Work(START, GRID_SAMPLE * samples)
    macs = 3 * samples * _macs_of_ray(network)
    if training["optimiser"] == "muon":  # 15 products of each hidden matrix with itself a step
        macs += 15 * training["steps"] * network["hidden_layers"] * network["width"] ** 3
    activations = network["hidden_layers"] * network["width"]
    return Work(START, 4e-9 * activations * samples, products=macs / 1e9)


def _macs_of_ray(network: Mapping[str, Any]) -> float:
    """Multiply-adds of a frequency network for a ray."""
    inputs, width = 6 + 12 * network["frequencies"], network["width"]
    return (inputs + network["hidden_layers"] * width + 1) * width


def _train_on_frames(network: Mapping[str, Any], training: Mapping[str, Any]) -> Work:
    pixels = training["steps"] * training["crops"] * training["crop"] ** 2
    # Forward once and backward twice, of a perturbed frame forward alone.
    perturbed = (1 - training["perturbation_from"]) * (training["perturbation"] > 0)
    macs = pixels * _macs_of_pixel(network) * (3 + perturbed)
    return Work(START, 2 * START, convolutions=macs / 1e9 / SHARE_OF_CONVOLUTIONS)


def _macs_of_pixel(network: Mapping[str, Any]) -> float:
    """Multiply-adds of a screen-space network for a pixel."""
    return total(layers_of(screen_network(network)), "macs")


# Views of meshes under a sun.


def _views(layout: Layout, scene: str, batch: str) -> float:
    """Pixels of a batch of views, 10⁶."""
    settings = layout.mesh_scene(scene)["frames"]
    ends = layout.view_range(batch)
    views = (ends["last"] - ends["first"]) * len(settings["view_sets"])
    return views * settings["width"] * settings["height"] / 1e6


def render_references(layout: Layout, scene: str, batch: str) -> Work:
    return Work(LIGHT_START, 0.8 * _views(layout, scene, batch))


def count_violations(layout: Layout, scene: str, method: str, batch: str) -> Work:
    pixels = _views(layout, scene, batch)
    return Work(START, rays=2 * SEEN * pixels) + _query(layout, method, pixels)


# Share of pixels that face the light.
SEEN = 0.55


def _query(layout: Layout, method: str, pixels: float, share: float = SEEN) -> Work:
    """Queries of a network on rays in 10⁶ pixels, a share of which face the light."""
    network = layout.on_rays(unbiased(method))["network"]
    rays = 1e6 * share * pixels
    if network["encoding"] == "frequency":
        return Work(products=rays * _macs_of_ray(network) / 1e9)
    return Work(seconds=rays * (GRID_RAY if "grids" in network else 0.4e-6))


# Frames under area lights.


def _size(layout: Layout, frame_set: str, use: str = "test") -> float:
    """Pixels of a frame, 10⁶; of a user's frames a guess."""
    frames = layout.frames(frame_set)
    width = frames.get("train_width") if use == "train" else None
    return (width or frames.get("width", 1024)) * frames.get("height", 1024) / 1e6


def _lights(layout: Layout, frame_set: str) -> int:
    return len(layout.frames(frame_set).get("radii", [0]))


def _tested(layout: Layout, frame_set: str) -> float:
    """Pixels of all test frames and sequences, 10⁶."""
    files = [*frame_sets.tests(layout, frame_set), *frame_sets.sequences(layout, frame_set)]
    return _pixels(layout, frame_set, files)


def _pixels(layout: Layout, frame_set: str, files: list[str]) -> float:
    """Pixels of the frames of some parts, 10⁶."""
    if layout.frames(frame_set)["path"] is not None:
        return len(files) * _size(layout, frame_set)  # one frame each
    count = 0
    for file in files:
        scene, part = file.removesuffix(".json").split("/")[-2:]
        settings = frame_sets.frame_settings(layout, scene, frame_set, part)
        count += settings["last"] - settings["first"]
    return count * _size(layout, frame_set)


def render_frames(layout: Layout, scene: str, frame_set: str, part: str) -> Work:
    settings = frame_sets.frame_settings(layout, scene, frame_set, part)
    frames = settings["last"] - settings["first"]
    pixels = frames * _size(layout, frame_set, settings["use"])
    targets = pixels * _lights(layout, frame_set)
    seconds = 2.4 * pixels * (1 + settings["frames"]["twins"]["count"])
    # Eight places of a pixel, in penumbrae with `samples`² rays each.
    return Work(START, seconds, rays=0.33 * targets * settings["samples"] ** 2)


def fit_fields(layout: Layout, frame_set: str) -> Work:
    return Work(START, 17.0 * len(frame_sets.measured_scenes(layout, frame_set)))


# Seconds of a field's fit by its cells in a slice, of a direction's tables likewise, and of a ray: all
# 217 directions and half of the rays face away.
FIT_CELL, TABLE_CELL, FIELD_RAY = 3e-5, 3.5e-8, 1e-7


def measure_sun_hours(layout: Layout, table: str, scene: str) -> Work:
    entry = layout.entry("tables", table)
    directions, cells = 145 + 720 / entry["minutes"], entry["resolution"] ** 2
    pixels = 0.4 * entry["width"] ** 2 / 1.6
    rays = directions * (entry["points"] + pixels) / 2
    seconds = FIT_CELL * cells + 2 * TABLE_CELL * directions * cells + FIELD_RAY * rays
    return Work(START, seconds, rays=directions * entry["points"] / 2e6)


def measure_frames(layout: Layout, frame_set: str, measure: str) -> Work:
    tests = frame_sets.tests(layout, frame_set)
    return Work(LIGHT_START, 10.0 * _pixels(layout, frame_set, tests))


def measure_sensitivity(layout: Layout, frame_set: str, experiment: str) -> Work:
    network = layout.on_frames(experiment)["network"]
    validations = frame_sets.validations(layout, frame_set)
    answers = _pixels(layout, frame_set, validations) * _lights(layout, frame_set)
    answers *= 1 + len(network["features"])
    return Work(START, convolutions=answers * _macs_of_pixel(network) / 1e3)


# Seconds of a method for 10⁶ pixels of a light, by the words of its key: a number counts what the
# word before it is.
WORDS = {"cone": 2.8, "field": 0.4, "pcss": 1.0, "2048": 0.6, "post": 0.4}
WORDS |= {
    "ffx": 0.4,
    "sigma": 0.8,
    "svgf": 1.7,
    "oidn": 5.6,
    "fast": -2.8,
    "spread": 0.8,
    "disc": 0.6,
    "mssm": 1.2,
}
COUNTED = {"cone": 0.3, "field": 0.7, "pcf": 0.02}
OTHER = 0.05
SHARED = 3.7  # settings of the SVGF-like filter share their passes: 7.5 s in place of 28 s a frame
SHARED_FIRST = 10.0  # those of the SIGMA- and FFX-like ones also rays and the picture of the first
# Settings of a history share rays and look-ups: four took 0.31 to 0.54 of their time without that.
SHARED_BY_A_HISTORY = 0.45


def _answers(layout: Layout, method: str, pixels: float) -> Work:
    """Answers of a method for 10⁶ pixels of a light each."""
    if is_network(method):
        experiment = layout.on_frames(frame_methods.experiments(layout, method)[0])
        return Work(convolutions=pixels * _macs_of_pixel(experiment["network"]) / 1e3)
    seconds = OTHER + sum(WORDS.get(word, 0.0) for word in method.split("_"))
    counted = re.match(r"([a-z]+)_(\d+)", method)
    name, number = (counted[1], int(counted[2])) if counted else ("", 0)
    # Of the pixels that face the light; the exact method takes 256 rays in penumbrae alone.
    rays = 0.3 * number * (name == "rt") + 24 * method.startswith("exact")
    return Work(seconds=seconds + number * COUNTED.get(name, 0.0), rays=rays) * pixels


# Methods, on views and frames.


def tune(layout: Layout, frame_set: str, group: str, method: str) -> Work:
    if frame_set == VIEWS:
        pixels = _views(layout, group, HELD_OUT)
        if is_network(method):
            return Work(START, 2.0 * pixels) + _query(layout, method, pixels)
        return Work(LIGHT_START, 1.0 * pixels)
    tuned_parts = frame_sets.tuned_parts(layout, frame_set).items()
    pixels = sum(_pixels(layout, one, parts) for one, parts in tuned_parts)
    tuned = method_of(method)
    # Those of a last filter answer once.
    own = {name: values for name, values in tuned.constants.items() if name not in tuned.of_last}
    counts = [len(values) for values in own.values()]
    # On frames a search tries nothing twice: of PCSS's constants a second round takes 0.2 to 0.4 of the first's time.
    one_by_one = (1 + sum(counts) - len(counts) + bool(tuned.of_last)) * (3 + tuned.rounds) / 4
    tried = math.prod(counts) if tuned.joint else one_by_one
    if "passes" in tuned.constants:
        tried /= SHARED * (SHARED_FIRST if "reach" in tuned.constants else 1)
    answers = tried * pixels * _lights(layout, frame_set)
    if frame_methods.has_history(method):
        in_sequences = len(frame_sets.tuned_sequences(layout, frame_set))
        in_sequences *= RUN_IN + layout.frames(frame_set)["sequence"]
        # A later round repeats most of the first, of one constant all.
        rounds = (1 + ROUNDS_OF_HISTORY) / 2 if len(tuned.of_history) > 1 else 1
        of_history = rounds * sum(map(len, tuned.of_history.values()))
        answers += of_history * SHARED_BY_A_HISTORY * in_sequences * _size(layout, frame_set)
    return Work(LIGHT_START, 5.0 * pixels) + _answers(layout, method, answers)


def evaluate(layout: Layout, frame_set: str, group: str, method: str) -> Work:
    if frame_set == VIEWS:
        pixels = _views(layout, *group.split("."))
        if is_network(method):
            return Work(START, 0.7 * pixels) + _query(layout, method, pixels)
        return Work(LIGHT_START, 0.7 * pixels)
    pixels = _tested(layout, frame_set)
    answers = pixels * _lights(layout, frame_set)
    return Work(START, START + 0.5 * answers) + _answers(layout, method, answers)


def answer_frames(layout: Layout, frame_set: str, method: str) -> Work:
    return evaluate(layout, frame_set, "all", method)


def time_methods(layout: Layout, table: str, group: str) -> Work:
    methods = evaluations.timed_methods(layout, table, group)
    if not evaluations.on_views(layout, table):
        frame_set = layout.entry("tables", table)["frame_set"]
        # Two frames; what takes little up to three times. Of windows whole frames, after the window once.
        whole, size = layout.frames(frame_set).get("of"), _size(layout, frame_set)
        pixels = size + math.prod(whole) / 1e6 if whole else 3 * size
        answers = 2 * pixels * _lights(layout, frame_set)
        work = Work(START, START + 0.5 * len(methods))
        return sum((_answers(layout, method, answers) for method in methods), work)
    times = layout.settings["frame_times"]
    pixels = (times["repeats"] + 2) * times["width"] * times["height"] / 1e6
    timed = {unbiased(key): experiment for key, experiment in methods.items()}
    work = Work(START, 0.13 * pixels * len(timed))
    for experiment in filter(None, timed.values()):
        work += _query(layout, experiment, pixels, 0.35)
    return work


def profile_screen_network(layout: Layout, network: str) -> Work:
    profile = layout.settings["screen_profiles"]
    macs = _macs_of_pixel(layout.entry("networks", network))
    frame = profile["width"] * profile["height"] * macs / 1e9
    product = profile["product_size"] ** 3 / 1e9
    # A minute at most, of five repetitions at least: here at 20 · 10⁹ multiply-adds a second.
    repeats = max(5.0, min(profile["repeats"] + 2, 60 * 20 / (2 * frame + product)))
    # On one thread and on all, whole and by part; or on all, in the formats that tables show.
    formats = tables.profiled_formats(layout, network)
    runs, passes = (len(formats), 1) if formats else (2, 2)
    convolutions = runs * passes * repeats * frame
    return Work(START, products=runs * repeats * product, convolutions=convolutions)


# All others take about as long whatever the configuration, their starts among it: seconds by rule.
CONSTANT = {"get_mesh": 5.0, "prepare_mesh": 2.5, "find_lpips": 6.5, "export_network": 6.0}
CONSTANT |= {"table": 4.0, "figure": 6.0, "preview_scene": 5.0, "viewer": 6.0, "claims": 10.0}
CONSTANT |= {"page": 20.0, "all": 0.0, "expected_minutes": 16.5, "restore_weights": START}
CONSTANT |= {"manifest": 6.0, "draw_directions": LIGHT_START, "describe_rays": 2 * LIGHT_START}
CONSTANT |= {"import_frame": 2 * LIGHT_START}

BY_RULE: dict[str, Callable[..., Work]] = {
    function.__name__: function
    for function in (
        *(sample_rays, train, render_references, count_violations),
        *(render_frames, fit_fields, measure_frames, measure_sensitivity),
        *(measure_sun_hours,),
        *(tune, evaluate, answer_frames, time_methods, profile_screen_network),
    )
}


def work_of(layout: Layout, rule: str, wildcards: Mapping[str, str]) -> Work:
    """Work of a rule's job."""
    if rule in BY_RULE:
        return BY_RULE[rule](layout, **wildcards)
    seconds = CONSTANT.get(rule, START)
    start = min(seconds, START)
    return Work(start, seconds - start)
