import pandas as pd
import pytest
import trimesh

from neural_shadows.errors import InputError
from neural_shadows.networks.object_space.frequency_network import FrequencyNetwork
from neural_shadows.networks.weight_file import save_network
from neural_shadows.reports.tables import memory as memory_table
from neural_shadows.reports.tables.memory import write_memory_table

KIND = {"encoding": "frequency"}
THESIS = {"frequencies": 10, "width": 256, "hidden_layers": 8}
ROWS = [
    {"method": "shadow_map_128", "label": "128² shadow map", "published": None},
    {"method": "dragon", "label": "Our method", "published": "network"},
    {"method": "shadow_map_512", "label": "512² shadow map", "published": None},
]


@pytest.fixture
def write(tmp_path):
    trimesh.creation.icosphere(2).export(tmp_path / "mesh.ply")
    weights = tmp_path / "weights.safetensors"
    save_network(weights, FrequencyNetwork(**THESIS), {"network": KIND | THESIS})

    def write():
        write_memory_table(
            tmp_path / "mesh.ply",
            {"dragon": weights},
            "config/published.csv",
            tmp_path / "table.csv",
            tmp_path / "table.md",
            title="Memory",
            number="4.7",
            rows=ROWS,
            scale="test",
        )
        return pd.read_csv(tmp_path / "table.csv"), (tmp_path / "table.md").read_text()

    return write


def test_table_agrees_with_the_thesis_to_its_last_printed_digit(write):
    frame, markdown = write()
    assert frame["method"].tolist() == ["Our method", "512² shadow map", "128² shadow map"]
    assert frame["bytes"].tolist() == [2_227_200, 4 * 512**2, 4 * 128**2]
    assert frame["thesis_memory_mib"].tolist() == [2.12, 1, 0.0625]
    assert frame["memory_mib_minus_thesis"].abs().max() < 0.005
    assert "| Our method" in markdown
    assert "2,227,200" in markdown


def test_a_map_that_takes_more_than_the_formula_is_refused(write, monkeypatch):
    monkeypatch.setattr(memory_table, "shadow_map_file_bytes", lambda *_: 1)
    with pytest.raises(InputError, match=r"shadow_map_128: its file holds 1 bytes"):
        write()
