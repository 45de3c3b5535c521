"""The field of a mesh: who fits it asks which points see a light.

Modules that compute are imported where they are needed: to import this one takes no time.
"""

from dataclasses import dataclass, fields
from functools import cached_property
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from neural_shadows.errors import InputError

if TYPE_CHECKING:
    from neural_shadows.representations.distance_bricks.field_bricks import FieldBricks
    from neural_shadows.representations.distance_bricks.field_cones import ConeField

BRICK = 4  # cells along a brick, as in `field_marching`
RESOLUTIONS = 8, 1024
CORNER_BITS = 8
WALKS = 8  # cones of a partly covered disc
# Cells, see `dim_by_field`. Squared errors of suns of 0.27° to 5° on ground and creature at 256³: least
# with 0 to 0.3 on the ground, with 0.15 on the creature itself, where 0.6 and 0 have up to 2.4 and 1.3
# times as much.
PUSH = 0.15
SHEET_RAYS = 32  # of a disc past a sheet, whose far side no cone can measure
# Tables of a light and their rays take as long as so many times fewer rays one by one as a slice has
# cells: 2.7 ms or 9,400 rays at 512³; measured 20 to 42, at 128³ to 768³.
FEW = 28
MOST_ANGLE = 45.0  # degrees of a light's radius
# Below, it is a point: over the sphere's diameter its penumbra is 0.002 cells at most, and a cone's
# steps are lost in rounding.
SHARP = 1e-4
_FAR = 1e9  # radii, beyond everything


@dataclass(frozen=True, eq=False)
class ShadowField:
    """Signed distances in sparse bricks around a mesh's surface.

    All lengths and places are the mesh's own. Points on the surface should be lifted off it
    along their normals, by a sixth to a half of a `cell`: a field's surface is not quite there.
    """

    centre: np.ndarray  # (3,) float64
    radius: float  # of the sphere that the grid's cube is around
    grid: np.ndarray  # (B, B, B) int32, see `BrickLayout`
    bricks: np.ndarray  # (n, 125) int8, see `fitted_bricks`
    cells: np.ndarray  # (n,) uint64 of a sheet, else empty; see `first_crossings`

    @classmethod
    def fit(cls, mesh: Any, resolution: int = 256) -> "ShadowField":
        """Fit a field to a mesh; nothing is trained.

        An open mesh without an inside becomes a sheet. A closed one, or a scan with holes, is solid.

        Args:
            mesh: a path (.ply, .obj, .stl, .glb), a trimesh.Trimesh, or (vertices, faces).
            resolution: cells along the diameter of the mesh's bounding sphere, a multiple of 4.

        Raises:
            InputError: no usable mesh, another resolution, or too little memory.
        """
        from neural_shadows.meshes.normalised import normalised
        from neural_shadows.meshes.prepared_mesh import with_normals
        from neural_shadows.representations.shadow_field.fitted_bricks import fitted_bricks
        from neural_shadows.representations.shadow_field.given_mesh import triangles_of

        least, most = RESOLUTIONS
        if resolution not in range(least, most + 1, BRICK):
            raise InputError(
                f"resolution: {resolution!r}: not a multiple of {BRICK} from {least} to {most}. "
                "Give 256, or more for finer detail."
            )
        whole = normalised(*triangles_of(mesh))
        unit = with_normals(whole.vertices, whole.faces)
        return cls(whole.centre, whole.radius, *fitted_bricks(unit, resolution, whole.sheet))

    def save(self, path: str | Path) -> None:
        """Write one safetensors file, whole or not at all; see `field_file`."""
        from neural_shadows.representations.shadow_field.field_file import write_field

        write_field(path, {field.name: getattr(self, field.name) for field in fields(self)})

    @classmethod
    def load(cls, path: str | Path) -> "ShadowField":
        """Read a file of `save`.

        Raises:
            InputError: no such file, or it is damaged, foreign, or of another version.
        """
        from neural_shadows.representations.shadow_field.field_file import read_field

        return cls(**read_field(path))

    @property
    def resolution(self) -> int:
        """Cells along an axis."""
        return len(self.grid) * BRICK

    @property
    def cell(self) -> float:
        """Width of a cell."""
        return 2 * self.radius / self.resolution

    @property
    def sheet(self) -> bool:
        """An open surface without an inside."""
        return len(self.cells) > 0

    @property
    def bytes(self) -> int:
        """Size in memory."""
        return self.grid.nbytes + self.bricks.nbytes + self.cells.nbytes

    def occluded(self, points: Any, direction: Any) -> np.ndarray:
        """Occlusion of points from a distant light, such as the sun, (n,) bool.

        Args:
            points: (n, 3). direction: (3,) to the light, of any length.

        Raises:
            InputError: another shape, or a number that is not finite.
        """
        from neural_shadows.representations.shadow_field.given_rays import direction_of

        return self._occluded(
            self._in_radii(points, "points"), direction_of(direction, "direction")
        )

    def occluded_from(self, points: Any, position: Any) -> np.ndarray:
        """Occlusion of points from a light at a position (3,), (n,) bool.

        Raises:
            InputError: as `occluded`.
        """
        from neural_shadows.representations.distance_bricks.field_occlusion import occluded_from
        from neural_shadows.representations.shadow_field.given_rays import vector_of

        points = self._in_radii(points, "points")
        light = (vector_of(position, "position") - self.centre) / self.radius
        return occluded_from(points, light, self._field_bricks)

    def soft(self, points: Any, direction: Any, angular_radius: float) -> np.ndarray:
        """Visible share of a round distant light, (n,) float32 in [0, 1].

        By cones past a solid, by 32 rays past a sheet.

        Args:
            points, direction: see `occluded`.
            angular_radius: of the light in degrees, less than 45; the sun has 0.27.

        Raises:
            InputError: as `occluded`, or an angle out of range.
        """
        from neural_shadows.representations.shadow_field.given_rays import direction_of
        from neural_shadows.representations.shadow_field.round_light import past_sheet, past_solid

        if not 0 <= angular_radius < MOST_ANGLE:
            raise InputError(
                f"angular_radius: {angular_radius!r}: not in [0, {MOST_ANGLE:g}). Give degrees."
            )
        points, direction = self._in_radii(points, "points"), direction_of(direction, "direction")
        if angular_radius < SHARP:
            return (~self._occluded(points, direction)).astype(np.float32)
        slope = np.tan(np.radians(angular_radius))
        if self.sheet:
            return past_sheet(self._occluded, points, direction, slope, SHEET_RAYS)
        return past_solid(self.cone_field, points, direction, slope, WALKS, PUSH)

    def intersects_any(self, ray_origins: Any, ray_directions: Any) -> np.ndarray:
        """Occlusion of each ray, (n,) bool; as trimesh's `RayMeshIntersector`.

        Args:
            ray_origins, ray_directions: (n, 3).

        Raises:
            InputError: as `occluded`, or origins and directions of different numbers.
        """
        from neural_shadows.representations.shadow_field.given_rays import (
            all_alike,
            direction_of,
            rows_of,
            units_of,
        )

        origins = self._in_radii(ray_origins, "ray_origins")
        directions = rows_of(ray_directions, "ray_directions")
        if len(directions) != len(origins):
            raise InputError(
                f"ray_directions: {len(directions)} rows for {len(origins)} origins. Give one each."
            )
        if all_alike(directions):
            return self._occluded(origins, direction_of(directions[0], "ray_directions"))
        units, _ = units_of(directions, "ray_directions")
        return self._blocked(origins, np.float32(_FAR) * units)

    def test_occlusions(self, rays: Any, tnear: float = 0.0, tfar: float = np.inf) -> np.ndarray:
        """Occlusion between two distances on each ray; as Open3D's `RaycastingScene`.

        Args:
            rays: (…, 6), origins and directions. tnear, tfar: in lengths of the directions.

        Returns:
            (…) bool.

        Raises:
            InputError: as `occluded`.
        """
        from neural_shadows.representations.shadow_field.given_rays import rows_of, units_of

        shape = np.shape(rays)
        rows = rows_of(np.reshape(rays, (-1, shape[-1] if shape else 1)), "rays", 6)
        if tnear == 0 and tfar == np.inf:
            return self.intersects_any(rows[:, :3], rows[:, 3:]).reshape(shape[:-1])
        units, lengths = units_of(rows[:, 3:], "rays")
        origins = self._in_radii(rows[:, :3] + tnear * rows[:, 3:], "rays")
        radii = np.clip(tfar - tnear, 0, _FAR * self.radius / lengths) * lengths / self.radius
        to_end = np.float32(radii)[:, None] * units
        return self._blocked(origins, to_end).reshape(shape[:-1])

    def block(self, points: np.ndarray, to_target: np.ndarray, blocked: np.ndarray) -> None:
        """Mark blocked segments in `blocked` (n,) bool, without those marked already.

        Args:
            points, to_target: (n, 3); `to_target` from each point to the end of its segment.
        """
        segments = (to_target / np.float32(self.radius)).astype(np.float32)
        self._block(self._in_radii(points, "points"), segments, blocked)

    @cached_property
    def cone_field(self) -> "ConeField":
        """Values of a solid, and distances beyond them, for cones."""
        from neural_shadows.representations.distance_bricks.brick_distances import REACH
        from neural_shadows.representations.distance_bricks.distances_around import distances_around
        from neural_shadows.representations.distance_bricks.field_cones import ConeField
        from neural_shadows.representations.shadow_field.fitted_bricks import LEVELS

        unit = np.float32(REACH / LEVELS * 2 / self.resolution)
        around = distances_around(self.grid, self.bricks).ravel()
        return ConeField(self.grid, self.bricks, unit, around)

    def _in_radii(self, points: Any, name: str) -> np.ndarray:
        from neural_shadows.representations.shadow_field.given_rays import in_radii, rows_of

        return in_radii(rows_of(points, name), name, self.centre, self.radius)

    @cached_property
    def _field_bricks(self) -> "FieldBricks":
        from neural_shadows.representations.distance_bricks.field_bricks import field_bricks

        return field_bricks(self.grid, self.bricks, 0.0, CORNER_BITS, self.cells)

    def _occluded(self, points: np.ndarray, direction: np.ndarray) -> np.ndarray:
        """See `occluded`; points in radii, of a unit direction."""
        if len(points) * FEW < self.resolution**2:
            return self._blocked(points, np.tile(np.float32(_FAR * direction), (len(points), 1)))
        from neural_shadows.representations.distance_bricks.field_occlusion import occluded

        return occluded(points, direction, self._field_bricks)

    def _blocked(self, points: np.ndarray, to_target: np.ndarray) -> np.ndarray:
        blocked = np.zeros(len(points), bool)
        self._block(points, to_target, blocked)
        return blocked

    def _block(self, points: np.ndarray, to_target: np.ndarray, blocked: np.ndarray) -> None:
        from neural_shadows.representations.distance_bricks.field_marching import mark_blocked

        field = self.grid, self.bricks, self._steps, self.cells, np.float32(0)
        mark_blocked(points, to_target, *field, blocked)

    @property
    def _steps(self) -> int:
        from neural_shadows.representations.distance_bricks.field_marching import SAMPLES_PER_CELL

        return SAMPLES_PER_CELL * self.resolution
