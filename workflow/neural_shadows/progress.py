"""Progress bars with a rate and the time left."""

from tqdm import tqdm


def progress_bar(total: int, unit: str, title: str, initial: int = 0) -> tqdm:
    """A bar on stderr that counts to `total` units (samples, viewpoints), SI-scaled."""
    return tqdm(
        total=total,
        initial=initial,
        unit=f" {unit}",
        unit_scale=True,
        desc=title,
        mininterval=2,
        dynamic_ncols=True,
    )
