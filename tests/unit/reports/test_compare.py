"""Made-up tables: each number is the same, within its interval, differs or is not compared."""

import subprocess
import sys
from unittest import mock

import pytest
from checkout import ROOT

from neural_shadows.errors import InputError
from neural_shadows.reports.runs.compare import compare_runs, compare_tables

OLD = """\
method,psnr,psnr_low,psnr_high,ssim,by_seed,learned,thesis_psnr,psnr_minus_thesis,own_ms,build_seconds,device,scale
map,40.0,39.0,41.0,0.9,1 2,,31.5,8.5,3.5,,cpu,desk
network,20.0,19.5,20.5,0.5,3 4,True,27.4,-7.4,90,100,cpu,desk
"""
HEAD, MAP, NETWORK = OLD.splitlines()


@pytest.fixture
def compared(tmp_path):
    """Compare a table with `OLD`."""

    def compare(text, name="table"):
        for folder, content in (("old", OLD), ("new", text)):
            (tmp_path / folder).mkdir(exist_ok=True)
            (tmp_path / folder / f"{name}.csv").write_text(content, encoding="utf-8")
        return compare_tables(*(tmp_path / folder / f"{name}.csv" for folder in ("old", "new")))

    return compare


def test_a_ratio_of_errors_is_compared_and_one_of_times_is_not(compared):
    for times, verdict in (("", "differs"), ("own_ms,", "not compared")):
        old, new = (f"method,{times}ratio\nmap,{times and '1,'}{ratio}\n" for ratio in (2, 3))
        with mock.patch(f"{__name__}.OLD", old):
            assert compared(new).counts[verdict] == 1 + bool(times)


def test_equal_runs_are_the_same_but_for_times_and_what_repeats_others(compared):
    result = compared(OLD)
    # Two methods, psnr, ssim, by_seed, thesis_psnr and scale of each, and one `learned`; of a time, a
    # device and a difference from print two each, and one more time.
    assert result.counts == {"same": 13, "not compared": 7}
    assert result.differences == [] and not any(result.only.values())


@pytest.mark.parametrize(
    ("old", "new", "verdict"),
    [
        ("map,40.0", "map,40.1", "same"),  # as another processor rounds
        ("map,40.0", "map,40.2", "within its interval"),
        ("map,40.0", "map,41.0", "within its interval"),
        ("map,40.0,39.0", "map,40.0,39.2", "within its interval"),  # of the interval alone
        ("map,40.0", "map,41.1", "differs"),
        ("map,40.0", "map,nan", "differs"),
        ("map,40.0", "map,", "differs"),
        ("41.0,0.9", "41.0,0.91", "differs"),  # has no interval
        ("1 2", "1 2.001", "same"),
        ("1 2", "1 2.01", "differs"),
        ("1 2", "1 2 3", "differs"),
        ("True", "False", "differs"),
        ("cpu,desk\nn", "cuda,desk\nn", None),  # the machine's own
        ("3.5,,cpu", "99,,cpu", None),
        ("90,100", "90,2", None),
        ("-7.4", "-9", None),
    ],
)
def test_a_number_that_has_changed(compared, old, new, verdict):
    changed = OLD.replace(old, new, 1)
    assert changed != OLD
    counts = dict(compared(OLD).counts)
    if verdict not in (None, "same"):
        counts["same"] -= 1
        counts[verdict] = 1
    assert dict(compared(changed).counts) == counts


def test_rows_are_found_in_any_order(compared):
    assert compared(f"{HEAD}\n{NETWORK}\n{MAP}\n").counts == compared(OLD).counts


def test_rows_and_columns_of_one_run_alone_are_named(compared):
    result = compared(
        f"{HEAD.replace('ssim', 'lpips')}\n{MAP}\n{NETWORK.replace('network', 'n')}\n"
    )
    named = {where.rpartition("/")[2]: names for where, names in result.only.items() if names}
    assert [*result.only.values()] == [["ssim"], ["lpips"], ["network"], ["n"]]
    assert set(named) == {"table.csv has no columns", "table.csv has no rows"}


def test_another_scale_is_refused(compared):
    with pytest.raises(InputError, match="new/table.csv: scale: smoke, and desk in the old run"):
        compared(OLD.replace("desk", "smoke"))


def test_rows_of_equal_methods_are_named_by_their_light_too(tmp_path):
    text = "method,light,mse\npcss,1,0.5\npcss,2,0.6\n"
    (tmp_path / "a.csv").write_text(text)
    (tmp_path / "b.csv").write_text(text.replace("0.6", "0.7"))
    (difference,) = compare_tables(tmp_path / "a.csv", tmp_path / "b.csv").differences
    assert difference.place == "pcss 2, mse" and difference.share == pytest.approx(1 / 7)


def test_a_run_says_what_differs_most(compared, tmp_path):
    compared(OLD.replace("0.5,3 4", "0.4,3 4").replace("0.9,", "0.8,"))
    compared(OLD, name="other")
    lines, equal = compare_runs(tmp_path / "old", tmp_path / "new")
    assert not equal
    assert lines == [
        "other.csv: same 13, not compared 7",
        "table.csv: same 11, differs 2, not compared 7",
        "in all: same 24, differs 2, not compared 14",
        "Largest differences:",
        "table.csv: network, ssim: 0.5 → 0.4 (20 %)",
        "table.csv: map, ssim: 0.9 → 0.8 (11.1 %)",
    ]
    assert compare_runs(tmp_path / "old", tmp_path / "new", ["other"])[1]


def test_a_missing_table_has_a_line_and_the_others_are_compared(compared, tmp_path):
    compared(OLD)
    (tmp_path / "old" / "gone.csv").write_text(OLD)
    lines, equal = compare_runs(tmp_path / "old", tmp_path / "new")
    assert not equal and "table.csv: same 13, not compared 7" in lines
    assert lines[-1].endswith("gone.csv: cannot be read (No such file or directory). Make it first")


def test_a_folder_without_tables_is_refused(tmp_path):
    with pytest.raises(InputError, match=r"has no tables \(\*.csv\)"):
        compare_runs(tmp_path, tmp_path)


def test_the_command_ends_with_a_status(compared, tmp_path):
    command = [sys.executable, "-m", "neural_shadows.reports.runs.compare", "old", "new"]
    for text, status in ((OLD, 0), (OLD.replace("0.9,", "0.8,"), 1)):
        compared(text)
        done = subprocess.run(
            command, cwd=tmp_path, env={"PYTHONPATH": str(ROOT / "workflow")}, capture_output=True
        )
        assert done.returncode == status and b"table.csv: same" in done.stdout
