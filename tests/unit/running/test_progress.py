"""Bars show the count, the rate and the time left, and go on where a run was stopped."""

import sys

from neural_shadows.running.progress import RATES, progress_bar


def test_bar(capsys):
    with progress_bar(30_000, "samples", "train dragon", initial=15_000) as bar:
        bar.update(15_000)
    out, err = capsys.readouterr()
    assert out == ""
    first, *_, last = err.split("\r")[1:]
    assert first.startswith("train dragon:  50%") and "15.0k/30.0k" in first
    assert "100%" in last and "30.0k/30.0k" in last and "samples/s" in last


def test_rate_leaves_out_what_was_done_before(capsys):
    with progress_bar(100, "views", "shadow", initial=50) as bar:
        bar.update(10)
        shown = bar.format_dict
    assert shown["initial"] == 50 and shown["n"] == 60
    # 10 in 2 s, and not 60: 40 more take 8 s
    assert "5.00 views/s" in bar.format_meter(**{**shown, "elapsed": 2.0, "rate": None})
    assert "00:02<00:08" in bar.format_meter(**{**shown, "elapsed": 2.0, "rate": None})


def test_few_lines_a_run(capsys):
    """At most one every two seconds: each is a line of the log."""
    with progress_bar(1000, "views", "shadow") as bar:
        for _ in range(1000):
            bar.update()
    assert capsys.readouterr().err.count("\r") <= 4


def test_bar_goes_to_the_stderr_of_the_moment(monkeypatch, tmp_path):
    with (tmp_path / "log").open("w") as log:
        monkeypatch.setattr(sys, "stderr", log)
        progress_bar(1, "views", "shadow").close()
        monkeypatch.undo()
    assert "shadow" in (tmp_path / "log").read_text()


def test_a_bar_leaves_its_rate():
    before = len(RATES)
    with progress_bar(100, "views", "shadow", initial=50) as bar:
        bar.update(20)
        bar.update(5)
    bar.close()  # again, as when it is collected
    (rate,) = RATES[before:]
    assert (rate.title, rate.unit, rate.count) == ("shadow", "views", 25)
    assert 0 < rate.seconds < 60
    assert rate.per_second == 25 / rate.seconds
