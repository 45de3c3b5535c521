"""Bars show the count, the rate and the time left; where nobody watches, a line now and then."""

import io

from neural_shadows.running import progress
from neural_shadows.running.progress import progress_bar


def test_bar_of_a_call_from_python(capsys):
    with progress_bar(30_000, "samples", "train dragon", initial=15_000) as bar:
        bar.update(15_000)
        # What was done before does not count: 15,000 in 2 s.
        shown = bar.format_meter(**{**bar.format_dict, "elapsed": 2.0, "rate": None})
    out, err = capsys.readouterr()
    assert out == "" and "7.50k samples/s" in shown
    first, *_, last = err.split("\r")[1:]
    assert first.startswith("train dragon:  50%") and "15.0k/30.0k" in first
    assert "100%" in last and "30.0k/30.0k" in last


def test_lines_of_a_job_that_nobody_watches(monkeypatch, capsys):
    """On the terminal's file and in the log, and of no job that takes no longer than a line."""
    texts = {}
    for seconds in (0, 1000):
        monkeypatch.setattr(progress, "TERMINAL", io.StringIO())
        monkeypatch.setattr(progress, "_SECONDS", seconds)
        with progress_bar(4000, "samples", "train dragon") as bar:
            bar.update(1000)
        texts[seconds] = progress.TERMINAL.getvalue()
        assert texts[seconds] == capsys.readouterr().err
    assert texts[0].splitlines()[-1].startswith("train dragon:  25 % of 4.00k samples, ")
    assert texts[0].endswith(" left\n") and "samples/s" in texts[0]
    assert texts[1000] == ""
