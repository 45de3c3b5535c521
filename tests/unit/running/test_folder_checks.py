"""Folders that cannot be written are named, with what to do."""

import os

import pytest

from neural_shadows.errors import InputError
from neural_shadows.running.folder_checks import check_writable


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
