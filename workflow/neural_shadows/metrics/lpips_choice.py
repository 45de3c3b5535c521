"""Which LPIPS a run uses, as `find_lpips` wrote it."""

from pathlib import Path
from typing import Any

from typing_extensions import TypedDict

from neural_shadows.files.records import _read


class _Lpips(TypedDict):
    net: str
    trunk: str | None
    available: bool
    reason: str | None


def read_lpips_choice(path: str | Path) -> dict[str, Any]:
    """What `find_lpips` wrote."""
    return _read(path, _Lpips, "file on LPIPS")
