"""Refusal of fields beyond the memory."""

import pytest
import trimesh
from built_networks import make_network

from neural_shadows.errors import InputError
from neural_shadows.representations.distance_bricks import field_memory
from neural_shadows.running import process_memory

FIELD = {"encoding": "occupancy_field", "surface": "solid", "stored": "int8"}


def test_a_field_that_does_not_fit_is_refused_with_its_size(tmp_path, monkeypatch):
    """Before its bricks are laid out; the resolution that is proposed fits."""
    trimesh.creation.icosphere(3, radius=0.9).export(tmp_path / "mesh.ply")
    available = 40 * field_memory.BYTES_PER_BRICK
    monkeypatch.setattr(field_memory, "available_bytes", lambda: available)
    refused = r"resolution: 64: makes 9\d\d bricks, which need \d+\.\d GiB .* 0\.0 GiB are free"
    network = make_network(FIELD | {"resolution": 64})
    with pytest.raises(InputError, match=refused) as error:
        network.prepare(tmp_path / "mesh.ply")
    assert len(network.values) == 0
    most = int(str(error.value).rstrip(".").rsplit(" ", 1)[1])
    assert 0 < most < 64 and most % 4 == 0
    make_network(FIELD | {"resolution": most}).prepare(tmp_path / "mesh.ply")


def test_a_container_may_have_less_than_the_machine(tmp_path, monkeypatch):
    """What its other processes use is not available, but for cached files."""
    limit = tmp_path / "memory.max"
    monkeypatch.setattr(process_memory, "CONTAINER", tmp_path)
    machine = process_memory.available_bytes()
    assert machine > 2**26
    limit.write_text("max\n")
    assert process_memory.available_bytes() == pytest.approx(machine, rel=0.3)
    limit.write_text("4096\n")
    (tmp_path / "memory.current").write_text("3072\n")
    (tmp_path / "memory.stat").write_text("anon 2048\ninactive_file 512\nactive_file 512\n")
    assert process_memory.available_bytes() == 4096 - 3072 + 512
