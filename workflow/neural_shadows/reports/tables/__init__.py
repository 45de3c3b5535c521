"""Tables, a module for each `kind` in the configuration, called as the kind.

A kind's module has

- `Settings`, the model of its section: `sections.any_report.AnyTable`, or one of `sections.rows` or
  `sections.frame_tables`, and what is its own; `check` and `resolved` where it follows names.
- `files(layout, table)`: the files that it is made of, by argument of `table`.
- `params(layout, table)`: what `table` takes beside these and its `title`.
- `table`, which returns a `reports.data.table.Table`; the rule's job writes it.
- where they apply: `encodings(layout, table)`, the kinds of the networks whose weights it reads;
  `generators(layout, table)`, those of the scenes that it looks into.

The graph imports all kinds at each start: what computes (trimesh, torch, numba, scipy.stats) is imported
inside functions.
"""
