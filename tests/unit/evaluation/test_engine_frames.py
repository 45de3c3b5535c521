"""Frames as an engine writes them: a trained network answers them as it answers the pipeline's own."""

import json
import re
import shutil
from pathlib import Path

import numpy as np
import OpenEXR
import pandas as pd
import pytest
from built_networks import make_screen_network
from engine_frames import NAMES, TARGETS, engine_images, write_exr, write_npz
from opened import called, frame_method
from PIL import Image
from rendered_frames import render_part
from shipped import shipped

from neural_shadows.config.reading import check_files, read_config
from neural_shadows.config.resolved import resolved
from neural_shadows.errors import InputError
from neural_shadows.evaluation.measured_frames import measured_frames
from neural_shadows.files.frame_images import FrameImages
from neural_shadows.frames.buffers import CHANNELS, LIT
from neural_shadows.frames.engine_channels import CHANNEL_IMAGES
from neural_shadows.frames.engine_frame import engine_frame
from neural_shadows.frames.import_frame import import_frame
from neural_shadows.layout import frame_methods, frame_sets
from neural_shadows.layout.layout import Layout
from neural_shadows.metrics.kinds.ssim import ssim
from neural_shadows.networks.screen_space.screen_networks import save_screen_network
from neural_shadows.reports.answers.answer_frames import CROP, _window, answer_frames

RADII = [0, 0.00625]  # scene sizes
WIDTH, HEIGHT = 101, 67  # no multiples of what networks halve
KINDS = ("json", "buffers.npy", "targets.npy", "valid.npy")
FRAMES = {
    **{"width": WIDTH, "height": HEIGHT, "fov": 40},
    "light_map": {"kind": "cube", "resolution": 64},
    **{"radii": RADII, "radius_unit": "scene_sizes"},
}
KERNELS = {"form": "kernels", "widths": [4, 8], "filters": 4}
KERNELS["features"] = "cosine c_v_by_d z_f penumbra behind z_b_by_z z_b base_msm".split()
VALUES = {"form": "shuffle", "widths": [8, 8]}
VALUES["features"] = ["c_e", "view", "ratio", "difference", "n"]
HALF = 2.0**-11  # the rounding of half floats, of 1


@pytest.fixture(scope="module")
def rendered(tmp_path_factory):
    """The pipeline's own frame, but that bases are dark by the shading normal, as an engine's."""
    folder = tmp_path_factory.mktemp("own") / "garden"  # under an open sky
    part = render_part(folder, "test", FRAMES, "garden", last=1, samples=1)
    buffers = np.load(part.with_suffix(".buffers.npy"))
    c_e, z = (buffers[:, :, CHANNELS.index(name)] for name in ("c_e", "z"))
    for name in LIT:
        buffers[:, :, CHANNELS.index(name)][(c_e <= 0) & (z > 0)] = 0
    np.save(part.with_suffix(".buffers.npy"), buffers)
    return next(measured_frames([part], []))


@pytest.fixture
def here(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    return tmp_path


def save_network(settings, radii=RADII, unit="scene_sizes"):
    """An untrained one, where the workflow has the experiment `kpnsm`."""
    network = make_screen_network(settings)
    network.initialise(2)
    if settings["form"] == "shuffle":  # answers about 0.5, where none is cut off
        network.levels[0].decoder[-1].weight.data *= 0.02
    path = Path("results/networks/kpnsm/weights.safetensors")
    path.parent.mkdir(parents=True)
    save_screen_network(path, network, {"network": settings, "radii": radii, "radius_unit": unit})
    return path


def layout_of(**engine):
    told = {"sizes": {"quay-2": 8.0}, "fov": 40, "radii": RADII, "targets": TARGETS}
    values = shipped(frame_sets={"mine": {"path": "mine", "engine": told | engine}})
    config = read_config(values)
    check_files(config)
    return Layout(resolved(config))


def answer(layout):
    """What the workflow does for `reports/answers/mine/kpnsm.csv`; its errors, and its folder."""
    parts = frame_sets.tests(layout, "mine")
    keys = ("frames_json", "buffers_npy", "targets_npy", "valid_npy")
    for part in parts:
        *_, scene, name = Path(part).with_suffix("").parts
        files = {key: str(Path(part).with_suffix(f".{kind}")) for key, kind in zip(keys, KINDS)}
        called(
            import_frame,
            input={"files": frame_sets.engine_files(layout, scene, "mine", name)},
            output=files,
            params={"settings": frame_sets.import_settings(layout, scene, "mine")},
        )
    called(
        answer_frames,
        input={
            "parts": parts,
            "meshes": frame_sets.all_meshes(layout, "mine"),
            "constants_json": frame_methods.chosen(layout, "mine", "kpnsm"),
            "weights": frame_methods.weights(layout, "kpnsm"),
        },
        output={"errors_csv": "kpnsm.csv", "answers": "kpnsm"},
        params={"label": frame_methods.label(layout, "kpnsm")},
        wildcards={"method": "kpnsm", "frame_set": "mine"},
    )
    return pd.read_csv("kpnsm.csv"), Path("kpnsm/quay-2")


def read_answers(folder, name):
    """(K, H, W) float16 of a frame, in the form that it came in."""
    names = [f"visibility_{k}" for k in range(len(RADII))]
    if (path := folder / f"{name}.npz").exists():
        with np.load(path) as arrays:
            return np.stack([arrays[one] for one in names])
    path = folder / f"{name}.exr"
    channels = OpenEXR.File(str(path), separate_channels=True).channels()
    return np.stack([channels[one].pixels for one in names])


@pytest.mark.parametrize(
    ("network", "write", "most", "mean"),
    # Of halves the distance behind the blocker is told to 5e-4; of float32 only the answer is rounded.
    [(KERNELS, write_exr, 0.03, 1e-3), (VALUES, write_npz, HALF, HALF / 2)],
    ids=["kernels-exr", "values-npz"],
)
def test_a_network_answers_as_it_does_frames_of_our_own(here, rendered, network, write, most, mean):
    weights = save_network(network)
    write(here / "mine/quay-2/f_0007", engine_images(rendered))
    table, folder = answer(layout_of())
    method = frame_method("kpnsm", weights)
    own = np.stack([rendered.answered(method, radius, {}) for radius in rendered.part.radii])
    assert own[:, rendered.valid].std() > 0.01 and not rendered.valid.all()
    found = read_answers(folder, "f_0007")
    assert found.dtype == np.float16 and found.shape == own.shape
    off = np.abs(found.astype(np.float32) - own)
    assert off.max() < most and off.mean() < mean
    assert (found[:, ~rendered.valid] == 1).all()
    means, table = table[table["frame"] == "mean"], table[table["frame"] != "mean"]
    assert table["radius"].tolist() == RADII and (table["radius_unit"] == "scene_sizes").all()
    assert (table["frame_width"] == WIDTH).all() and (table["frame_height"] == HEIGHT).all()
    assert means["radius"].tolist() == RADII and means["mse"].tolist() == table["mse"].tolist()
    base = np.square(rendered.picture("pcf") - rendered.target)[:, rendered.valid].mean(axis=1)
    assert table["mse_of_pcf"].to_numpy() == pytest.approx(base, rel=5e-3)
    square = np.square(own - rendered.target)[:, rendered.valid].mean(axis=1)
    assert table["mse"].to_numpy() == pytest.approx(square, rel=5e-3)
    # Where nothing is seen all is lit.
    masked = [np.where(rendered.valid, one, 1) for one in (own, rendered.target)]
    own_ssim = [ssim(*np.float32(pair)) for pair in zip(*masked)]
    assert table["ssim"].to_numpy() == pytest.approx(own_ssim, abs=2e-3)
    with Image.open(folder / "f_0007.png") as picture:
        assert picture.width > 500
    with Image.open(folder / "f_0007_visibility_1.png") as picture:
        assert np.abs(np.asarray(picture) / 255 - own[1]).mean() < most + 1 / 500


def imported(folder, images, **told):
    """The part that a frame becomes."""
    write_npz(folder / "quay/f_0007", images)
    part = folder / "out/quay/test_000.json"
    settings = {"size": 8.0, "fov": 40, "radii": RADII, "radius_unit": "scene_sizes"}
    settings |= {"channels": CHANNEL_IMAGES, "targets": TARGETS} | told
    outputs = (part.with_suffix(f".{kind}") for kind in KINDS)
    import_frame([folder / "quay/f_0007/frame.npz"], *outputs, **settings)
    return next(measured_frames([part], []))


def test_a_frame_without_targets_is_answered_but_not_measured(here, rendered):
    weights = save_network(VALUES)
    images = {k: v for k, v in engine_images(rendered).items() if k not in TARGETS}
    frame = imported(here, images)
    told = [frame.part.frames_json], [], None, [weights]
    answer_frames(*told, here / "a.csv", here / "a", method="kpnsm", label="Mine")
    table = pd.read_csv("a.csv")
    assert len(table) == len(RADII) and "mse" not in table
    assert read_answers(here / "a/quay", "f_0007").shape == (len(RADII), HEIGHT, WIDTH)
    with pytest.raises(InputError, match="quay/f_0007: has no exact shadow to measure against"):
        _ = frame.target


@pytest.mark.parametrize(
    ("size", "told"),
    [
        (8.0, ""),
        (
            0.8,
            "f_0007: its farthest z or d is .* `engine.sizes.quay` = 0.8; 0.05 to 2 times is usual",
        ),
        (
            8000.0,
            "`engine.sizes.quay` = 8000; .* Give the longest side of the scene's bounding box",
        ),
    ],
)
def test_a_size_unlike_the_distances_is_told(here, rendered, capsys, size, told):
    imported(here, engine_images(rendered), size=size)
    lines = capsys.readouterr().err.splitlines()
    assert len(lines) == bool(told) and all(re.search(f"^warning: .*{told}", x) for x in lines)


def test_distances_end_with_half_floats(here, rendered):
    images = engine_images(rendered)
    with pytest.raises(InputError, match="`engine.sizes.quay` = 1e-05; half floats end at 65504"):
        imported(here, images, size=1e-5)
    # What a map shows beyond is as good as nothing.
    beyond = images | {NAMES["z_b"]: np.where(images[NAMES["z"]] > 0, np.float32(1e9), 0)}
    assert imported(here, beyond).picture("gap").max() == 65504
    with np.errstate(over="ignore"):
        write_exr(here / "half/f", images | {NAMES["d"]: images[NAMES["d"]] * 1e6})
    told = "distV.15.exr: R: NaN or .*Half floats end at 65504: write"
    with pytest.raises(InputError, match=told):
        engine_frame(FrameImages(here / "half/f"), CHANNEL_IMAGES, [], 8.0)


def test_penumbrae_beyond_the_features_are_told(here, rendered, capsys):
    weights, part = save_network(KERNELS, radii=[0, 1]), rendered.part.frames_json
    arguments = [part], [], None, [weights], here / "a.csv", here / "a"
    answer_frames(*arguments, method="kpnsm", label="Mine")
    assert "warning" not in capsys.readouterr().err
    for end in (".json", *(f".{stem}.npy" for stem in ("buffers", "targets", "valid", "edges"))):
        shutil.copy(part.with_suffix(end), here / f"test_000{end}")
    wide = json.loads(part.read_text()) | {"radii": [0, 0.5], "given_radii": [0, 0.5]}
    (here / "test_000.json").write_text(json.dumps(wide))
    arguments = [here / "test_000.json"], *arguments[1:]
    answer_frames(*arguments, method="kpnsm", label="Mine")
    told = r"warning: kpnsm: under a light of 0.5 S radius penumbrae are wider than the 50 pixels"
    assert re.search(told, capsys.readouterr().err)


def test_a_crop_of_a_large_frame_is_where_most_differs():
    difference = np.full((600, 900), 0.01)
    difference[300:420, 500:620] = 1
    window = _window(difference)
    crop = window.of(difference)
    assert crop.shape == (CROP, CROP) and crop.sum() > 120 * 120
    assert window.row <= 300 and window.column + CROP >= 620


def with_value(channel, value):
    """A spoilt frame: a value where something is seen."""

    def spoil(images):
        image = images[NAMES[channel]].copy()
        image[np.unravel_index(images[NAMES["z"]].argmax(), image.shape)] = value
        return images | {NAMES[channel]: image}

    return spoil


def without(*names):
    return lambda images: {name: one for name, one in images.items() if name not in names}


@pytest.mark.parametrize(
    ("spoil", "told"),
    [
        (with_value("c_e", np.nan), "MyGBuffer.ce.15:R: NaN or infinity in 1 pixels, the first in"),
        (with_value("d", np.inf), r"distV.15:R: NaN or infinity in 1 pixels"),
        (with_value("msm", 255), r"msm.15:G: msm is from 0 to 255; should be in \[0, 1\]"),
        (with_value("d", -1), r"distV.15:R: d is from -1 to .*; should be 0 or more"),
        (lambda images: images | {NAMES["z"]: 0 * images[NAMES["z"]]}, "no pixel shows a surface"),
        (without(NAMES["z"]), r"distE.15:R: missing. Each frame needs z"),
        (without("Pass2:R"), "missing, but the frame has other targets"),
        (
            lambda images: images | {NAMES["msm"]: images[NAMES["msm"]][1:]},
            rf"msm.15:G: is {WIDTH} × {HEIGHT - 1}, but the frame's z {WIDTH} × {HEIGHT}",
        ),
    ],
)
def test_nothing_is_imported_of_damaged_ones(here, rendered, spoil, told):
    targets = ["Pass1:R", "Pass2:R"]
    images = engine_images(rendered)
    images |= dict(zip(targets, [images.pop(name) for name in TARGETS]))
    with pytest.raises(InputError, match=told):
        imported(here, spoil(images), targets=targets)
    assert not (here / "out").exists()


def test_a_file_without_the_channel_says_which_it_has(here, rendered):
    write_exr(here / "f", engine_images(rendered))
    images = FrameImages(here / "f")
    with pytest.raises(InputError, match=r"ce.15.exr: G: no such channel. Allowed: R"):
        images.image("MyGBuffer.ce.15:G")
    (here / "f/MyGBuffer.ce.15.exr").write_bytes(b"no picture")
    with pytest.raises(InputError, match=r"ce.15.exr: damaged"):
        FrameImages(here / "f").image("MyGBuffer.ce.15:R")


@pytest.mark.parametrize(
    ("spoil", "header", "told"),
    [
        (
            without(NAMES["msm"]),
            {},
            "f_0007: has no base shadow msm, which .* needs; it has z, gap",
        ),
        (without(NAMES["c_v"]), {}, "f_0007: has no channel c_v, which"),
        (
            lambda images: {name: one[:60] for name, one in images.items()},
            {},
            f"f_0007: is {WIDTH} × 60, smaller than the kernels of .*, 61 × 61",
        ),
        (
            without(),
            {"unit": "metres", "radii": [0, 0.25]},
            "radii are in scene_sizes, but .* was trained with radii in metres, up to 0.25",
        ),
        (
            without(),
            {"radii": [0, 0.001]},
            "0.001 scene sizes, and these frames have one of 0.00625",
        ),
    ],
)
def test_what_a_network_cannot_answer_is_refused(here, rendered, spoil, header, told):
    weights = save_network(KERNELS, **header)
    frame = imported(here, spoil(engine_images(rendered)))
    with pytest.raises(InputError, match=told):
        frame.answered(frame_method("kpnsm", weights), frame.part.radii[-1], {})


@pytest.mark.parametrize(
    ("engine", "told"),
    [
        ({"sizes": {"pier": 3.0}}, r"frame_sets.mine.path = 'mine': no frame in pier/"),
        ({"radii": [0, 0.1, 0.2]}, r"targets: 2 images for 3 radii"),
        ({"channels": {"depth": "z:R"}}, r"depth"),
        ({"channels": {"z": "z"}}, r"frame_sets.mine.*channels.z"),
    ],
)
def test_mistakes_in_its_section(here, rendered, engine, told):
    write_npz(here / "mine/quay-2/f_0007", {"z:R": np.ones((2, 2))})
    with pytest.raises(InputError, match=told):
        layout_of(**engine)
