import pytest
import report_samples as samples
from matplotlib import font_manager
from matplotlib.ft2font import FT2Font

from neural_shadows.evaluation.registry import METHODS, NETWORK_LOOK, family_look
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


# Of one meaning: the tests of several texels, averaged.
ALIKE = {"filtered shadow map": "percentage-closer filtering"}


def test_one_symbol_means_one_thing_on_the_whole_page():
    """Of hard and of soft shadows; the exact shadow of a pixel's centre is not their reference."""
    looks = {*LOOKS.values(), *map(family_look, METHODS), NETWORK_LOOK}
    meanings = {
        symbol: {ALIKE.get(look.name, look.name) for look in looks if look.symbol == symbol}
        for symbol in {look.symbol for look in looks}
    }
    assert not {symbol: names for symbol, names in meanings.items() if len(names) > 1}
    drawn = {(look.colour, look.marker): look.name for look in looks if look.name not in ALIKE}
    assert len(drawn) == len({look.name for look in looks} - {*ALIKE})


@pytest.mark.parametrize(
    "look",
    {**{key: family_look(key) for key in METHODS}, **LOOKS}.values(),
    ids=lambda look: look.name,
)
def test_figures_have_every_symbol(look):
    glyphs = FT2Font(font_manager.findfont("DejaVu Sans")).get_charmap()
    assert ord(look.symbol) in glyphs
