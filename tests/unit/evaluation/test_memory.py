import pytest

from neural_shadows.evaluation.memory import network_bytes, stored_bytes
from neural_shadows.networks.object_space.frequency_network import FrequencyNetwork
from neural_shadows.networks.weight_file import save_network


# Table 4.6 and 4.7 [4.4]: 2,227,200 bytes is written out in the text.
@pytest.mark.parametrize(
    ("width", "size", "kib"), [(256, 2_227_200, 2175), (128, 589_312, 575.5), (64, 163_584, 159.75)]
)
def test_network_takes_the_bytes_that_the_thesis_prints(tmp_path, width, size, kib):
    settings = {"frequencies": 10, "width": width, "hidden_layers": 8}
    network, path = FrequencyNetwork(**settings), tmp_path / "weights.safetensors"
    save_network(path, network, {"network": {"encoding": "frequency"} | settings})
    assert stored_bytes(path) == network_bytes(path) == size == 1024 * kib
    assert size == 4 * network.parameter_count()


@pytest.mark.parametrize(
    ("method", "mib"),
    [
        ("shadow_map_2048", 16),
        ("shadow_map_128", 0.0625),
        ("shadow_map_pcf_2048", 16),
        ("shadow_map_16bit_2048", 8),
        ("shadow_map_pcf_16bit_1024", 2),
        *(("ray_traced", None), ("no_shadow", None), ("all_dark", None)),
    ],
)
def test_shadow_map_takes_four_bytes_a_texel_or_two_and_others_none(method, mib):
    assert stored_bytes(method) == (mib and mib * 2**20)
