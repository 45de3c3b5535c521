"""The stages of methods for soft shadows, on a few tiny frames."""

import json
from dataclasses import replace
from functools import partial

import numpy as np
import pytest
import torch
from opened import evaluate_frames, frame_method, settings_of
from rendered_frames import FRAMES, render_part
from threadpoolctl import threadpool_info

from neural_shadows.denoising.taa import ORDER, blended, recursive
from neural_shadows.errors import InputError
from neural_shadows.evaluation import time_frames as timing
from neural_shadows.evaluation.answers import read_answer
from neural_shadows.evaluation.flicker import flicker
from neural_shadows.evaluation.frame import constants_of, sequence_constants_of
from neural_shadows.evaluation.measured_frames import measured_frames
from neural_shadows.evaluation.method import Method
from neural_shadows.evaluation.metric_files import read_metrics
from neural_shadows.evaluation.registry import METHODS
from neural_shadows.evaluation.sequences import squared_error, steps_of
from neural_shadows.evaluation.time_frames import least
from neural_shadows.evaluation.time_methods import time_methods
from neural_shadows.evaluation.tune import tune as tune_stage
from neural_shadows.frames import soft_frame
from neural_shadows.frames.uses import RUN_IN
from neural_shadows.rendering.reprojection import looked_up
from neural_shadows.rendering.surface import see_surface
from neural_shadows.reports.data.soft_costs import describe_times

RADII = FRAMES["radii"]


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    """Parts of two uses and of two sequences, in the folder of their scene."""
    folder = tmp_path_factory.mktemp("results") / "blinds"
    for use in ("validation", "validation_both", "test", "camera", "light"):
        render_part(folder, use)
    (folder / "lpips.json").write_text(json.dumps({"available": False}))
    return folder


def tune(folder, method):
    out = folder / f"{method}.json"
    tune_stage([folder / "validation_000.json"], [], [], out, method=method)
    return json.loads(out.read_text())


@pytest.mark.parametrize("key", ["pcf_9", "rt_1_svgf"])
def test_the_constants_of_least_error_are_chosen(folder, key):
    """One constant by itself, and two jointly."""
    record, method = tune(folder, key), frame_method(key)
    frames = [*measured_frames([folder / "validation_000.json"], [])]
    for k, radius in enumerate(RADII):
        errors = []
        for constants in settings_of(method):
            pairs = [
                (f.answered(method, radius, constants), f.target[k], f.off_edges) for f in frames
            ]
            square = sum(np.square(found - target)[valid].sum() for found, target, valid in pairs)
            errors.append(square / sum(valid.sum() for *_, valid in pairs))
        chosen = record["radii"][k]
        assert chosen["constants"] == settings_of(method)[int(np.argmin(errors))]
        assert chosen["error"] == pytest.approx(min(errors), rel=1e-4)


def test_no_other_value_of_the_last_constant_is_better(folder):
    method = frame_method("pcf_disc")
    texels, biases = method.constants.values()
    (frame, *rest) = measured_frames([folder / "validation_000.json"], [])

    def mse(k, constants):
        squares = [
            np.square(one.answered(method, RADII[k], constants) - one.target[k])[one.off_edges]
            for one in (frame, *rest)
        ]
        return np.concatenate(squares).mean()

    for k, found in enumerate(tune(folder, "pcf_disc")["radii"]):
        chosen = found["constants"]
        assert found["error"] == pytest.approx(
            min(mse(k, chosen | {"bias": bias}) for bias in biases), rel=1e-4
        )
        # and of the first none is, at the bias in the middle
        first = {one: mse(k, {"texels": one, "bias": biases[len(biases) // 2]}) for one in texels}
        assert chosen["texels"] == min(first, key=first.get)


def test_the_search_of_a_filtered_method_begins_without_its_filter(folder):
    """So that its other constants are those of the method alone, and it is no worse than that."""
    alone, filtered = (tune(folder, method)["radii"] for method in ("pcss", "pcss_post"))
    for one, other in zip(alone, filtered):
        assert {**one["constants"], "width": other["constants"]["width"]} == other["constants"]
        assert other["error"] <= one["error"]


@pytest.mark.parametrize(("rounds", "off"), [(1, 0.15), (2, 0.05)])
def test_a_second_round_chooses_each_constant_anew(folder, monkeypatch, rounds, off):
    """Of an even grey 0.3 too dark at first: so much brighter by its second constant that the first is off."""
    frames = [*measured_frames([folder / "validation_000.json"], [])]
    mean = float(np.concatenate([one.target[1][one.off_edges] for one in frames]).mean())
    constants = {"grey": (mean - 0.5, mean - 0.3), "more": (0.0, 0.1, 0.45)}
    asked = []

    def answer(frame, radius, grey, more):
        asked.append((frame.number, radius, grey, more))
        return np.full(len(frame.starts), grey + more, np.float32)

    even = Method(answer, constants, "Even", rounds=rounds, by_rays=True)
    monkeypatch.setitem(METHODS, "pcf_9", even)
    found = tune(folder, "pcf_9")["radii"][1]["constants"]
    # The second constant's middle value was tried with the first's.
    assert len(asked) == len(set(asked))
    assert abs(sum(found.values()) - mean) == pytest.approx(off)


def evaluate(folder, method):
    target = folder / "frames"
    target.mkdir(exist_ok=True)
    if METHODS[method].constants:
        tune(folder, method)
    evaluate_frames(
        [folder / "test_000.json"],
        folder / "lpips.json",
        (target / f"{method}.csv", target / f"{method}.npz"),
        sequences=[folder / "camera_000.json", folder / "light_000.json"],
        constants=folder / f"{method}.json" if METHODS[method].constants else None,
        method=method,
    )
    return read_metrics([target / f"{method}.csv"])


def means(table):
    return table.groupby(["radius", "metric"])["value"].mean().unstack()


def test_metrics_of_methods(folder):
    found = {method: evaluate(folder, method) for method in ("no_shadow", "hard", "rt_64")}
    table = found["rt_64"]
    assert set(table["scene"]) == {"blinds"} and set(table["method"]) == {"rt_64"}
    assert len(table[table["metric"] == "mse"]) == 2 * len(RADII)
    pictures = table[table["metric"] == "flip"]
    assert [*zip(pictures["frame"], pictures["radius"])] == [(0, len(RADII) // 2)]
    mse = {method: means(one)["mse"] for method, one in found.items()}
    assert np.all(mse["rt_64"] < mse["hard"]) and np.all(mse["hard"] < mse["no_shadow"])
    nothing = means(found["no_shadow"])
    assert np.allclose(nothing["light_leak"] + nothing["false_shadow"], nothing["l1"])
    assert np.all(nothing["light_leak"] > 10 * nothing["false_shadow"])
    # The exact shadow flickers alike, whoever asks; no shadow hardly does.
    flickers = {method: means(one).loc[1] for method, one in found.items()}
    same = [one["instability_reference"] for one in flickers.values()]
    assert np.ptp(same) == 0 < same[0]
    assert flickers["no_shadow"]["instability"] < flickers["hard"]["instability"]


def test_new_rays_flicker_and_a_filter_calms_them(folder):
    found = {method: means(evaluate(folder, method)).loc[1] for method in ("rt_1", "rt_1_svgf")}
    noise = {method: one["instability"] for method, one in found.items()}
    assert noise["rt_1"] > 4 * found["rt_1"]["instability_reference"]  # new rays in each frame
    assert noise["rt_1_svgf"] < noise["rt_1"] / 2


def showing(image_of, history=True):
    """A method that shows images (H, W) by the number of a sequence's frame, at rest the first."""

    def answer(frame, radius):
        return image_of(max(frame.number - RUN_IN, 0)).ravel()[frame.surface.pixel]

    sequence = (lambda radius: lambda frame, back: answer(frame, radius)) if history else None
    return Method(answer, by_rays=True, sequence=sequence)


def in_motion(frames, method, constants=None):
    """Metrics of a sequence."""
    none = [{}] * len(RADII)
    return flicker(frames, method, none, constants or none, lambda: None)[1]


def test_a_history_is_measured_after_a_rest_in_the_first_view(folder):
    """Which a method without noise has learned by then: 1 − 0.5 to the number of frames."""
    steps = []

    def sequence(radius):
        def step(frame, back):
            steps.append((frame.number, back is None))
            return np.full(len(frame.surface.p), 1 - 0.5 ** len(steps), np.float32)

        return step

    method = Method(lambda frame, radius: frame.cosines, label="grows", sequence=sequence)
    frames = [*measured_frames([folder / "camera_000.json"], [])]
    values = in_motion(frames, method)
    assert len(frames) > 1
    assert steps == [(number, number == 0) for number in range(RUN_IN + len(frames))]
    assert values["instability"] < 3 * 0.5**RUN_IN < 0.5 * values["instability_reference"]


def test_errors_of_sequences_are_off_the_edges_of_geometry(folder):
    """There an exact shadow of pixels' centres errs, too, and a blur may err less."""
    frames = [*measured_frames([folder / "camera_000.json"], [])]

    def exact_but_at_edges(number):
        now = frames[number]
        return np.where(now.part.edges[number], 1 - now.target[now.middle], now.target[now.middle])

    method = showing(exact_but_at_edges)
    values = in_motion(frames, method)
    assert np.mean([frame.off_edges.sum() / frame.valid.sum() for frame in frames]) < 0.95
    assert values["mse_sequence_off_edges"] < 1e-12 < 1e-4 < values["mse_sequence_off_edges_taa"]
    # A point's look-up is between pixels, some of which are at edges.
    assert values["mse_change_off_edges"] < values["mse_change"] / 4
    assert values["mse_sequence"] > 1e-3
    assert squared_error([*steps_of(frames)], method, {}) < 1e-12


def test_what_lags_changes_otherwise_than_the_exact_shadow(folder):
    """Though its E is less; what is exact has no such error."""
    frames = [*measured_frames([folder / "light_000.json"], [])]
    target = [frame.target[frame.middle] for frame in frames]
    exact, resting = (
        in_motion(frames, showing(lambda number, of=of: target[of(number)]))
        for of in (lambda number: number, lambda number: 0)
    )
    assert exact["mse_change"] == 0 < exact["instability"]
    assert resting["mse_change"] > 1e-5 and resting["instability"] < exact["instability"] / 100


def test_noise_changes_where_the_exact_shadow_does_not(folder):
    """Independent frames differ by twice their variance, and by less behind TAA."""
    frames = [*measured_frames([folder / "camera_000.json"], [])]
    rng = np.random.default_rng(0)
    noise = rng.normal(0, 0.1, (len(frames), *frames[0].valid.shape)).astype(np.float32)
    shown = [frame.target[frame.middle] + each for frame, each in zip(frames, noise)]
    values = in_motion(frames, showing(shown.__getitem__, history=False))
    assert 0.01 < values["mse_change"] < 2.2 * 0.01  # bilinear look-ups may smooth one of the two
    assert values["mse_change_recursive"] < values["mse_change_taa"] < values["mse_change"]
    assert not any(name.endswith("_single") for name in values)


def test_taa_stands_behind_single_frames_in_the_place_of_a_history(folder):
    frames = [*measured_frames([folder / "camera_000.json"], [])]
    images = np.random.default_rng(0).random((len(frames), *frames[0].valid.shape), np.float32)
    with_history = replace(
        showing(images.__getitem__), sequence=showing(lambda _: images[0]).sequence
    )
    values = in_motion(frames, with_history)
    squares, before, shown = {"taa": [], "recursive": []}, None, None
    for image, step in zip(images, steps_of(frames)):
        now = step.now
        single = now.frame.surface.image(image.ravel()[now.frame.surface.pixel], 1.0)
        if before is None:
            before = shown = single
            continue
        accepted, places = step.seen
        pixel, places = now.frame.surface.pixel[accepted], places[:, accepted]
        by_one = blended(single, pixel, looked_up(before, places))
        before, shown = single, recursive(single, pixel, looked_up(shown, places, ORDER))
        for name, image_shown in (("taa", by_one), ("recursive", shown)):
            squares[name].append(np.square(image_shown - now.target[now.middle])[now.valid].mean())
    for name, each in squares.items():
        assert values[f"mse_sequence_{name}"] == pytest.approx(np.mean(each), rel=1e-5)
    assert values["mse_sequence_single"] != values["mse_sequence"]


def test_constants_for_sequences_are_chosen_with_the_history(folder):
    """Of all sequences, the others being those of single frames; an evaluation takes them there, by any radius."""
    out, sequence = folder / "rt_1_ffx.json", folder / "validation_both_000.json"
    both = [sequence, folder / "camera_000.json"]
    tune_stage([folder / "validation_000.json"], [], [], out, sequences=both, method="rt_1_ffx")
    record, method = json.loads(out.read_text()), frame_method("rt_1_ffx")
    assert record["of_history"] == {name: [*each] for name, each in method.of_history.items()}
    chosen = record["history"]["constants"]
    assert chosen.items() > record["radii"][len(RADII) // 2]["constants"].items()
    by_sequence = [
        [
            in_motion(frames, method, [chosen | {"share": value}] * len(RADII))
            for value in method.of_history["share"]
        ]
        for frames in ([*measured_frames([path], [])] for path in both)
    ]
    errors = [[each["mse_sequence_off_edges"] for each in values] for values in by_sequence]
    assert errors[0] != errors[1]
    best = np.mean(errors, axis=0).argmin()
    assert chosen["share"] == method.of_history["share"][best]
    steps = [[*steps_of(measured_frames([path], []))] for path in both]
    of_clamp = [
        sum(squared_error(each, method, chosen | {"clamp": clamp}) for each in steps)
        for clamp in method.of_history["clamp"]
    ]
    assert chosen["clamp"] == method.of_history["clamp"][np.argmin(of_clamp)]
    tried = [each["mse"] for each in record["history"]["tried"]]
    assert tried == pytest.approx(np.mean(errors, axis=0))
    assert len(set(tried)) > 3  # the constant has an effect
    assert sequence_constants_of(out, 3) == [chosen] * 3
    assert [each["constants"] for each in record["radii"]] == constants_of(out)
    assert sequence_constants_of(None, 2) == [{}] * 2
    target = folder / "rt_1_ffx.csv", folder / "rt_1_ffx.npz"
    evaluate_frames(
        [folder / "test_000.json"],
        folder / "lpips.json",
        target,
        sequences=[sequence],
        constants=out,
        method="rt_1_ffx",
    )
    measured = read_metrics([target[0]])
    (mse,) = measured[measured["metric"] == "mse_sequence"]["value"]
    assert mse == pytest.approx(by_sequence[0][best]["mse_sequence"])


def test_answers_are_kept(folder):
    evaluate(folder, "rt_1")
    (measured, _) = measured_frames([folder / "test_000.json"], [])
    found = measured.answered(frame_method("rt_1"), 0.1, {})
    kept = read_answer(folder / "frames/rt_1.npz", "blinds.test_000.1")
    assert np.array_equal(kept, found)
    with pytest.raises(InputError, match="rt_1.npz: damaged"):
        read_answer(folder / "frames/rt_1.npz", "blinds.test_001.1")


def test_times(folder):
    names = ["hard", "msm_3", "rt_1", "pcss_2048"]
    for name in ("hard", "msm_3", "pcss_2048"):
        tune(folder, name)
    out = folder / "times.json"
    time_methods(
        [folder / "test_000.json"],
        [],
        [folder / f"{name}.json" for name in ("hard", "msm_3", "pcss_2048")],
        [],
        [],
        out,
        methods=dict.fromkeys(names),
        repeats=1,
    )
    found = json.loads(out.read_text())
    own, finer = found["maps"]["64"], found["maps"]["2048"]
    assert own["texels"] == 64**2 and finer["texels"] == 2048**2 and found["frames"] == 1
    assert 0 < own["ms"] < finer["ms"]
    sides = {name: found["methods"][name]["map"] for name in names}
    assert sides == {"hard": "64", "msm_3": "64", "rt_1": None, "pcss_2048": "2048"}
    floats = {name: found["methods"][name]["texel_floats"] for name in names}
    assert floats == {"hard": 1, "msm_3": 4, "rt_1": 0, "pcss_2048": 1}
    assert all(ms > 0 for name in names for ms in found["methods"][name]["ms"])


def test_all_is_timed_on_the_one_thread_that_tables_name(folder, monkeypatch):
    """However many Snakemake tells the libraries of: networks were once timed on two."""
    seen = []

    def answer(frame, radius):
        pools = {one["num_threads"] for one in threadpool_info()}
        seen.append(pools | {torch.get_num_threads()})
        return np.ones(len(frame.from_light), np.float32)

    recording = Method(answer)
    monkeypatch.setattr(timing, "open_methods", lambda name, inputs: lambda scene: recording)
    before, out = torch.get_num_threads(), folder / "threads.json"
    torch.set_num_threads(2)
    try:
        parts = [folder / "test_000.json"]
        time_methods(parts, [], [], [], [], out, methods={"mine": None}, repeats=1)
        assert torch.get_num_threads() == 2
    finally:
        torch.set_num_threads(before)
    assert seen and set.union(*seen) == {1}
    assert "one thread of" in describe_times(json.loads(out.read_text()))[0]


def test_a_method_pays_for_what_it_sees_at_other_places(folder, monkeypatch):
    """The warm-up's surfaces made four rays at four places a quarter as dear as they are."""
    calls, traced = [], []

    def answer(frame, radius):
        calls.append(1)
        frame.at_places(((0.25, 0.25),))
        return np.ones(len(frame.from_light), np.float32)

    def see(*arguments):
        traced.append(1)
        return see_surface(*arguments)

    monkeypatch.setattr(timing, "open_methods", lambda name, inputs: lambda scene: Method(answer))
    monkeypatch.setattr(soft_frame, "see_surface", see)
    out = folder / "places.json"
    time_methods([folder / "test_000.json"], [], [], [], [], out, methods={"mine": None}, repeats=2)
    assert len(calls) > 2 and len(traced) == len(calls)


def test_a_window_bears_its_share_of_its_frame(tmp_path, monkeypatch):
    """A quarter of the frame's width and half of its height, of whatever takes 80 ms of the frame."""
    sizes = []

    def answer(frame, radius):
        sizes.append((frame.surface.width, frame.surface.height))
        return np.ones(len(frame.from_light), np.float32)

    def measured(works, repeats):
        for work in works.values():
            work()
        return dict.fromkeys(works, 80.0)

    window = {"of": [192, 48], "light_map": {"kind": "cube", "resolution": 64}}
    part = render_part(tmp_path / "blinds", "test", window, last=1, samples=1)
    monkeypatch.setattr(timing, "open_methods", lambda name, inputs: lambda scene: Method(answer))
    monkeypatch.setattr(timing, "least", measured)
    out = tmp_path / "times.json"
    time_methods([part], [], [], [], [], out, methods={"mine": None}, repeats=1)
    times = json.loads(out.read_text())
    assert times["share"] == 1 / 8 and times["maps"]["64"]["ms"] == 10
    assert set(sizes) == {(48, 24), (192, 48)} and sizes[-1] == (192, 48)
    assert times["methods"]["mine"]["ms"] == [10] * len(RADII)
    assert "12.5% of those of whole frames" in describe_times(times)[0]


def test_calls_are_repeated_until_their_least_times_agree(monkeypatch):
    """A disturbance counts in none; what takes long is timed once."""
    durations = {
        "slow": [2.1],
        "even": [0.3, 0.31],
        "disturbed": [0.6, 0.3, 0.29],
        "noisy": [5e-3, 3e-3, 4e-3],
    }
    now, left = [0.0], {name: list(each) for name, each in durations.items()}

    def work(name):
        now[0] += left[name].pop(0)

    monkeypatch.setattr(timing.time, "perf_counter", lambda: now[0])
    found = least({name: partial(work, name) for name in durations}, 3)
    assert found == pytest.approx({name: 1000 * min(each) for name, each in durations.items()})
    assert not any(left.values())


def test_of_frames_without_a_scene_the_buffers_can_be_measured(folder, tmp_path):
    about = json.loads((folder / "test_000.json").read_text())
    del about["scene"]
    (tmp_path / "test_000.json").write_text(json.dumps(about))
    for stem in ("buffers", "targets", "valid"):
        name = f"test_000.{stem}.npy"
        (tmp_path / name).symlink_to(folder / name)
    own = next(measured_frames([tmp_path / "test_000.json"], []))
    ours = next(measured_frames([folder / "test_000.json"], []))
    held, asked = own.answered(frame_method("base_hard"), 0.1, {}), frame_method("hard")
    assert np.mean(held != ours.answered(asked, 0.1, {"bias": 1.0})) < 0.01
    with pytest.raises(InputError, match=r"has no 'scene' to look at\. .* base_hard, base_pcf"):
        own.answered(asked, 0.1, {})
