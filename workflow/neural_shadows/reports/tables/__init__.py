"""Tables, a module for each `kind` in the configuration.

A kind's module has

- `Settings`, the model of its section: `sections.any_report.AnyTable`, or one of `sections.rows` or
  `sections.frame_tables`, with its own fields; `check` and `resolved` to resolve names.
- `files(layout, table)`: its input files, by argument of `table`.
- `params(layout, table)`: the other arguments of `table` but its `title`.
- `table`, which returns a `reports.data.table.Table`; the rule's job writes it.
- where they apply: `encodings(layout, table)`, the kinds of the networks whose weights it reads;
  `generators(layout, table)`, those of the scenes whose meshes it reads.

The graph imports all kinds at each start: import heavy modules (trimesh, torch, numba,
scipy.stats) inside functions.
"""
