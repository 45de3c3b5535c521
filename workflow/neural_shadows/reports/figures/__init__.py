"""The kinds of figures, a file each.

A kind's module has

- `Settings`, the model of its section, an `AnyFigure` of `sections.any_report` with its own fields;
  `check` against other sections, `resolved` for names, `own_chapter` of the page where they apply.
- `draw`, which returns a figure. Its arguments name files and settings as those of `tables` do, with
  `heading`, the title with the scale. `InputError`: a file is missing or not whole, or there is no
  OpenGL for a picture in 3D.
- optional: `files`, `params` and `USES_GPU`.

The graph imports all kinds at each start: matplotlib, trimesh, torch, numba and scipy.stats are
imported inside functions.
"""
