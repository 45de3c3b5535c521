"""The kinds of figures, a file each.

A kind's module has

- `Settings`, the model of its section, an `AnyFigure` of `sections.any_report` with its own fields;
  `check` against other sections, `resolved` for names, `chapter` of the page where they apply.
- `files(layout, figure)`: input files by argument of `draw`.
- `params(layout, figure)`: the other arguments of `draw`, beside `title`.
- `draw`: writes `png` and `svg`.
- optional: `encodings(layout, figure)`, the kinds of networks whose weights it reads;
  `generators(layout, figure)`, the kinds of scenes that it reads; `USES_GPU`.

The graph imports all kinds at each start: matplotlib, trimesh, torch, numba and scipy.stats are
imported inside functions.
"""
