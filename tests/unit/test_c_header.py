"""The C header's answers beside Python's, compiled with and without vector instructions."""

import shutil
import subprocess
from pathlib import Path

import numpy as np
import pytest
from safetensors.numpy import load, save
from shapes import bumpy_sphere, hills

from neural_shadows import ShadowField

FOLDER = Path(__file__).parents[2] / "workflow/field"
CC = shutil.which("cc")
WARNINGS = ["-Wall", "-Wextra", "-Wconversion", "-pedantic", "-Werror"]
COMPILERS = {
    "c99": ["-std=c99", *WARNINGS, "-O3"],
    "native": ["-std=c11", *WARNINGS, "-O3", "-march=native"],
    "no SSE": ["-std=c99", "-m32", "-mfpmath=387", "-mno-sse", "-O2"],
    "C++": ["-xc++", "-std=c++11", "-Wall", "-Wextra", "-Werror", "-O2"],
}
RAYS = {"solid": 1_000_000, "sheet": 200_000}
UNLIKE = 0.001  # a share of rays that graze the surface: samples need not lie at the same places
TO_SUN = np.array([1.0, 0.4, 0.3], np.float32)

pytestmark = pytest.mark.skipif(CC is None, reason="no C compiler: apt-get install gcc")


def compiled(source: Path, program: Path, options: list[str]) -> Path:
    run = [CC, *options, f"-I{FOLDER}", str(source), "-o", str(program), "-lm"]
    done = subprocess.run(run, capture_output=True, text=True)
    if done.returncode and "-m32" in options and "No such file" in done.stderr:
        pytest.skip("no 32-bit headers: apt-get install gcc-multilib")
    assert done.returncode == 0, done.stderr
    return program


@pytest.fixture(scope="module")
def fields(tmp_path_factory):
    """A solid's and a sheet's, away from the origin, with points around them and Python's answers."""
    folder = tmp_path_factory.mktemp("fields")
    files = {}
    for name, shape in {"solid": bumpy_sphere(5), "sheet": hills()}.items():
        shape.vertices = 20 * shape.vertices + [100.0, -3.0, 7.0]
        field = ShadowField.fit(shape)
        assert field.sheet == (name == "sheet")
        points = (
            np.random.default_rng(0).uniform(-1.2, 1.2, (RAYS[name], 3)) * field.radius
            + field.centre
        )
        points = points.astype(np.float32)
        field.save(folder / f"{name}.field")
        points.tofile(folder / f"{name}.points")
        files[name] = folder / name, field.occluded(points, TO_SUN)
    return files


def run_sample(program: Path, field: Path, points: Path, answers: Path, length: float = 1.0):
    sun = [str(each) for each in length * TO_SUN.astype(float)]
    command = [program, field, points, *sun, answers]
    return subprocess.run(command, capture_output=True, text=True)


@pytest.mark.parametrize("name", COMPILERS)
def test_a_million_rays(tmp_path, fields, name):
    program = compiled(FOLDER / "sample.c", tmp_path / "sample", COMPILERS[name])
    for path, expected in fields.values():
        of_path = path.with_suffix(".field"), path.with_suffix(".points"), tmp_path / "answers"
        done = run_sample(program, *of_path)
        assert done.returncode == 0, done.stderr
        answers = np.fromfile(tmp_path / "answers", np.uint8).astype(bool)
        assert 0.05 < expected.mean() < 0.6
        assert np.mean(answers != expected) < UNLIKE


@pytest.mark.parametrize("length", [1e-30, 1e30])
def test_directions_of_any_length(tmp_path, fields, length):
    """Also where squares of lengths are 0 or infinite in float32."""
    program = compiled(FOLDER / "sample.c", tmp_path / "sample", COMPILERS["native"])
    path, expected = fields["sheet"]
    of_path = path.with_suffix(".field"), path.with_suffix(".points"), tmp_path / "answers"
    assert run_sample(program, *of_path, length).returncode == 0
    answers = np.fromfile(tmp_path / "answers", np.uint8).astype(bool)
    assert np.mean(answers != expected) < UNLIKE


LAMPS = """
#include <stdio.h>
#define SHADOW_FIELD_IMPLEMENTATION
#include "shadow_field.h"
int main(int count, char **arguments)
{
    shadow_field field;
    float ends[6];
    const char *problem = shadow_field_load(&field, arguments[count - 1]);
    if (problem) return 1;
    while (fread(ends, sizeof ends, 1, stdin) == 1) putchar(shadow_field_blocked(&field, ends, ends + 3));
    shadow_field_free(&field);
    return 0;
}
"""


def test_lamps_and_odd_rays(tmp_path, fields):
    """To a lamp in the scene; NaN, infinity and a lamp at the point itself are lit."""
    (tmp_path / "lamps.c").write_text(LAMPS)
    program = compiled(tmp_path / "lamps.c", tmp_path / "lamps", COMPILERS["c99"])
    for path, _ in fields.values():
        field = ShadowField.load(path.with_suffix(".field"))
        points = np.fromfile(path.with_suffix(".points"), np.float32).reshape(-1, 3)[:100_000]
        lamp = (field.centre + np.array([0.1, 0.6, 0.2]) * field.radius).astype(np.float32)
        odd = np.array([[np.nan, 0, 0], [np.inf, 0, 0], lamp], np.float32)
        ends = np.concatenate([points, odd])
        ends = np.concatenate([ends, np.tile(lamp, (len(ends), 1))], axis=1)
        command = [program, path.with_suffix(".field")]
        found = subprocess.run(command, input=ends.tobytes(), capture_output=True, check=True)
        answers = np.frombuffer(found.stdout, np.uint8).astype(bool)
        assert np.mean(answers[:-3] != field.occluded_from(points, lamp)) < UNLIKE
        assert answers[:-3].mean() > 0.05 and not answers[-3:].any()


def test_other_files_are_refused_in_one_line(tmp_path, fields):
    program = compiled(
        FOLDER / "sample.c", tmp_path / "sample", ["-O1", "-fsanitize=address,undefined"]
    )
    path, _ = fields["sheet"]
    content = path.with_suffix(".field").read_bytes()
    later = content.replace(b"ShadowField 1", b"ShadowField 2")
    foreign = content.replace(b"neural_shadows.ShadowField", b"neural_shadows.OtherField!")
    damaged = {"empty": b"", "cut": content[:-5], "header": content[:60], "other": b"\xff" * 100}
    damaged |= {"array": content.replace(b'"bricks":', b'"brocks":')}
    arrays = load(content)
    nothing = {name: arrays[name][:0] for name in ("bricks", "cells")}
    nothing["grid"] = np.zeros((0, 0, 0), np.uint8)
    damaged |= {"no grid": save({**arrays, **nothing}, {"format": "neural_shadows.ShadowField 1"})}
    expected = dict.fromkeys(damaged, "the file is damaged") | {"later": "another version"}
    expected |= {"foreign": "not a saved ShadowField"}
    for name, wrong in {**damaged, "later": later, "foreign": foreign}.items():
        (tmp_path / name).write_bytes(wrong)
        done = run_sample(program, tmp_path / name, path.with_suffix(".points"), tmp_path / "out")
        assert done.returncode == 1 and expected[name] in done.stderr, (name, done.stderr)
        assert done.stderr.count("\n") == 1
    done = run_sample(program, tmp_path / "none", path.with_suffix(".points"), tmp_path / "out")
    assert "none: the file cannot be read" in done.stderr
