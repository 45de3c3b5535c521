"""A profile times every part of a network once a frame, whatever its form."""

import json
import time
from pathlib import Path
from typing import Any

import pytest
import torch
from built_networks import make_screen_network

from neural_shadows.evaluation import profile_screen_network as stage
from neural_shadows.networks.settings.networks import screen_network
from neural_shadows.reports.data.screen_profiles import not_timed

KERNELS = {"form": "kernels", "widths": [4, 8], "features": ["cosine", "base_msm"], "filters": 2}
FORMS = [
    {"form": "full", "widths": [4, 8, 8], "extraction": 6},
    {"form": "shuffle", "widths": [4, 8]},
    {"form": "half", "widths": [4, 8]},
    {"form": "original", "widths": [4, 8]},
    KERNELS,
    KERNELS | {"ends": "full"},
]


def profiled(folder: Path, network: dict[str, Any], **changes: Any) -> dict[str, Any]:
    """What the stage writes of a network in a frame of 16 × 8 pixels."""
    path = folder / "profile.json"
    profile = {"width": 16, "height": 8, "repeats": 3, "product_size": 10}
    settings = screen_network(network)
    how = {"network": settings, "profile": profile, "device": "cpu", "threads": 1}
    stage.profile_screen_network(path, **how | changes)
    return json.loads(path.read_text())


@pytest.mark.parametrize("settings", FORMS, ids=lambda one: one["form"] + one.get("ends", ""))
def test_each_part_of_each_level_is_timed(tmp_path, monkeypatch, settings):
    """A clock that goes on by 1 ms at each look: a part takes 1, a whole frame too, untimed inside."""
    ticks = iter(range(10**6))
    monkeypatch.setattr(time, "perf_counter", lambda: next(ticks) / 1000)
    monkeypatch.setattr(stage, "is_native", lambda dtype, device: True)
    network = {"features": ["ratio", "n"]} | settings
    found = profiled(tmp_path, network)
    made = make_screen_network(network)
    weights = sum(one.numel() for one in made.parameters() if one.ndim == 4)
    assert sum(level["weights"] for level in found["levels"]) == weights
    assert [run["precision"] for run in found["runs"]] == ["float32", "bfloat16"]
    for run in found["runs"]:
        places = [(part["level"], part["part"]) for part in run["parts"]]
        assert len(set(places)) == len(places) and set(places) == made.parts().keys()
        assert [part["ms"] for part in run["parts"]] == pytest.approx([1.0] * len(places))
        assert run["whole_ms"] == pytest.approx(1.0)
        assert run["product_macs"] == pytest.approx(10**3 / 1e-3)


def test_a_format_that_the_processor_lacks_is_not_computed_in(tmp_path, monkeypatch):
    """Emulated bfloat16 took the smoke run half an hour on two cores with AVX2 alone."""
    monkeypatch.setattr(stage, "is_native", lambda dtype, device: dtype == torch.float32)
    found = profiled(tmp_path, {"features": ["ratio", "n"]} | FORMS[0])
    assert [run["precision"] for run in found["runs"]] == ["float32"]
    assert found["product_size"] == 10


@pytest.mark.parametrize("native", [True, False])
def test_of_what_tables_show_whole_frames_in_few_formats_alone_are_timed(
    tmp_path, monkeypatch, native
):
    """On all threads; in float32 where no asked one is native, so that the table has a time."""
    monkeypatch.setattr(stage, "is_native", lambda dtype, device: native or dtype == torch.float32)
    network = {"features": ["ratio", "n"]} | FORMS[1]
    found = profiled(tmp_path, network, threads=2, formats=["bfloat16"])
    (run,) = found["runs"]
    assert (run["threads"], run["precision"]) == (2, "bfloat16" if native else "float32")
    assert not run["parts"] and run["whole_ms"] > 0
    assert (" Not timed: bfloat16" in not_timed(found)) != native
