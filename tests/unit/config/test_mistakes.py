"""Each mistake is reported in one line with its key, its value and what is allowed."""

import pytest
import yaml

from neural_shadows.config.reading import read_config
from neural_shadows.errors import InputError

# Key, value in YAML, and what the message has among others.
MISTAKES = """
sceens | {} | unknown key: 'sceens' (did you mean 'scenes'?) is not among scale, seed
rendering.width | '600' | rendering.width = '600': Input should be a valid integer
rendering.width | null | rendering.width: this key is missing
rendering | 3 | rendering: should be a section of keys, not 3
scenes.My | {mesh: {path: x.ply}} | scenes.My = 'My': String should match pattern
claims.slower_than_shadow_maps.kind | null | claims.slower_than_shadow_maps: the key 'kind' is missing
networks.256 | {encoding: occupancy_field} | networks.256 = 256: Input should be a valid string
networks.thesis.encoding | wavelet | encoding = 'wavelet': should be one of 'frequency', 'ray_grid'
networks.field_128.resolution | 66 | resolution = 66: Input should be a multiple of 4
experiments.dragon_hash_grid.network.table_size | 1000 | table_size: 1000 is not a power of two
samplings.uniform.min_quad | 256 | samplings.uniform: min_quad = 256: must not exceed
samplings.uniform.shards | 2001 | shards = 2001: must not exceed directions (2000)
trainings.base.learning_rate | 1e-3 | = '1e-3': is text to YAML; write a number with a
trainings.base.learning_rate | .nan | learning_rate = nan: Input should be a finite
compute | {device: gpu} | compute.device = 'gpu': Input should be 'auto', 'cpu' or
scale | networks | scale = 'networks': is the name of a folder of results
scenes.dragon.mesh | wyrm | scenes.dragon.mesh = 'wyrm': should be one of {generate: wyrm, fence
scenes.dragon.mesh.path | x.ply | (an overlay drops a key of the default by setting it to null)
scenes.dragon.mesh.generate | dog | mesh.generate = 'dog': should be one of 'wyrm'
scenes.landscape.light.axis | y | must be horizontal, not `up`; allowed: x, z
scenes.landscape.view_sets | [shadow] | 'shadow' needs a scene with ground: true
scenes.dragon.view_sets | [surface, surface] | must name each only once
experiments.dragon.scene | dog | experiments.dragon.scene: 'dog' is not among dragon, fence
experiments.dragon.network | thesi | experiments.dragon.network: 'thesi' (did you mean 'thesis'?)
experiments.dragon.training | {batch_size: 16, steps: 5} | learning_rate: this key is missing
experiments.dragon.bias | best | experiments.dragon.bias = 'best': Input should be 'held_out'
experiments.dragon.label | '{depth}' | the label '{depth}' of dragon: what stands in braces
experiments.dragon_biased | {like: dragon} | experiments.dragon_biased: tables and pictures have a method
experiments.twin | {like: dragon} | experiments.twin: is the same as experiments.dragon
tables.index | {rows: [dragon], title: x} | tables.index: a report has this name
tables.maps | {rows: [shadow_map_64], title: x} | tables.maps: has shadow maps alone and needs a `scene`
tables.cost.kind | costs | tables.cost.kind = 'costs': should be one of 'comparison'
tables.cost.samples | [20000, 20000] | tables.cost.samples = [20000, 20000]: must grow from each
tables.table_4_3.figures | [x] | tables.table_4_3.figures.0: 'x' is not among figure_3_1
tables.table_4_3.rows.0 | dragn | tables.table_4_3.rows of dragon: 'dragn' (did you mean 'dragon
tables.table_4_3.rows.0 | shadow_map_99999 | rows of dragon: 'shadow_map_99999' (did you mean
tables.table_4_3.rows.0 | ray_traced | rows of dragon: 'ray_traced' is not among
tables.table_4_3.rows.0 | {bias: held_out, method: shadow_map_512} | rows with a bias: 'shadow_map_5
tables.table_4_3.rows.0 | shadow_map_512 | 'shadow_map_512' is there twice
tables.beyond.rows.dragon.13 | dragon | "Thesis's network" is there twice
tables.beyond.rows.hill | [dragon] | tables.beyond.rows.hill: 'hill' is not among dragon, fence
figures.figure_4_4.view_sets | [centre] | figure_4_4.view_sets: 'centre' is not among shadow, su
figures.figure_beyond_dragon.table | table_4_6 | 'table_4_6' is not among beyond, ablations
figures.figure_beyond_dragon.scene | landscap | (did you mean 'landscape'?) is not among dragon
figures.figure_beyond_pictures_fence.methods | [ray_traced] | methods: 'ray_traced' is not among
figures.figure_beyond_slice.experiment | dragon | experiment: 'dragon' (did you mean 'dragon_fi
claims.sampling.pairs | [[dragon, x]] | claims.sampling.pairs: 'x' is not among dragon
claims.sampling.pairs | [[shadow_map_8, shadow_map_4]] | one of them should be an experiment
claims.learning_rate.pairs | [[dragon, dragon_biased]] | 'dragon_biased' (did you mean
claims.learning_rate.pairs | [[dragon, dragon]] | 'dragon' is compared with itself
claims.lower_bound_costs_more.methods | [shadow_map_8] | methods: ['shadow_map_8']: one of
claims.lower_bound_costs_more.less | false_shadow | more = 'false_shadow': must be another
claims.slower_than_shadow_maps.at_least | null | needs `at_least`, `at_most`, or both
claims.slower_than_shadow_maps.table | table_4_3 | 'table_4_3' (did you mean 'table_4_6'?)
claims.slower_than_shadow_maps.pairs | [[dragon, shadow_map_8]] | 'shadow_map_8' (did you me
"""


@pytest.mark.parametrize("mistake", MISTAKES.strip().splitlines())
def test_mistakes(message, values, mistake):
    key, value, words = mistake.split(" | ")
    value = yaml.safe_load(value)
    if value == {"like": "dragon"}:
        value = values["experiments"]["dragon"] | {"label": "Twin"}
    assert words in message(key, value)


def test_several_mistakes_are_counted(values):
    values["rendering"] |= {"width": 3, "height": 3}
    with pytest.raises(InputError, match=r"rendering\.width = 3: .* \(and 1 more\)$"):
        read_config(values)
