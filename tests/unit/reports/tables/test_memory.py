import pandas as pd
import pytest
import trimesh
from report_samples import PUBLISHED, RUN, row

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
    trimesh.creation.icosphere(2).export(tmp_path / "mesh.ply")
    weights = tmp_path / "networks" / "dragon" / "weights.safetensors"
    weights.parent.mkdir(parents=True)
    save_network(
        weights, FrequencyNetwork(**THESIS), {"network": {"encoding": "frequency"} | THESIS}
    )

    def write():
        memory.write(
            mesh_ply=tmp_path / "mesh.ply",
            weights=[weights],
            published_csv=PUBLISHED,
            csv=tmp_path / "table.csv",
            md=tmp_path / "table.md",
            title="Memory",
            published="4.7",
            rows=ROWS,
            run=RUN,
        )
        return pd.read_csv(tmp_path / "table.csv"), (tmp_path / "table.md").read_text()

    return write


def test_table_agrees_with_the_thesis_to_its_last_printed_digit(write):
    frame, markdown = write()
    assert frame["method"].tolist() == ["Thesis's network", "512² shadow map", "128² shadow map"]
    assert frame["bytes"].tolist() == [2_227_200, 4 * 512**2, 4 * 128**2]
    assert frame["thesis_memory_mib"].tolist() == [2.12, 1, 0.0625]
    assert frame["memory_mib_minus_thesis"].abs().max() < 0.005
    assert "2,227,200" in markdown


def test_a_map_that_takes_more_than_the_formula_is_refused(write, monkeypatch):
    monkeypatch.setattr(memory, "shadow_map_file_bytes", lambda *_: 1)
    with pytest.raises(InputError, match=r"shadow_map_128: its file holds 1 bytes"):
        write()
