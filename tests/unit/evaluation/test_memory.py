import pytest
import torch
import trimesh
from shapes import prepared

from neural_shadows.errors import InputError
from neural_shadows.evaluation.memory import network_bytes, shadow_map_bytes, shadow_map_file_bytes
from neural_shadows.evaluation.method_names import is_shadow_map, resolution_of, shadow_map_key
from neural_shadows.networks.object_space.frequency_network import FrequencyNetwork
from neural_shadows.networks.weight_file import save_network, save_tensors

KIND = {"encoding": "frequency"}
THESIS = {"frequencies": 10, "width": 256, "hidden_layers": 8}


# Table 4.6 and 4.7 [4.4]: 2,227,200 bytes is written out in the text.
@pytest.mark.parametrize(
    ("width", "size", "kib"), [(256, 2_227_200, 2175), (128, 589_312, 575.5), (64, 163_584, 159.75)]
)
def test_network_takes_the_bytes_that_the_thesis_prints(tmp_path, width, size, kib):
    network = FrequencyNetwork(**THESIS | {"width": width})
    path = tmp_path / "weights.safetensors"
    save_network(path, network, {"network": KIND | THESIS | {"width": width}})
    assert network_bytes(path) == size == 1024 * kib


def test_network_of_another_number_format_is_refused(tmp_path):
    small = {"frequencies": 1, "width": 8, "hidden_layers": 1}
    halves = {name: value.half() for name, value in FrequencyNetwork(**small).state_dict().items()}
    path = tmp_path / "weights.safetensors"
    save_tensors(path, halves, {"network": KIND | small})
    with pytest.raises(InputError, match=r"weights\.safetensors: holds \d+ bytes"):
        network_bytes(path)
    assert halves["output"].dtype == torch.float16


def test_shadow_map_takes_four_bytes_a_texel():
    assert shadow_map_bytes("shadow_map_2048") == 16 * 2**20
    assert shadow_map_bytes("shadow_map_128") == 0.0625 * 2**20


def test_file_of_a_traced_map_has_the_size_of_the_formula():
    mesh, tracer = prepared(trimesh.creation.icosphere(2))
    assert shadow_map_file_bytes(mesh, tracer, "shadow_map_96") == 4 * 96**2


def test_keys_of_shadow_maps():
    assert shadow_map_key(512) == "shadow_map_512"
    assert resolution_of("shadow_map_512") == 512
    assert is_shadow_map("shadow_map_512")
    assert not is_shadow_map("shadow_map_0")
    assert not is_shadow_map("shadow_map_")
    assert not is_shadow_map("my_shadow_map_512")
