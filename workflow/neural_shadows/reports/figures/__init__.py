"""Figures, a module for each `kind` in the configuration, called as the kind.

A kind's module has

- `Settings`, the model of its section: `sections.any_report.AnyFigure` and what is its own; `check` if
  something must fit other sections, `resolved` if it follows names; `chapter`, the page's.
- `files(layout, figure)`: the files that it is made of, by argument of `draw`.
- `params(layout, figure)`: what `draw` takes beside these and its `title`.
- `draw`, which writes `png` and `svg`.
- where they apply: `encodings(layout, figure)`, the kinds of the networks whose weights it reads;
  `generators(layout, figure)`, those of the scenes that it looks into; `USES_GPU`.

The graph imports all kinds at each start: what computes or draws (matplotlib, trimesh, torch, numba,
scipy.stats) is imported inside functions.
"""
