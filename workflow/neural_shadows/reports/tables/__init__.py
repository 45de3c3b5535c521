"""Tables, a module for each `kind` in the configuration.

A kind's module has

- `Settings`, the model of its section: `sections.any_report.AnyTable`, or one of `sections.rows` or
  `sections.frame_tables`, with its own fields; `check` and `resolved` to resolve names.
- `table`, which returns a `reports.data.table.Table`. Its arguments name files and settings of
  `layout.report_inputs`, keys of the entry, or what the kind's own functions return:
  `files(layout, table)` and `params(layout, table)`. A dataclass stands for its fields. `InputError`: a
  file is missing or not whole.

The graph imports all kinds at each start: import heavy modules (trimesh, torch, numba,
scipy.stats) inside functions.
"""
