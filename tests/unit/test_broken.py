import pytest

from neural_shadows.broken import broken
from neural_shadows.errors import InputError


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
