"""Libraries of one thread, whenever they are loaded."""

import os
import subprocess
import sys

import pytest

LOADED_WITHIN = """
from neural_shadows.running.one_thread import one_thread
with one_thread():
    import torch
    print(torch.get_num_threads())
"""


@pytest.mark.skipif(os.cpu_count() == 1, reason="one core: PyTorch has one thread anyway")
def test_pytorch_that_is_loaded_within_has_one_thread():
    environment = {**os.environ, "PYTHONPATH": os.pathsep.join(sys.path), "OMP_NUM_THREADS": "2"}
    command = [sys.executable, "-c", LOADED_WITHIN]
    assert subprocess.check_output(command, env=environment, text=True) == "1\n"
