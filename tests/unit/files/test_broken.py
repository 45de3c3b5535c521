import pytest

from neural_shadows.errors import InputError
from neural_shadows.files.broken import broken, reading


def test_broken_result_is_moved_aside_and_named(tmp_path):
    path = tmp_path / "shadow.000.csv"
    path.write_text("half a li")
    error = broken(path, "metrics are cut short")
    assert isinstance(error, InputError)
    assert str(error) == (
        f"{path}: metrics are cut short: moved to shadow.000.csv.broken, run again to make it anew"
    )
    assert not path.exists()
    assert (tmp_path / "shadow.000.csv.broken").read_text() == "half a li"


def test_what_cannot_be_moved_is_to_be_deleted(tmp_path):
    error = broken(tmp_path / "gone" / "a.csv", "is no table")
    with pytest.raises(InputError, match="is no table: delete it and run again"):
        raise error


@pytest.mark.parametrize(
    ("error", "message"),
    [
        (FileNotFoundError(), "no such file"),
        (PermissionError(13, "Permission denied"), r"cannot be read \(Permission denied\)"),
        (OSError(5, "Input/output error"), r"cannot be read \(Input/output error\)"),
    ],
)
def test_what_cannot_be_read_is_left_where_it_is(tmp_path, error, message):
    """A moment without the network is no reason to make hours of work anew."""
    path = tmp_path / "loss.csv"
    path.write_text("whole")
    with pytest.raises(InputError, match=rf"loss\.csv: {message}"), reading(path, "loss curve"):
        raise error
    assert path.read_text() == "whole"


def test_only_damages_are_taken_for_damage(tmp_path):
    path = tmp_path / "loss.csv"
    path.write_text("half")
    for error in (MemoryError, KeyError):
        with pytest.raises(error), reading(path, "loss curve"):
            raise error
    with (
        pytest.raises(InputError, match=r"not a whole loss curve \(KeyError\): moved to"),
        reading(path, "loss curve", KeyError),
    ):
        raise KeyError
    assert not path.exists()
