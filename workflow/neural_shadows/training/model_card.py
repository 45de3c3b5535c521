"""Model cards of shipped weights, written from their headers."""

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

from neural_shadows.errors import InputError
from neural_shadows.frames.feature_names import TRACED, buffers_of
from neural_shadows.networks.kind_module import FORMS
from neural_shadows.networks.screen_space.screen_networks import load_screen_network
from neural_shadows.settings.kinds import kinds
from neural_shadows.training.restore_weights import check_header

CARD = """# {name}

{about} Visibility of area lights from a frame's buffers: {parameters:,} weights, {kib:,.0f} KiB.

## Use

    snakemake reports/answers/FRAMES/{name}.csv --configfile config/mine.yaml

evaluates {frames}; see [config/README.md](../../config/README.md#frames-of-your-own).

## Training

| | |
| --- | --- |
| frame set | `{frame_set}` |
| training | {train} |
| validation | {validation} |
| scenes | {scenes} |
| budget | {steps:,} steps, {pixels:.0f} million pixels, {minutes:.0f} minutes, threads: {threads} |
| loss | {alpha:.0%} L1, perceptual term: {perceptual}, temporal weight {perturbation:g} |
| seed, commit | {seed}, {commit} |
| machine | {machine} |
| licence | {licence}, as the rest of this repository |

## Validation errors

Mean squared error × 10⁻⁴ on validation frames, by radius of the light.

{errors}

## Limits

- Lights: {shape}, radius up to {largest:g} {unit}; larger ones are refused.
- Needs {rays}the channels {buffers}, and frames of {reach} pixels a side or more.
{crossed}- One training of one seed; measure it on frames of yours that have targets before you rely on it.
"""

# Seen in frames of another renderer, of 2048 × 1024 pixels, which no network here trains on.
CROSSED = "- Kernels cross silhouettes: thin lit things before far dark ones may glow 10 to 20 pixels wide.\n"


def model_card(weights: Path) -> str:
    """Card of a file that `ship_weights` has written.

    Raises:
        InputError: a damaged file, or a header without its numbers.
    """
    network, header = load_screen_network(weights)
    check_header(header, weights)
    training, data, radii = header["training"], header["data"], header["radii"]
    lights = training["lights"] or range(len(radii))
    form = header["network"]["form"]
    traced = "rays" in header  # in the scene, which a user's frames lack
    channels = [name for name in buffers_of(network.features) if name not in TRACED]
    return CARD.format(
        name=weights.stem,
        about=kinds(FORMS)[form].__doc__.splitlines()[0],
        parameters=header["parameters"],
        kib=weights.stat().st_size / 1024,
        train=_frames(data["train"]),
        validation=_frames(data["validation"]),
        frame_set=data["frame_set"],
        scenes=", ".join(header["scenes"]),
        **{key: training[key] for key in ("steps", "alpha", "perturbation", "seed")},
        pixels=header["samples"] / 1e6,
        minutes=header["seconds"] / 60,
        threads=header["threads"],
        perceptual=header["perceptual"],
        commit=header["commit"],
        machine=header["machine"]["gpu"] or header["machine"]["cpu"],
        errors=_errors(header, lights, weights),
        shape=f"a {(header['light'] or {}).get('shape', 'sphere')}",
        largest=max(radii),
        unit=_words(header["radius_unit"]),
        frames="frames rendered here; frames of your own have no rays"
        if traced
        else "frames of your own, too",
        buffers=", ".join(f"`{'z_b' if name == 'gap' else name}`" for name in channels),
        rays=f"{header['rays']} rays a pixel, " if traced else "",
        reach=network.reach,
        crossed=CROSSED * (form == "kernels" and not header["network"].get("edge")),
        licence=header["licence"],
    )


def _frames(count: Mapping[str, int]) -> str:
    size = f"{count['width']} × {count['height']}"
    return f"{count['frames']:,} of {size} of {count['layouts']:,} layouts"


def _errors(header: Mapping[str, Any], lights: Sequence[int], weights: Path) -> str:
    """Errors by radius: the network's, its base's (or the hard map's), no shadow's."""
    nulls = header["null_mse"]
    bases = [name for name in nulls if name not in ("no_shadow", "hard_map")]
    bases = bases or [name for name in nulls if name == "hard_map"]
    errors = {"this network": header["validation_mse"], **{name: nulls[name] for name in bases}}
    errors["no shadow"] = nulls["no_shadow"]
    if None in (errors["this network"][light] for light in lights):
        raise InputError(f"{weights.name}: validation_mse: is not finite. Ship another training")
    rows = [[f"radius, {_words(header['radius_unit'])}"]]
    rows[0] += [f"{header['radii'][light]:g}" for light in lights]
    rows.append(["---", *["--:"] * len(lights)])
    rows += [[name, *(f"{1e4 * row[k]:.2f}" for k in lights)] for name, row in errors.items()]
    return "\n".join(f"| {' | '.join(row)} |" for row in rows)


def _words(unit: str) -> str:
    return unit.replace("_", " ")
