"""Memory check before a field's layout."""

from neural_shadows.errors import InputError
from neural_shadows.representations.distance_bricks.field_marching import BRICK
from neural_shadows.running.process_memory import available_bytes

# During layout: 8,834 for the Stanford dragon at 512³ with 38,444 bricks, 8,988 with its distances
# computed and fitted.
BYTES_PER_BRICK = 9000
_GIB = 2**30


def check_memory(resolution: int, bricks: int) -> None:
    """Refuse a field of more bricks than fit into memory.

    Raises:
        InputError: too many.
    """
    needed, available = bricks * BYTES_PER_BRICK, available_bytes()
    if needed > available:
        # The number of touched bricks grows with the square of the resolution.
        maximum = int(resolution * (available / needed) ** 0.5) // BRICK * BRICK
        raise InputError(
            f"resolution: {resolution}: makes {bricks:,} bricks, which need "
            f"{needed / _GIB:,.1f} GiB of memory; {available / _GIB:,.1f} GiB are free. Set a "
            f"resolution of at most {maximum}."
        )
