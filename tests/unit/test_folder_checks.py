"""Folders that cannot be written and files from the future are named, with what to do."""

import os
import re
import subprocess
import time
from pathlib import Path

import pytest

from neural_shadows.errors import InputError
from neural_shadows.folder_checks import check_clock, check_writable


def test_folders_that_can_be_written(tmp_path, monkeypatch):
    check_writable([tmp_path, tmp_path / "not" / "yet" / "there"])
    monkeypatch.chdir(tmp_path)
    check_writable(["results/smoke"])
    assert list(tmp_path.iterdir()) == []


def test_folder_that_cannot_be_written(tmp_path, monkeypatch):
    """Root may write any; tests/faults mounts one that even root cannot."""
    monkeypatch.setattr(os, "access", lambda path, mode: path != tmp_path)
    with pytest.raises(InputError, match="^[^:]*: cannot be written: permission denied") as caught:
        check_writable(["/", tmp_path / "results" / "smoke"])
    assert str(caught.value).startswith(f"{tmp_path}: ")


def test_file_where_a_folder_belongs(tmp_path):
    (tmp_path / "results").write_text("")
    with pytest.raises(InputError, match="/results: is no folder"):
        check_writable([tmp_path / "results" / "smoke"])


def made(folder: Path, **ages: float) -> None:
    """Write files that are so many seconds old."""
    for name, age in ages.items():
        path = folder / name
        path.write_text("")
        os.utime(path, (time.time() - age,) * 2)


def test_files_from_the_past_and_of_now(tmp_path):
    check_clock([tmp_path / "nothing"])
    made(tmp_path, old=1e6, new=0, another_clock=-1)
    check_clock([tmp_path])


def test_files_from_the_future_are_dated_to_now(tmp_path):
    folders = [tmp_path / "results of all", tmp_path / "code"]
    for folder in folders:
        folder.mkdir()
    made(folders[0], old=500, output=-3600, input=-3500)
    made(folders[1], module=-7200)
    (folders[1] / "link").symlink_to("nowhere")
    with pytest.raises(InputError, match="/module: was written 7,[0-9]{3} s in the fu") as caught:
        check_clock([*folders, tmp_path / "reports not there yet"])
    command = re.search("date such files to now: (.*)", str(caught.value))[1]
    subprocess.run(command, shell=True, check=True)
    check_clock(folders)
    times = {path.name: path.lstat().st_mtime for path in tmp_path.rglob("*")}
    # No input is newer than its output; what was older stays so.
    assert times["output"] == times["input"] == times["module"]
    assert times["old"] == pytest.approx(time.time() - 500, abs=60)
