"""Each mistake is reported in one line with its key, its value and what is allowed."""

import pytest
import yaml

# Key, value in YAML, and what the message has among others.
MISTAKES = """
sceens | {} | unknown key: 'sceens' (did you mean 'scenes'?) is not among scale, seed
rendering.width | '600' | rendering.width = '600': Input should be a valid integer
rendering.width | null | rendering.width: this key is missing
claims.slower_than_shadow_maps.kind | null | claims.slower_than_shadow_maps: the key 'kind' is missing
networks.thesis.encoding | wavelet | encoding = 'wavelet': should be one of 'frequency', 'ray_grid'
experiments.dragon_hash_grid.network.table_size | 1000 | table_size: 1000 is not a power of two
trainings.base.learning_rate | 1e-3 | = '1e-3': is text to YAML; write a number with a
scale | networks | scale = 'networks': is the name of a folder of results
scenes.dragon.mesh.path | x.ply | (an overlay drops a key of the default by setting it to null)
scenes.landscape.light.axis | y | must be horizontal, not `up`; allowed: x, z
scenes.landscape.view_sets | [shadow] | 'shadow' needs a scene with ground: true
experiments.dragon.scene | dog | experiments.dragon.scene: 'dog' is not among dragon, fence
experiments.dragon.network | thesi | experiments.dragon.network: 'thesi' (did you mean 'thesis'?)
experiments.dragon_biased | {like: dragon} | experiments.dragon_biased: '_biased' ends a row's name
experiments.twin | {like: dragon} | experiments.twin: is the same as experiments.dragon
tables.maps | {rows: [shadow_map_64], title: x} | tables.maps: has shadow maps alone and needs a `scene`
tables.table_4_3.rows.0 | dragn | tables.table_4_3.rows of dragon: 'dragn' (did you mean 'dragon
tables.table_4_3.rows.0 | shadow_map_512 | 'shadow_map_512' is there twice
figures.figure_4_4.view_sets | [centre] | figure_4_4.view_sets: 'centre' is not among shadow, su
figures.figure_beyond_dragon.table | table_4_6 | 'table_4_6' is not among beyond, ablations
figures.figure_beyond_slice.experiment | dragon | experiment: 'dragon' (did you mean 'dragon_fi
claims.sampling.pairs | [[shadow_map_8, shadow_map_4]] | one of them should be an experiment
claims.learning_rate.pairs | [[dragon, dragon]] | 'dragon' is compared with itself
claims.lower_bound_costs_more.less | false_shadow | more = 'false_shadow': must be another
claims.slower_than_shadow_maps.pairs | [[dragon, shadow_map_8]] | 'shadow_map_8' (did you me
"""


@pytest.mark.parametrize("mistake", MISTAKES.strip().splitlines())
def test_mistakes(message, values, mistake):
    key, value, words = mistake.split(" | ")
    value = yaml.safe_load(value)
    if value == {"like": "dragon"}:
        value = values["experiments"]["dragon"] | {"label": "Twin"}
    assert words in message(key, value)
