"""Each mistake is reported in one line with its key, its value and what is allowed."""

import pytest
import yaml

from neural_shadows.config.reading import read_config

# Key, value in YAML, and what the message has among others.
MISTAKES = """
sceens | {} | unknown key: 'sceens' (did you mean 'scenes'?) is not among scale, seed
frame_sets.views.width | '600' | frame_sets.views.width = '600': is text, not a number
frame_sets.views.width | null | frame_sets.views.width: this key is missing
claims.slower_than_shadow_maps.kind | null | claims.slower_than_shadow_maps: the key 'kind' is missing
networks.thesis.encoding | wavelet | encoding = 'wavelet': should be one of 'frequency', 'hash_grid'
experiments.dragon_hash_grid.network.table_size | 1000 | table_size: 1000 is not a power of two
trainings.base.learning_rate | 1e-3 | = '1e-3': is text, not a number. In a file write it without quotes
scale | networks | scale = 'networks': is a folder of results
scale | sun_hours | scale = 'sun_hours': is a folder of results
scenes.dragon.mesh.path | x.ply | (an overlay removes a key of the default by setting it to null)
scenes.landscape.light.axis | y | must be horizontal, not `up`. Allowed: x, z
scenes.landscape.view_sets | [shadow] | 'shadow' needs a scene with ground: true
experiments.dragon.scene | dog | experiments.dragon.scene: 'dog' is not among dragon, fence
experiments.dragon.network | thesi | experiments.dragon.network: 'thesi' (did you mean 'thesis'?)
experiments.dragon_biased | {like: dragon} | experiments.dragon_biased: '_biased' is the ending of rows with a bias
experiments.twin | {like: dragon} | experiments.twin: equals experiments.dragon
tables.maps | {rows: [shadow_map_64], title: x} | tables.maps: has shadow maps only. Add `scene`
tables.table_4_3.rows.0 | dragn | tables.table_4_3.rows: of dragon: 'dragn' (did you mean 'dragon
tables.table_4_3.rows.0 | shadow_map_512 | 'shadow_map_512' is listed twice
tables.table_4_3.rows.0 | fence | tables.table_4_3.rows: of dragon: 'fence' has the scene 'fence'. Name one of dragon
tables.table_4_3.rows.0 | {method: dragon_64, published: netwrk} | tables.table_4_3: published: 'netwrk' (did you mean 'network'?)
tables.beyond.rows.dragon.0 | {method: ray_traced, published: network} | tables.beyond: has rows with `published`: 'network', and none itself
tables.beyond.against | {city: dragon} | tables.beyond.against: 'city' is not among dragon, fence
tables.kpnsm_table_3.methods | [{method: pcss, published: pccs}] | tables.kpnsm_table_3: published: 'pccs'
tables.kpnsm_table_2.methods.0 | {method: pcss, published: layers_3, column: filter} | published: layers_3: column: 'filter'
tables.nsm_table_s4.networks.0 | {network: layers_3, published: layer_3} | tables.nsm_table_s4: published: 'layer_3'
tables.nsm_unseen.frame_set | sun | tables.nsm_unseen.networks: 'nsm' is trained on lights with radii in metres
frame_sets.nsm_plates.radii | [0] | nsm_plates' has lights without extent alone
figures.figure_nsm_flicker.methods | [nsm_trimed] | figure_nsm_flicker.methods: 'nsm_trimed' (did you mean 'nsm_trimmed'?)
figures.figure_4_4.view_sets | [centre] | figure_4_4.view_sets: 'centre' is not among shadow, su
figures.figure_beyond_dragon.table | table_4_6 | 'table_4_6' is not among beyond, ablations
figures.figure_beyond_slice.experiment | dragon | experiment: 'dragon' (did you mean 'dragon_fi
viewers.viewer.scene | dragn | viewers.viewer.scene: 'dragn' (did you mean 'dragon'?) is not among
viewers.viewer.networks | [shadow_map_64] | 'shadow_map_64' is not an experiment on rays. Remove it; shadow maps are
viewers.viewer.networks | [fence] | viewers.viewer.networks: 'fence' has the scene 'fence', the viewer
viewers.viewer.networks | [dragon_hash_grid] | is a hash_grid, without a shader. Allowed: frequency, occupancy_field
viewers.table | {scene: dragon} | viewers.table
viewers.viewer_soft.scene | interiors | 'interiors' has a layout of its own for each part. Name a scene without
viewers.viewer_soft.frame_set | sun | viewers.viewer_soft.frame_set: 'sun' has no sphere as its light. Name a
viewers.viewer_soft.networks | [dragon] | viewers.viewer_soft.networks.0: 'dragon' is not an experiment on frames
viewers.viewer_soft.networks | [kpnsm_full_ends] | viewers.viewer_soft.networks: 'kpnsm_full_ends' has ends: full, without a shader. Allowed: half
viewers.viewer_soft.networks | [nsm_exponential] | 'nsm_exponential' has answer: exponent, without a shader
tables.t | {title: t, frame_set: frames, methods: [hard]} | tables.t: unknown key: 'frame_set' is not among
tables.t | {title: t, frame_set: frames, methods: [hard]} | (keys of `kind: comparison`, the default)
tables.soft_methods.methods | [rt_3_svgf] | is not among rt_1_svgf, rt_2_svgf, rt_4_svgf
experiments.dragon.label | "{stepz}" | experiments.dragon.label: '{stepz}': braces must name a setting
claims.sampling.pairs | [[shadow_map_8, shadow_map_4]] | no experiment among them. Add one
claims.learning_rate.pairs | [[dragon, dragon]] | 'dragon' is compared with itself
claims.learning_rate.pairs | [[dragon, dragon_field]] | 'dragon_field' of encoding 'occupancy_field' has another loss
claims.learning_rate.pairs | [[dragon, dragn]] | learning_rate.pairs: 'dragn' (did you mean
claims.sampling.pairs | [[no_shadow_biased, dragon]] | has no depth bias. Write 'no_shadow'
claims.sampling.metrics | [lpips, lpips] | claims.sampling.metrics: 'lpips' is listed twice
claims.sampling.metrics | [lpips, loss] | claims.sampling.metrics: 'loss' is not among
claims.sampling.metrics | [mse_off_edges] | claims.sampling.metrics: 'mse_off_edges' is not among
claims.msm_leaks.metrics | [psnr] | claims.msm_leaks.metrics: 'psnr' is not among
claims.sampling.radii | [1] | claims.sampling.radii: it needs `table`. Name one
claims.rays_at_equal_time.radii | null | `rays_of_equal_time` needs radii. List some
claims.rays_at_equal_time.pairs | [[ffx_rays_of_equal_time, rays_of_equal_time]] | have no time to be equal to. Name a method as one of the two
claims.sampling.over | unseen | claims.sampling.over: it needs `table`. Name one
claims.rays_at_equal_time.table | kpnsm_table_1 | rays_at_equal_time.table: 'kpnsm_table_1' is not among
claims.sampling.needs | {seed: 3} | needs: unknown key: 'seed' (did you mean 'seeds'?) is not among
claims.printed_comparable_to_512.row | nothing | rows of table 4.5: 'nothing' is not among
claims.printed_comparable_to_512.equivalent_to | 64 | 'shadow_map_64' (did you mean
claims.printed_comparable_to_512.equivalent_to | null | needs `pairs`, or `row` and `equivalent
claims.printed_wider_is_worse_on_the_landscape.metrics | [psnr] | metrics of table 4.6: 'psnr' is
learning_curves | {c: {experiments: [dragon], steps: [500, 1000], seeds: 3}} | learning_curves.c: steps: [500, 1000] are fewer than 3 budgets
learning_curves | {c: {experiments: [dragon], steps: [1, 3, 2], seeds: 3}} | steps: [1, 3, 2]: must be ascending
learning_curves | {c: {experiments: [dragn], steps: [1, 2, 3], seeds: 3}} | experiments.0: 'dragn' (did you
learning_curves | {c: {experiments: [fence, fence], steps: [1, 2, 3], seeds: 3}} | 'fence' is listed twice
learning_curves | {c: {experiments: [kpnsm], frames: [16, 32], steps: [9], seeds: 3}} | c: frames: [16, 32] are fewer than 3 budgets
learning_curves | {c: {experiments: [kpnsm], frames: [16, 33, 64], steps: [9], seeds: 3}} | learning_curves.c.frames: 33: should be whole files of frame_sets.windows, 16 frames each
learning_curves | {c: {experiments: [kpnsm], frames: [16, 32, 80], steps: [9], seeds: 3}} | frames: 80: should be whole files of frame_sets.windows, 16 frames each, and no more than its train = 64
learning_curves | {c: {experiments: [dragon], frames: [16, 32, 64], steps: [9], seeds: 3}} | 'dragon' is not an experiment on frames (with `frame_set`)
tables.curves | {kind: learning_curves, title: x, rows: {dragon: [dragon]}} | tables.curves.kind: 'learning_curves' needs the section `learning_curves`
tables.table_4_3.rows.0 | {method: no_shadow, bias: held_out} | tables.table_4_3.rows: of dragon: 'no_shadow' is a null predictor and has no depth bias
tables.table_4_3.rows.0 | {method: ray_traced, bias: held_out} | 'ray_traced' is not among shadow_map_N
tables.table_4_3.rows.0 | shadow_map_512_biased | 'shadow_map_512_biased' (did you mean
tables.table_4_3.against | dragon_64 | table_4_3.against: 'dragon_64' (did you mean
tables.table_4_3.more_metrics | [lpip] | table_4_3.more_metrics.0: 'lpip' (did you mean 'lpips'?)
tables.beyond.against | {fence: dragon} | tables.beyond.against: 'dragon' is not among ray_traced
experiments.tiny | {scene: dragon, network: {encoding: mesh, triangles: 3}} | experiments.tiny.network.triangles = 3: Input should be greater than or equal to 4
experiments.tiny | {scene: dragon, network: {encoding: mesh, stored: coded, bits: 24}} | experiments.tiny.network: bits: 24: more than the 23 of a coded mesh
experiments.tiny | {scene: dragon, network: {encoding: mesh}, training: base} | experiments.tiny: a network of the kind 'mesh' has no training
experiments.dragon_field.training | muon | experiments.dragon_field.training: optimiser = 'muon': needs matrices between two hidden layers
tables.table_4_7.against | dragon | tables.table_4_7: unknown key: 'against' is not among
tables.table_4_6.against | {dragon: dragon} | tables.table_4_6: unknown key: 'against' is not among
experiments.landscape_heights.network.up | w | network.up = 'w': Input should be 'x', 'y' or 'z'
experiments.tiny | {scene: dragon, sampling: uniform, network: {encoding: ray_grid, hidden_layers: 1}, training: muon} | this network of the kind 'ray_grid' has none. Use adam
networks.sheet_256.start | distances | start: distances: surface: sheet has no inside
networks.sheet_256.start | fitted | start: fitted: surface: sheet has no inside
experiments.dragon_field.training | null | experiments.dragon_field.training: this key is missing
experiments.no_shadow | {like: dragon} | experiments.no_shadow: a method of tables has a name like
experiments.dragon.training | null | experiments.dragon.training: this key is missing. A trained network
experiments.dragon.sampling | null | experiments.dragon.sampling: this key is missing. A trained network
claims.slower_than_shadow_maps.pairs | [[dragon, shadow_map_8]] | 'shadow_map_8' (did you me
scenes.dragon.generate | room | needs either `mesh` (a mesh in its unit sphere) or `generate`
scenes.mine | {up: z} | needs either `mesh` (a mesh in its unit sphere) or `generate`
scenes.room.inserted | [hall] | inserted.0: 'hall' is not a mesh (an entry with `mesh`). Allowed: dragon, fence, landscape
experiments.dragon.scene | room | experiments.dragon.scene: 'room' is not a mesh (an entry with `mesh`). Allowed: dragon
experiments.dragon.network | nsm | experiments.dragon.network: 'nsm' is not a network on rays (by `encoding`). Allowed: thesis
experiments.nsm.network | thesis | experiments.nsm.network: 'thesis' is not a screen-space network (by `form`). Allowed: nsm
experiments.nsm.training | base | experiments.nsm.training: 'base' is not a training on frames (with `crops`). Allowed: nsm
experiments.nsm.frame_set | views | 'views' is not a set of frames under an area light. Allowed: frames
tables.nsm_unseen.networks | [dragon] | networks.0: 'dragon' is not an experiment on frames (with `frame_set`). Allowed: nsm
tables.table_4_3.rows.0 | nsm | rows: of dragon: 'nsm' is not an experiment on rays (with `scene`). Allowed: dragon
tables.soft_methods.methods | [dragon] | methods: 'dragon' is not an experiment on frames (with `frame_set`). Allowed: nsm
learning_curves | {c: {experiments: [nsm], steps: [1, 2, 3], seeds: 3}} | 'nsm' is not an experiment on rays (with `scene`). Allowed: dragon
frame_sets.views | null | frame_sets.views: this key is missing
frame_sets.views | {path: mine} | frame_sets.views: only `views` holds views of meshes
frame_sets.mine | {width: 600, height: 400, views_per_set: 24, batch: 12} | frame_sets.mine: only `views` holds
frame_sets.frames.scenes | [rom] | frame_sets.frames.scenes.0: 'rom' (did you mean 'room'?) is not among
frame_sets.frames.unseen | [hall] | frame_sets.frames: unseen: hall is also in `scenes`
frame_sets.frames.tuned_also_on | layouts | frame_sets.frames.tuned_also_on: 'layouts' has another `radii`
frame_sets.frames.tuned_also_on | frames | frame_sets.frames.tuned_also_on: 'frames' is not among
frame_sets.windows.unseen | [groves, garden, workshop, stairs, blinds, tree] | frame_sets.windows.tuned_also_on: 'layouts' shows groves, in `unseen` here
experiments.nsm_plain | {network: nsm, training: nsm_plain, frame_set: frames, scenes: [room_dragon], label: Other} | 'nsm_plain' is trained on room_dragon, in `unseen` of frame_sets.nsm
tables.soft_sun.methods | [pcss, nsm] | 'nsm' is trained on lights with radii in metres, and frame_sets.sun has them in degrees
frame_sets.frames.unseen | [room] | frame_sets.frames.unseen: 'room' has the generator 'room' and no object beyond
frame_sets.nsm.twins | {count: 3, light_texels: 1, light: 0.01} | frame_sets.nsm.twins: unknown key: 'light' (did you mean
frame_sets.nsm.twins | {count: 3, eye_pixels: 1} | frame_sets.nsm.twins: unknown key: 'eye_pixels'
scenes.room.penumbra | 90 | scenes.room.penumbra: needs `generate: plate` and one object
frame_sets.frames.radii | [-0.1, 0.2] | frame_sets.frames.radii.0 = -0.1: Input should be greater than
frame_sets.frames.radii | [0.2, 0.1] | frame_sets.frames: radii = [0.2, 0.1]: must be ascending
frame_sets.sun.radius_unit | metres | frame_sets.sun: radius_unit: 'metres' does not suit a light of the shape sun. Use degrees
frame_sets.sun.light_map | {kind: cube, resolution: 64} | light_map.kind: 'cube' does not suit a light of the shape sun
frame_sets.panels.radius_unit | degrees | does not suit a light of the shape rectangle. Use metres or scene_sizes
frame_sets.panels.light | {shape: rectangle, facing: [0, 0, 0]} | facing: [0, 0, 0] is no direction
frame_sets.panels.light | {shape: rectangl} | frame_sets.panels.light
frame_sets.frames.sequence | 1 | frame_sets.frames: sequence = 1: a sequence needs at least two frames
frame_sets.windows.of | {width: 64, height: 64} | frame_sets.windows: of = 64 × 64: must be at least the window
frame_sets.frames.light_map.resolution | 100 | light_map.resolution: 100 is not a power of two
scenes.room.seed | -1 | scenes.room.seed = -1: Input should be greater than or equal to 0
scenes.court_3.seed | 1 | frame_sets.frames: 'court_1' and 'court_3' are the same scene
scenes.room.inserted | [dragon, dragon] | inserted = ['dragon', 'dragon']: must name each object once
tables.soft_methods.methods | [pcs] | tables.soft_methods.methods: 'pcs' (did you mean 'pcss'?)
claims.pcss_better_than_msm.radii | [9] | radii: 9 is not below 6, the number of radii of 'windows'
claims.pcss_better_than_msm.radii | [-1] | radii.0 = -1: Input should be greater than or equal to 0
claims.nsm_first_level.ratios.0.per | compute | a ratio to the sum of all others has no `per`
networks.nsm.form | whole | networks.nsm.form = 'whole': should be one of 'direct', 'full', 'half', 'kernels', 'original', 'shuffle'
networks.nsm.widths | [32] | networks.nsm.widths = [32]: List should have at least 2 items
networks.layers_7.widths | [16, [32], 64] | widths.1 = [32]: List should have at least 2 items
networks.layers_7.widths | [16, 0] | widths.1 = 0: Input should be greater than or equal to 1
networks.original.widths | [32, [64, 32]] | networks.original.widths.1 = [64, 32]: Input should be a valid integer
networks.nsm.pool | max | networks.nsm: unknown key: 'pool' is not among
networks.nsm.features | [ratoi] | networks.nsm.features: 'ratoi' (did you mean 'ratio'?) is not among c_e, view
networks.nsm.features | [z, z] | networks.nsm.features: 'z' is listed twice
experiments.pcss | {network: nsm, training: nsm, frame_set: nsm, scenes: [room], seed: 7} | experiments.pcss: a method of tables has a name like this
experiments.mine_bfloat16 | {network: nsm, training: nsm, frame_set: nsm, scenes: [room], seed: 7} | experiments.mine_bfloat16: '_bfloat16' is the ending of networks in that number
networks_by_scene.rt_4 | {label: x, experiments: [nsm, kpnsm]} | networks_by_scene.rt_4: a method of tables has a name like this
tables.nsm_temporal.frame_set | nsm_between | tables.nsm_temporal.frame_set: frame_sets.nsm_between has sequence = 0
tables.nsm_temporal.methods | [pcs] | tables.nsm_temporal.methods: 'pcs' (did you mean 'pcss'?)
tables.nsm_table_s2.network | nms | tables.nsm_table_s2.network: 'nms' (did you mean 'nsm'?) is not among
figures.figure_nsm_level_time.table | memory | 'memory' is not among nsm_table_s3
figures.figure_soft_equal_time.radii | [9] | radii: 9 is not among 0 to 4, the radii of 'frames'
figures.figure_soft_pictures.radii | [-1] | radii: -1 is not among 0 to 4, the radii of 'frames'
experiments.nsm.scenes | [room_dragon] | experiments.nsm.scenes: 'room_dragon' is in `unseen` of frame_sets.nsm
experiments.nsm.scenes | [rom] | experiments.nsm.scenes: 'rom' (did you mean 'room'?)
experiments.nsm.lights | [1, 5] | experiments.nsm.lights = [1, 5]: frame_sets.nsm has 5 radii, counted from 0
experiments.nsm.frame_set | nsm_between | experiments.nsm.frame_set: frame_sets.nsm_between has train = 0
frame_sets.nsm.twins | {count: 0} | experiments.nsm.training: perturbation = 3 needs perturbed frames
experiments.kernels_rays | {network: kernels_rays, training: kpnsm, frame_set: windows, scenes: [atrium]} | filters rays, and frame_sets.windows has rays = 0
experiments.kernels_rays.training | nsm | perturbation = 3: perturbed frames have no rays, which the network filters. Set perturbation: 0
networks.kpnsm.edge | 1 | networks.kpnsm: edge: needs the feature 'log_d'
networks.kpnsm.features | [cosine, z_b] | networks.kpnsm.features: kernels filter one of the features base_hard
experiments.nsm.network | original_5 | experiments.nsm.network: 'original_5' (did you mean 'original'?) is not among original, nsm
experiments.nsm.training | {steps: 1, crops: 1, crop: 15, learning_rate: 1.0} | experiments.nsm.training: crop = 15: the network's deepest level is 1/16 of a frame. Set 16 or more
experiments.mine | {network: {form: direct, widths: [4, 8, 8, 8], features: [c_e]}, training: {steps: 1, crops: 1, crop: 15, learning_rate: 1.0}, frame_set: nsm, scenes: [room]} | 1/16 of a frame
experiments.mine | {network: {form: direct, widths: [4, 8], features: [c_e]}, training: {steps: 1, crops: 3, crop: 64, learning_rate: 1.0}, frame_set: nsm, scenes: [room]} | crops = 3: the network's batch norms take two crops at a time. Set an even number
experiments.nsm.training | {steps: 10, crops: 2, crop: 32, learning_rate: 0.1, schedule: steps} | tenth_from = []: needs one step or more with `schedule: st
experiments.nsm.training | {steps: 10, crops: 2, crop: 32, learning_rate: 0.1, tenth_from: [2]} | = [2]: needs one step or more with `schedule: steps`, and none with another; the schedule is 'cosine'
experiments.nsm.training | {steps: 10, crops: 2, crop: 32, learning_rate: 0.1, schedule: steps, tenth_from: [4, 10]} | = [4, 10]: must be ascending, without repetition, and end below steps = 10
networks_by_scene.mine | {experiments: [nsm, nsm_plain], label: Mine} | networks_by_scene.mine.experiments: 'room' has two networks
networks_by_scene.nsm | {experiments: [nsm], label: Mine} | networks_by_scene.nsm: an entry of `experiments` has this name
frame_sets.windows.unseen | [] | frame_sets.windows: moving: blinds, garden, stairs, tree, workshop: neither in `scenes` nor in `unseen`
tables.mine | {kind: soft_summary, title: Mine, frame_set: sun, over: unseen, methods: [hard]} | tables.mine.over: frame_sets.sun has no `unseen`
tables.kpnsm_radii.lights | [0, 9] | tables.kpnsm_radii.lights: 9 is not below 6, the number of radii of 'windows'
tables.mine | {kind: centre_errors, title: Mine, frame_set: frames, methods: [pcss, hard]} | tables.mine.methods: lacks exact_centre
frame_sets.nsm.sequence | 0 | tables.nsm_temporal.frame_set: frame_sets.nsm has sequence = 0
frame_sets.windows.sequence | 0 | frame_sets.windows: moving: needs a `sequence`
frame_sets.windows.moving | [tree, tree] | frame_sets.windows: moving: tree, tree: a scene is listed twice
claims.shipped_rays_better_behind_taa.radii | [2] | mse_sequence_off_edges_recursive is measured in sequences, by the middle light. Write `radii: [3]`
tables.kpnsm_unseen.metrics | [time] | tables.kpnsm_unseen: metrics: time is not available with `by: scene`
tables.kpnsm_unseen.methods | [kpnsm, {method: kpnsm, label: K}] | tables.kpnsm_unseen.methods: 'kpnsm' is listed twice
tables.soft_methods.methods | [pcss, pcss] | tables.soft_methods.methods: 'pcss' is listed twice
claims.kpnsm_leaks_less.again | {pcss_post: [kpnsm]} | claims.kpnsm_leaks_less.again: 'pcss_post' is not among kpnsm
claims.kpnsm_leaks_less.again | {msm_15: [kpnsm_basic]} | claims.kpnsm_leaks_less.again: 'msm_15' is not among kpnsm
claims.kpnsm_leaks_less.again | {kpnsm: [kpnsm_basic]} | again.kpnsm: 'kpnsm_basic' has another network than 'kpnsm'. Let it differ in `seed`
claims.kpnsm_joint_training_costs_nsm.again | {kpnsm_nsm_single: [kpnsm]} | 'kpnsm' has 1 networks, not 5. List one for each
claims.kpnsm_leaks_less.again | {kpnsm: [kpnsm_s]} | again.kpnsm: 'kpnsm_s' (did you mean
claims.kpnsm_leaks_less.again | {kpnsm: [kpnsm]} | claims.kpnsm_leaks_less.again: 'kpnsm' is listed twice
claims.nsm_wider_with_the_light.again | {nsm_between: [nsm_between]} | claims.nsm_wider_with_the_light.again: 'nsm_between' is listed twice
"""


@pytest.mark.parametrize("mistake", MISTAKES.strip().splitlines())
def test_mistakes(message, values, mistake):
    key, value, words = mistake.split(" | ")
    value = yaml.safe_load(value)
    if value == {"like": "dragon"}:
        value = values["experiments"]["dragon"] | {"label": "Twin"}
    assert words in message(key, value)


def test_maps_need_a_scene(message, values):
    values["frame_sets"]["mine"] = {"path": "mine"}
    values["tables"]["soft_windows"]["frame_set"] = "mine"
    words = "soft_windows.methods: 'exact_centre' needs the scene's geometry, and a user's own"
    assert words in message(values)


def test_networks_need_none(values):
    table = {"kind": "soft_methods", "title": "Mine", "frame_set": "mine"}
    values["frame_sets"]["mine"] = {"path": "mine"}
    values["tables"]["mine"] = table | {"methods": ["base_msm", "kpnsm", "kpnsm_nsm_single"]}
    assert read_config(values).tables["mine"].methods_shown() == values["tables"]["mine"]["methods"]
