"""Files from the future are named, and dated to now in their order."""

import os
import re
import shlex
import subprocess
import sys
import time
from pathlib import Path

import pytest

from neural_shadows.errors import InputError
from neural_shadows.running.file_times import check_clock, date_to_now


def made(folder: Path, **ages: float) -> None:
    """Write files that are so many seconds old."""
    now = time.time()
    for name, age in ages.items():
        path = folder / name
        path.write_text("")
        os.utime(path, (now - age,) * 2)


def test_files_from_the_past_and_of_now(tmp_path):
    check_clock([tmp_path / "nothing"])
    made(tmp_path, old=1e6, new=0, clock_of_a_server=-50)
    check_clock([tmp_path])


def test_files_from_the_future(tmp_path):
    folders = [tmp_path / "results of all", tmp_path / "code"]
    for folder in folders:
        folder.mkdir()
    made(folders[0], old=500, first=-3600, second=-3600, third=-3601, fourth=-9e5)
    made(folders[1], between=-3600.5)
    (folders[1] / "link").symlink_to("nowhere")
    with pytest.raises(InputError, match="/fourth: was written 900,[0-9]{3} s in the") as caught:
        check_clock([*folders, tmp_path / "reports not there yet"])

    command = re.search("python (-m .*)", str(caught.value))[1]
    environment = {**os.environ, "PYTHONPATH": os.pathsep.join(sys.path)}
    done = subprocess.run(
        [sys.executable, *shlex.split(command)], env=environment, capture_output=True, text=True
    )
    assert done.stdout == "5 files dated to now\n", done.stderr
    check_clock(folders)
    assert date_to_now(folders) == 0
    times = {path.name: path.lstat().st_mtime_ns for path in tmp_path.rglob("*")}
    assert time.time_ns() - 60e9 < times["first"] == times["second"] < times["between"]
    assert times["between"] < times["third"] < times["fourth"] <= time.time_ns()
    assert times["old"] == pytest.approx(time.time_ns() - 500e9, abs=60e9)
