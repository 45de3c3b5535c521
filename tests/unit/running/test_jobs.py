"""A job's log holds all that it says and its record; its terminal what went wrong, if it failed."""

import datetime
import hashlib
import json
import os
import platform
import pty
import signal
import subprocess
import sys
from importlib.metadata import version
from pathlib import Path

import pytest

START = """
import os, sys, warnings
from types import SimpleNamespace
from neural_shadows.errors import InputError
from neural_shadows.running.jobs import run_job
from neural_shadows.running.progress import progress_bar
from snakemake.iocontainers import InputFiles, OutputFiles, Params, Wildcards

job = SimpleNamespace(
    log=[sys.argv[1]],
    rule="train",
    threads=2,
    wildcards=Wildcards(fromdict={"experiment": "dragon"}),
    input=InputFiles(fromdict={"mesh": __file__, "rays": [__file__, __file__], "none": []}),
    output=OutputFiles(fromdict={"weights": "results/a b.safetensors", "loss": "loss.csv"}),
    params=Params(fromdict={"width": 256, "seed": 7, "frames": {"seed": 8, "fov": 45.0}}),
)

def main(job):
    print("print to stdout", job.params.width)
    print("print to stderr", file=sys.stderr)
    os.write(1, b"native stdout\\n")
    os.write(2, b"native stderr\\n")
    os.system("echo from a child")
    warnings.warn("a warning")
    with progress_bar(2000, "samples", "train") as bar:
        bar.update(2000)
"""

SAID = (
    "print to stdout 256",
    "print to stderr",
    "native stdout",
    "native stderr",
    "from a child",
    "UserWarning: a warning",
    "train: 100%",
    "2.00k/2.00k",
)


def script_of(tmp_path: Path, code: str) -> Path:
    script = tmp_path / "script.py"
    script.write_text(START + code, encoding="utf-8")
    return script


def run(tmp_path: Path, code: str, log: str = "logs/train/a job.log", **settings):
    """Run `START` + `code` as a script; gives the process and the log's text."""
    path = tmp_path / log
    environment = {**os.environ, "PYTHONPATH": os.pathsep.join(sys.path), "PYTHONUTF8": "1"}
    environment.pop("PYTHONUNBUFFERED", None)
    done = subprocess.run(
        [sys.executable, script_of(tmp_path, code), path],
        env=environment | settings.pop("env", {}),
        stdout=subprocess.PIPE,
        stderr=settings.pop("stderr", subprocess.PIPE),
        text=True,
        timeout=60,
        **settings,
    )
    return done, path.read_bytes().decode()  # as bytes, to keep a \r


def record_of(log: str) -> dict:
    """The one line of JSON in a log."""
    (line,) = (line for line in log.splitlines() if line.startswith("{"))
    return json.loads(line)


ALONE = "  run it alone: snakemake --cores 2 'results/a b.safetensors'"


def test_a_job_that_succeeds(tmp_path):
    done, log = run(tmp_path, "run_job(job, main)\n")
    assert done.returncode == 0
    assert done.stdout == done.stderr == ""
    for text in SAID:
        assert text in log
    # Everything in the order in which it was said, by whatever way.
    assert log.index(SAID[0]) < log.index(SAID[1]) < log.index(SAID[2]) < log.index(SAID[3])


@pytest.mark.parametrize(
    ("error", "told"),
    [
        ("InputError('a.ply: not a mesh; give a .ply')", "a.ply: not a mesh; give a .ply"),
        ("OSError(28, 'No space left on device', 'a.npy')", "No space left on device: 'a.npy'"),
        ("ZeroDivisionError('by zero')", "ZeroDivisionError: by zero"),
        ("RuntimeError('first line\\n  second line\\n')", "RuntimeError: first line"),
        ("InputError('2048² – π')", "2048² – π"),
    ],
)
def test_a_job_that_fails(tmp_path, error, told):
    code = f"""
def failing(job):
    main(job)
    raise {error}

run_job(job, failing)
"""
    done, log = run(tmp_path, code)
    assert done.returncode == 1
    assert done.stdout == ""
    line, *last, alone = done.stderr.splitlines()
    assert line.startswith("train: ") and told in line
    assert line.endswith(f"[log: '{tmp_path}/logs/train/a job.log']")  # quoted: it has a space
    assert "Traceback" not in line
    for text in SAID:
        assert text in log
    assert "Traceback (most recent call last)" in log and "in failing" in log
    assert log.endswith(line + "\n")
    assert record_of(log)["outcome"] == line[len("train: ") : line.index(" [log")]
    assert alone == ALONE
    # How the log ended with the error, line by line; of what names its reason, before it.
    assert 5 <= len(last) <= 10 and all(text.startswith("  | ") for text in last)
    before = log[: log.index("\ntrain: " + line[len("train: ") : line.index(" [log")])]
    if "Input" in error or "OSError" in error:
        before = before[: before.index("\nTraceback")]
        assert last[-1].startswith("  | train: 100%")
    assert [text[4:] for text in last] == before.splitlines()[-len(last) :]


def test_the_record(tmp_path):
    done, log = run(tmp_path, "run_job(job, main)\n", env={"ACCESS_TOKEN": "token-of-a-user"})
    assert done.returncode == 0
    record = record_of(log)
    assert log.endswith("}\n")
    assert (record["rule"], record["outcome"], record["threads"]) == ("train", "done", 2)
    assert record["wildcards"] == {"experiment": "dragon"}
    assert record["params"] == {"width": 256, "seed": 7, "frames": {"seed": 8, "fov": 45.0}}
    assert record["seeds"] == {"seed": 7, "frames.seed": 8}
    script = tmp_path / "script.py"
    content = script.read_bytes()
    file = {"path": str(script), "bytes": len(content)}
    file["sha256"] = hashlib.sha256(content).hexdigest()
    assert record["inputs"] == {"mesh": [file], "rays": [file, file], "none": []}
    assert record["outputs"] == {"weights": ["results/a b.safetensors"], "loss": ["loss.csv"]}
    (rate,) = record["rates"]
    assert (rate["title"], rate["unit"], rate["count"]) == ("train", "samples", 2000)
    assert rate["per_second"] == pytest.approx(2000 / rate["seconds"])
    assert 0 < rate["seconds"] < record["seconds"] < 60
    assert 0 < record["cpu_seconds"] < 60 and 10 < record["peak_mib"] < 1000
    started = datetime.datetime.fromisoformat(record["started"])
    assert abs(datetime.datetime.now(datetime.UTC) - started) < datetime.timedelta(minutes=2)
    assert record["versions"]["python"] == platform.python_version()
    assert record["versions"]["tqdm"] == version("tqdm")
    assert "pytest" not in record["versions"]  # which the job did not load
    # The same to read.
    for text in (
        "\ntrain: done\n",
        "rate of train: 2,000 samples in ",
        f"input mesh: 1 file, 0.0 MB, SHA-256 {file['sha256'][:16]}\n",
        "input rays: 2 files, ",
        "param seed: 7\n",
        f"python {platform.python_version()}, ",
    ):
        assert text in log
    assert "token-of-a-user" not in log


def test_the_record_of_a_job_whose_input_is_gone(tmp_path):
    """The job itself says what is wrong with it."""
    code = """
job.input = InputFiles(fromdict={"mesh": "nowhere.ply"})
def failing(job):
    raise InputError("nowhere.ply: no such file")
run_job(job, failing)
"""
    done, log = run(tmp_path, code)
    assert done.stderr.startswith("train: nowhere.ply: no such file [log")
    assert record_of(log)["inputs"] == {"mesh": []}


def test_the_command_has_the_configuration_of_the_run(tmp_path):
    code = """
from pathlib import Path
from neural_shadows.running.jobs import remember_configuration
def failing(job):
    raise InputError("wrong")
remember_configuration([Path("config/smoke.yaml").absolute(), "a b.yaml"], ["seed=7", "m={n: 1}"])
run_job(job, failing)
"""
    done, _ = run(tmp_path, code)
    *_, alone = done.stderr.splitlines()
    given = "--configfile config/smoke.yaml 'a b.yaml' --config seed=7 'm={n: 1}'"
    assert alone == f"{ALONE} {given}"


def test_where_native_code_crashed_is_in_the_log(tmp_path):
    code = """
import ctypes
def crashing(job):
    ctypes.string_at(0)
run_job(job, crashing)
"""
    done, log = run(tmp_path, code)
    assert done.returncode == -signal.SIGSEGV
    assert "Segmentation fault" in log and "in crashing" in log


def test_a_log_on_a_full_disk(tmp_path):
    """The terminal still says why the job failed."""
    code = "def f(job):\n    print('a result')\nrun_job(job, f)\n"
    done = subprocess.run(
        [sys.executable, script_of(tmp_path, code), "/dev/full"],
        env={**os.environ, "PYTHONPATH": os.pathsep.join(sys.path)},
        capture_output=True,
        text=True,
        timeout=60,
    )
    assert done.returncode != 0
    line, alone = done.stderr.splitlines()
    assert line == "train: [Errno 28] No space left on device [log: /dev/full]"
    assert alone == ALONE


def test_the_log_is_written_while_the_job_runs(tmp_path):
    code = """
def main(job):
    print("begun")
    print("log so far:", open(job.log[0]).read().split()[-1], file=sys.stderr)

run_job(job, main)
"""
    _, log = run(tmp_path, code)
    assert "log so far: begun" in log


def test_a_name_that_is_no_text_is_logged_all_the_same(tmp_path):
    """A Latin-1 name of a file, as Python decodes it."""
    code = """
job.params = Params(fromdict={"source": "caf\\udce9.ply"})
run_job(job, lambda job: print("done"))
"""
    done, log = run(tmp_path, code)
    assert done.returncode == 0, done.stderr
    assert r"caf\udce9.ply" in log


def test_a_new_run_replaces_the_log(tmp_path):
    (tmp_path / "a.log").write_text("old\n" * 1000)
    _, log = run(tmp_path, "run_job(job, main)\n", log="a.log")
    assert "old" not in log


def test_a_terminal_shows_the_progress(tmp_path):
    """Somebody watching sees bars and errors, but not what is printed."""
    leader, follower = pty.openpty()
    try:
        code = "def f(job):\n    main(job)\n    raise InputError('wrong')\nrun_job(job, f)\n"
        done, log = run(tmp_path, code, log="a.log", stderr=follower)
        shown = os.read(leader, 100_000).decode()
    finally:
        os.close(leader)
        os.close(follower)
    assert done.returncode == 1
    assert "\rtrain: 100%" in shown and f"train: wrong [log: {tmp_path}/a.log]" in shown
    shown = shown[: shown.index("train: wrong")]  # and then how the log ends
    assert "native" not in shown and "print to stdout" not in shown and "Traceback" not in shown
    assert "\r" not in log and "\ntrain: 100%" in log


def test_a_terminal_without_the_signs(tmp_path):
    code = "def f(job):\n    raise InputError(f'2048{chr(0xB2)} maps')\nrun_job(job, f)\n"
    done = subprocess.run(
        [sys.executable, "-X", "utf8=0", script_of(tmp_path, code), tmp_path / "a.log"],
        env={
            **{key: value for key, value in os.environ.items() if not key.startswith("LC_")},
            "PYTHONPATH": os.pathsep.join(sys.path),
            "LC_ALL": "C",
            "PYTHONCOERCECLOCALE": "0",
        },
        capture_output=True,
        timeout=60,
    )
    assert done.returncode == 1
    assert done.stderr.startswith(b"train: 2048\\xb2 maps [log: ")
    assert "2048² maps" in (tmp_path / "a.log").read_text(encoding="utf-8")
