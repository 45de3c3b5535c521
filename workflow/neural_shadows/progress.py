"""Progress bars with a rate and the time left."""

from tqdm import tqdm

from neural_shadows.rates import RATES, Rate


class _Bar(tqdm):
    def close(self) -> None:
        if not self.disable:  # as it is once it has been closed
            seconds = self.format_dict["elapsed"]
            RATES.append(Rate(self.desc, self.unit.strip(), self.n - self.initial, seconds))
        super().close()


def progress_bar(total: int, unit: str, title: str, initial: int = 0) -> tqdm:
    """A bar on stderr that counts to `total` units (samples, viewpoints), SI-scaled.

    Closed, it leaves its rate in `rates.RATES`.
    """
    return _Bar(
        total=total,
        initial=initial,
        unit=f" {unit}",
        unit_scale=True,
        desc=title,
        mininterval=2,
        dynamic_ncols=True,
    )
