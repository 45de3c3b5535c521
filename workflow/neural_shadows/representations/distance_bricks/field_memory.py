"""The memory that a field's bricks need, before any is made."""

from neural_shadows.errors import InputError
from neural_shadows.representations.distance_bricks.field_marching import BRICK
from neural_shadows.running.process_memory import available_bytes

# While a field is laid out: of the Stanford dragon at 512³, of 38,444 bricks, 8,834, and where its
# distances are found and fitted too 8,988.
BYTES_PER_BRICK = 9000
_GIB = 2**30


def check_memory(resolution: int, bricks: int) -> None:
    """Refuse a field of so many bricks if laying it out takes more memory than there is.

    Raises:
        InputError: it does.
    """
    needed, there = bricks * BYTES_PER_BRICK, available_bytes()
    if needed > there:
        # A surface touches as many bricks as it has square cells.
        most = int(resolution * (there / needed) ** 0.5) // BRICK * BRICK
        raise InputError(
            f"network: resolution: {resolution} makes {bricks:,} bricks, which need "
            f"{needed / _GIB:,.1f} GiB of memory; {there / _GIB:,.1f} GiB are free: set a resolution "
            f"of at most {most}"
        )
