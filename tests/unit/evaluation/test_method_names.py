import pytest

from neural_shadows.evaluation import method_names as names


@pytest.mark.parametrize(
    ("method", "label"),
    [
        ("shadow_map_512", "512² shadow map"),
        ("shadow_map_16bit_2048", "2048² shadow map, 16 bit"),
        ("shadow_map_pcf_2", "2² shadow map, 2 × 2 PCF"),
        ("shadow_map_pcf_16bit_32768", "32768² shadow map, 2 × 2 PCF, 16 bit"),
        ("no_shadow", "No shadow"),
        ("all_dark", "All dark"),
    ],
)
def test_methods_that_need_no_network(method, label):
    assert names.is_classic(method) and names.classic_label(method) == label
    (module,) = names.hard_modules([method, names.biased_key(method)])
    assert module.stem == ("shadow_map" if "map" in label else "null")


@pytest.mark.parametrize(
    "method",
    ["dragon", "ray_traced", "shadow_map", "shadow_map_16bit", "shadow_map_1", "shadow_map_32769"]
    + ["shadow_map_pcf_", "shadow_map_8bit_512", "shadow_map_-4", "shadow_map_512_biased"],
)
def test_others(method):
    assert not names.is_classic(method)
    assert names.hard_modules([method]) == set() or method.endswith(names.BIASED_SUFFIX)


@pytest.mark.parametrize("method", ["dragon", "shadow_map_pcf_512"])
def test_a_bias_comes_off_a_key_again(method):
    biased = names.biased_key(method)
    assert biased != method == names.unbiased(biased) == names.unbiased(method)
