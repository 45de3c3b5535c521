"""On a full disk or in a folder that cannot be written, a run says so and loses nothing."""

import shutil

from mounts import read_only, resize, small_disk
from same_results import differences, reports_of, results_of
from undisturbed import TABLE


def test_disk_that_fills(undisturbed, full):
    """It fills at some share of what is still to be written, is made larger, and fills again."""
    targets, overlays = undisturbed.targets, undisturbed.overlays
    whole = results_of(undisturbed.checkout)
    written = sum(path.lstat().st_size for path in undisturbed.checkout.folder.rglob("*"))
    shares = (0.01, 0.1, 0.2, 0.3, 0.4, 0.5, 0.6, 0.7, 0.8, 0.9) if full else (0.3,)
    with small_disk(undisturbed.place, 4 * written):
        checkout = undisturbed.another(finished=not full)
        if not full:
            shutil.rmtree(checkout.results / "evaluations")
            shutil.rmtree(checkout.reports)
        used = shutil.disk_usage(undisturbed.place).used
        left = written - used if full else 1_000_000
        for share in shares:
            resize(undisturbed.place, round(used + share * left))
            failed = checkout.snakemake(*targets, "--rerun-incomplete", overlays=overlays)
            assert failed.returncode != 0, failed.stdout
            assert "No space left on device" in failed.stdout, failed.stdout
            found = results_of(checkout)
            assert differences(found, {name: whole.get(name) for name in found}) == []
        resize(undisturbed.place, 4 * written)
        undisturbed.finish(checkout)
        undisturbed.same_as(checkout)


def test_folders_that_cannot_be_written(undisturbed):
    checkout = undisturbed.another(finished=True)
    # Of more targets Snakemake itself names one whose old file is write-protected.
    targets, overlays = [TABLE], undisturbed.overlays
    table = [checkout.reports / f"table_4_3.{ending}" for ending in ("csv", "md")]
    with read_only(checkout.folder / "results", checkout.folder / "reports"):
        # What asks for no job asks for no disk.
        assert "Nothing to be done" in checkout.run(*targets, overlays=overlays)
        said = checkout.snakemake(*targets, "--forcerun", "table", overlays=overlays).stdout
        assert "Write-protected output files for rule table" in said
        assert str(table[0].relative_to(checkout.folder)) in said

    for path in table:
        path.unlink()
    for folder in ("results", "reports"):
        with read_only(checkout.folder / folder):
            failed = checkout.snakemake(*targets, overlays=overlays)
        reason = "cannot be written: it is on a read-only file system"
        assert failed.returncode != 0
        assert f"\n{folder}/smoke: {reason}" in failed.stdout, failed.stdout
        assert "Execute" not in failed.stdout and "Traceback" not in failed.stdout

    checkout.run(*targets, overlays=overlays)
    assert differences(results_of(checkout), results_of(undisturbed.checkout)) == []
    assert differences(reports_of(checkout), reports_of(undisturbed.checkout)) == []
