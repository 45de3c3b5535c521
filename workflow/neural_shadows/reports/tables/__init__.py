"""Tables, a module for each `kind` in the configuration.

The `write` of a kind writes a table as CSV (all digits) and as Markdown (for reading). Of these it
is given what it needs:

- `metrics`: per view, of all methods of the rows, in folders of scenes.
- `times`, `meshes`: what `measure_frame_times` and `prepare_mesh` wrote, a file for each scene.
- `weights`, `trainings`: of the networks among the rows, each once.
- `depth_biases`: those that were found, a file for each method in the folder of its scene.
- `lpips_json`: what `find_lpips` wrote; `published_csv`: the thesis's printed numbers.
- `published`: the thesis's number of the table, "4.3"; None for one that is not in it.
- `rows`: as `config.rows` gives them, `no_shadow` of each scene among them.
- `against`: the method that the others' paired differences are to.
- `run`: `scale`, `seed` (of the bootstrap), `width`, `height` (pixels), `reference`.
- `scenes`: `procedural` and `seed` (of the viewpoints) of the rows' scenes.

It raises InputError where a file is missing or damaged, or a method lacks a value.
"""
