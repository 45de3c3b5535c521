"""Which logs are those of jobs that could not say why they ended."""

import os
import time

from neural_shadows.running.killed_jobs import tell_of_killed_jobs

ALONE = "run it alone: snakemake --cores 1 results/a.npy"


def test_only_jobs_of_this_run_without_a_record_are_told_of(tmp_path, capsys):
    for name, text in {
        "killed": f"{ALONE}\nhalf way\n",
        "killed at once": f"{ALONE}\n",
        "done": f"{ALONE}\nhalf way\ntrain: done\n{{}}\n",
        "done, of many inputs": f"{ALONE}\ntrain: done\n{{{'x' * 20_000}}}\n",
        "failed": f"{ALONE}\nTraceback\n{{}}\ntrain: no such file [log: a]\n",
        "interrupted": f"{ALONE}\nTraceback\nKeyboardInterrupt\n",
        "another program's": "half way\n",
        "earlier": f"{ALONE}\nhalf way\n",
    }.items():
        path = tmp_path / "train" / f"{name}.log"
        path.parent.mkdir(exist_ok=True)
        path.write_text(text)
    begun = time.time() - 100
    os.utime(tmp_path / "train" / "earlier.log", (begun - 1,) * 2)

    tell_of_killed_jobs(tmp_path, begun)
    word = "train: ended without a word: killed (out of memory, past its time, or by somebody), or"
    assert capsys.readouterr().err.splitlines() == [
        f"{word} crashed [log: {tmp_path}/train/killed at once.log]",
        f"  {ALONE}",
        f"{word} crashed [log: {tmp_path}/train/killed.log]",
        "  | half way",
        f"  {ALONE}",
    ]
