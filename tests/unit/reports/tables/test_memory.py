import pytest
import trimesh
from report_samples import row, written_table

from neural_shadows.errors import InputError
from neural_shadows.networks.object_space.frequency_network import FrequencyNetwork
from neural_shadows.networks.weight_file import save_network
from neural_shadows.reports.tables import memory

THESIS = {"frequencies": 10, "width": 256, "hidden_layers": 8}
ROWS = [
    row("shadow_map_128", "128² shadow map"),
    row("dragon", "Thesis's network", published="network"),
    row("shadow_map_512", "512² shadow map"),
]


@pytest.fixture
def write(tmp_path):
    mesh_ply = tmp_path / "mesh.ply"
    trimesh.creation.icosphere(2).export(mesh_ply)
    weights = tmp_path / "networks" / "dragon" / "weights.safetensors"
    weights.parent.mkdir(parents=True)
    network = {"encoding": "frequency"} | THESIS
    save_network(weights, FrequencyNetwork(**THESIS), {"network": network})
    return lambda: written_table(
        memory.write, tmp_path, mesh_ply=mesh_ply, rows=ROWS, published="4.7"
    )


def test_table_agrees_with_the_thesis_to_its_last_printed_digit(write):
    table, md = write()
    assert table["method"].tolist() == ["Thesis's network", "512² shadow map", "128² shadow map"]
    assert table["bytes"].tolist() == [2_227_200, 4 * 512**2, 4 * 128**2]
    assert table["thesis_memory_mib"].tolist() == [2.12, 1, 0.0625]
    assert table["memory_mib_minus_thesis"].abs().max() < 0.005
    assert "2,227,200" in md.read_text()


def test_a_map_that_takes_more_than_the_formula_is_refused(write, monkeypatch):
    monkeypatch.setattr(memory, "shadow_map_file_bytes", lambda *_: 1)
    with pytest.raises(InputError, match=r"shadow_map_128: its file holds 1 bytes"):
        write()
