import io

import pytest

from neural_shadows.running import progress
from neural_shadows.running.progress import progress_bar


@pytest.mark.parametrize(
    ("unit", "total", "seconds", "line"),
    [
        ("samples", 4000, 0.5, "25 % of 4.00k samples, 2.00k samples/s, 00:01 left"),
        ("views", 24, 22.5, "25 % of 24 views, 3.8 s a view, 01:07 left"),
    ],
)
def test_a_quarter_of_a_job(monkeypatch, capsys, unit, total, seconds, line):
    monkeypatch.setattr(progress, "_SECONDS", 0)
    for terminal in (None, io.StringIO()):
        monkeypatch.setattr(progress, "TERMINAL", terminal)
        with progress_bar(total, unit, "train dragon") as bar:
            bar.start_t = bar.last_print_t = 0
            bar._time = lambda: seconds  # a busy machine's own is later at the last line
            bar.update(total // 4)
        log = capsys.readouterr().err
        if terminal:
            assert log == terminal.getvalue() and log.endswith(f"\ntrain dragon:  {line}\n")
        else:  # a call from Python
            assert "train dragon:  25%|" in log and f"{line.split(', ')[1]}]" in log
