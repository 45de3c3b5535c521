"""On a full disk or in a folder that cannot be written, a run says so and loses nothing."""

from pathlib import Path

import pytest
from comparison import differences, results_of
from mounts import read_only, resize, small_disk


def size_of(folder: Path) -> int:
    """Bytes that a folder takes in memory: whole pages."""
    return sum(-(-path.lstat().st_size // 4096) * 4096 for path in folder.rglob("*"))


def test_disk_that_fills(undisturbed, full):
    """It fills at some share of what the run writes, is made larger, and fills again."""
    targets, overlays = undisturbed.targets, undisturbed.overlays
    empty, done = (size_of(run.folder) for run in (undisturbed.start, undisturbed.checkout))
    whole = results_of(undisturbed.checkout)
    shares = (0.02, 0.1, 0.2, 0.3, 0.4, 0.5, 0.6, 0.7, 0.8, 0.9) if full else (0.1, 0.6)
    with small_disk(undisturbed.place, 4 * done):
        checkout = undisturbed.another(finished=False)
        for share in shares:
            resize(undisturbed.place, round(empty + share * (done - empty)))
            failed = checkout.snakemake(*targets, "--rerun-incomplete", overlays=overlays)
            assert failed.returncode != 0, failed.stdout
            assert "No space left on device" in failed.stdout
            found = results_of(checkout)
            assert differences(found, {name: whole.get(name) for name in found}) == []
        resize(undisturbed.place, 4 * done)
        undisturbed.finish(checkout)
        undisturbed.same_as(checkout)


@pytest.mark.parametrize("protected", ["results", "reports"])
def test_folder_that_cannot_be_written(undisturbed, protected):
    checkout = undisturbed.another(finished=True)
    folder = checkout.folder / protected
    with read_only(folder):
        # What asks for no job asks for no disk.
        said = checkout.run(*undisturbed.targets, overlays=undisturbed.overlays)
        assert "Nothing to be done" in said
        failed = checkout.snakemake(
            *undisturbed.targets, "--forcerun", "table", overlays=undisturbed.overlays
        )
    assert failed.returncode != 0
    assert (
        f"{protected}/smoke: cannot be written: it is on a read-only file system" in failed.stdout
    )
    assert "Execute" not in failed.stdout and "Traceback" not in failed.stdout
    checkout.run(*undisturbed.targets, "--forcerun", "table", overlays=undisturbed.overlays)
    undisturbed.same_as(checkout)
