"""Tables of times from `profile_screen_network`."""

from functools import partial

import pandas as pd

from neural_shadows.reports.data.digits import short
from neural_shadows.reports.data.phrases import TEXTS
from neural_shadows.reports.data.published import printed_size
from neural_shadows.reports.data.table import Column, numbers
from neural_shadows.settings.records import Profile, ProfileRun


def run_key(run: ProfileRun) -> str:
    """A column's name for a run: `bfloat16_2`, of two threads, or `bfloat16_gpu`."""
    processor = "gpu" if run["device"] == "cuda" else run["threads"]
    return f"{run['precision']}_{processor}"


def run_name(run: ProfileRun) -> str:
    """A run's label."""
    threads = f"{run['threads']} thread{'s' * (run['threads'] > 1)}"
    return f"{run['precision']}, {'GPU' if run['device'] == 'cuda' else threads}"


def compared(profile: Profile) -> ProfileRun:
    """The run beside printed times: all threads or the GPU, 16 bits if possible."""
    return profile["runs"][-1]


def part_times(profile: Profile) -> pd.DataFrame:
    """A row for each level and part in the order of levels, and a column of ms for each run."""
    times = {
        run_key(run): pd.DataFrame(run["parts"]).set_index(["level", "part"])["ms"]
        for run in profile["runs"]
    }
    return pd.DataFrame(times).sort_index(level="level", sort_remaining=False, kind="stable")


def of_printed_size(profile: Profile, published: pd.Series) -> bool:
    """Check for frames of the size of Datta et al. 2022."""
    return (profile["width"], profile["height"]) == printed_size(published)


def run_columns(profile: Profile, table: pd.DataFrame) -> dict[str, Column]:
    """Columns of each run's milliseconds, of `ms_RUN`."""
    return {
        f"ms, {run_name(run)}": numbers(table[f"ms_{run_key(run)}"], partial(short, digits=4))
        for run in profile["runs"]
    }


def product_share(profile: Profile, run: ProfileRun) -> float:
    """The whole network's multiply-adds a second, as a share of a matrix product's."""
    pixels = profile["width"] * profile["height"]
    macs = pixels * sum(level["macs"] for level in profile["levels"])
    return macs / (run["whole_ms"] / 1000) / run["product_macs"]


def not_timed(profile: Profile) -> str:
    """Describe formats without times, after a space; empty without such formats."""
    devices = dict.fromkeys(run["device"] for run in profile["runs"])
    timed = {(run["device"], run["precision"]) for run in profile["runs"]}
    lacking = [
        f"{precision} on the {'GPU' if device == 'cuda' else 'CPU'}"
        for device in devices
        for precision in profile["formats"]
        if (device, precision) not in timed
    ]
    if not lacking:
        return ""
    return (
        f" Not timed: {', '.join(lacking)}, which has no instructions for it and would emulate it."
    )


def describe_printed_times(profile: Profile, published: pd.Series) -> str:
    """Describe the frames and the GPU of printed times."""
    width, height = printed_size(published)
    note = (
        f"Printed: {TEXTS['nsm']}, frames of {width} × {height}, 16-bit floats on an RTX 2080 Ti. "
        "Milliseconds are of another machine."
    )
    if of_printed_size(profile, published):
        return note
    return f"{note} Our frames have another size, so only weights have differences."


def describe(profile: Profile) -> str:
    """Describe the measurement and its machine."""
    machine, size = profile["machine"], profile["product_size"]
    whole = "; ".join(
        f"{run_name(run)} {run['whole_ms']:.4g} ms, {100 * product_share(profile, run):.0f} % of the "
        "product's rate"
        for run in profile["runs"]
    )
    gpu = f", {machine['gpu']}" if any(run["device"] == "cuda" for run in profile["runs"]) else ""
    return (
        f"Ours: frames of {profile['width']} × {profile['height']}, channels last, median of "
        f"{profile['repeats']} after {profile['warm_up']}, on {machine['cpu']}{gpu}. A whole frame, "
        "on a CPU in bands of rows and not part by part, and its multiply-adds a second beside those "
        f"of a product of {size}² matrices: {whole}."
        f"{not_timed(profile)}"
    )
