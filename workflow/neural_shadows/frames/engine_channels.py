"""Channels and image files of engine frames, after Hu et al. 2025.

Images are named `FILE:CHANNEL`, see `files.frame_images`. Those of the paper's authors are in world
units and half floats; z is 0 where there is no surface.

- `z`, `d`: distances to the point from the light and from the eye; `z_b`: from the light to its
  map's surface in the point's direction, at most z in theirs;
- `c_e`, `c_v`: cosines of the normal with the directions to light and eye;
- `hard`, `pcf`, `msm`: base shadows, 1 is lit;
- `n_x`, `n_y`, `n_z`: the normal in world axes, on the eye's side, as those of the cosines;
- `agreement`, `e_x`, `e_y`, `e_z`: of the map's normal, which theirs lacks.
"""

CHANNEL_IMAGES: dict[str, str | None] = {
    "z": "MyGBuffer.distE.15:R",
    "z_b": "MyShadowMap.color.15:B",
    "d": "MyGBuffer.distV.15:R",
    "c_e": "MyGBuffer.ce.15:R",
    "c_v": "MyGBuffer.cv.15:R",
    "hard": "MyShadowMap.color.15:G",
    "pcf": "MyGBuffer.visibility.70:R",
    "msm": "MyShadowMap.msm.15:G",
    "n_x": "MyGBuffer.normW.15:R",
    "n_y": "MyGBuffer.normW.15:G",
    "n_z": "MyGBuffer.normW.15:B",
    **dict.fromkeys(("agreement", "e_x", "e_y", "e_z")),
}
# Of lights of six radii, in shares of the scene's size.
RADII = [0.00125 * step for step in range(6)]
TARGET_IMAGES = [f"AccumulatePass{k}.output.90:{channel}" for k in (1, 2) for channel in "RGB"]
