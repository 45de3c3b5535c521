import pytest
import report_samples as samples
from matplotlib import font_manager
from matplotlib.ft2font import FT2Font

from neural_shadows.reports.data.method_look import LOOKS, look_of


def name_of(method, **network):
    return look_of(samples.row(method, **network)).name


def test_methods_of_a_kind_look_alike_and_kinds_do_not():
    assert name_of("shadow_map_128") == name_of("shadow_map_2048_biased") == "shadow map"
    assert name_of("shadow_map_pcf_512") == "filtered shadow map"
    assert name_of("shadow_map_pcf_16bit_512") == "16-bit shadow map"
    assert name_of("dragon_64_biased") == "thesis's network"
    assert name_of("dragon_field", encoding="occupancy_field") == "occupancy field"
    assert name_of("near", encoding="occupancy_field", trained=False) == "grid without training"
    assert name_of("no_shadow") == name_of("all_dark") == "no method"
    assert name_of("ray_traced") == "exact shadow"
    assert name_of("mine", encoding="my_network") == "my network"  # a kind of the user's own
    looks = {*LOOKS.values()}
    for of_each in ({look.symbol for look in looks}, {look.name for look in looks}):
        assert len(of_each) == len(looks)
    assert len({(look.colour, look.marker) for look in looks}) == len(looks)


@pytest.mark.parametrize("look", LOOKS.values(), ids=LOOKS)
def test_figures_have_every_symbol(look):
    glyphs = FT2Font(font_manager.findfont("DejaVu Sans")).get_charmap()
    assert ord(look.symbol) in glyphs
