"""What a run found, in words that are made from its tables: a sentence each, or none."""

from collections.abc import Iterable
from pathlib import Path

import pandas as pd
from markupsafe import Markup

from neural_shadows.metrics.intervals import FEWEST_VIEWS
from neural_shadows.reports.finding_words import (
    ALIKE,
    bytes_beside,
    error_beside,
    in_memory,
    map_of,
    name_of,
    on_scene,
    size_of,
    with_psnr,
    worth_of,
)
from neural_shadows.reports.published import NETWORKS
from neural_shadows.reports.tables.quality import with_ends
from neural_shadows.reports.verdicts import CONTRADICTED, REASONS, SUPPORTED

OF_NETWORKS = {"scene", "method", "encoding", "samples", "psnr_pooled", "views"}
OF_NETWORKS |= {"stored_bytes", "resident_bytes"}
MAPS = {"map_lpips": "LPIPS", "map_psnr": "PSNR"}  # what a map's equality is by
SAME_GRID = 1.05  # times the parameters: the same grid
MOST_NAMED = 3


def findings(tables: Iterable[Path], claims_csv: Path | None) -> tuple[list[Markup], list[str]]:
    """What the tables of a run say, each sentence only where its data are there.

    Args:
        tables: CSVs; of those of networks the first counts, and of it the first scene.

    Returns: the findings, and why there are none where there are none.
    """
    frames = [pd.read_csv(path, dtype=dict.fromkeys(MAPS, str)) for path in tables]
    networks = next((frame for frame in frames if OF_NETWORKS <= {*frame}), None)
    found: list[Markup | None] = []
    gaps = []
    if networks is None:
        gaps.append("Nothing is said of quality: no table of networks has been made.")
    elif (views := _first_scene(networks)["views"].min()) < FEWEST_VIEWS:
        gaps.append(
            f"Nothing is said of quality: {views:.0f} views of a scene are too few. Tables and "
            "figures show that everything works, and nothing more."
        )
    else:
        scene = _first_scene(networks)
        said = [best_of_its_size(scene), training_adds(scene), thesis_network(scene)]
        if networks["scene"].nunique() > 1:
            said = [on_scene(scene["scene"].iloc[0], sentence) for sentence in said if sentence]
        found += [*said, unlearned(networks)]
    if claims_csv is None:
        gaps.append("The thesis's claims have not been tested.")
    else:
        found.append(claims_counted(pd.read_csv(claims_csv)))
    return [sentence for sentence in found if sentence], gaps


def best_of_its_size(table: pd.DataFrame) -> Markup | None:
    """How the best trained network compares with what is of another kind and takes no more bytes.

    In a file, and then in memory, where another rival may be the strongest.
    """
    known = table.dropna(subset=["psnr_pooled", "stored_bytes"])
    networks = known[known["samples"].gt(0) & ~_failed(known)]
    if networks.empty:
        return None
    best = _best(networks)
    size = Markup("<strong>{}</strong>").format(size_of(best["stored_bytes"]))
    worth = worth_of(best, "map_psnr")
    other, held = (_rival(known, best, kept) for kept in ("stored_bytes", "resident_bytes"))
    memory = Markup()
    if held is not None and (other is None or held["method"] != other["method"]):
        memory = in_memory(best, held, *_compared(best, held))
    if other is None:
        said = Markup("The best trained network is the {}, in {}{}.{}")
        return said.format(with_psnr(best), size, worth, memory)
    difference, side = _compared(best, other)
    if side > 0:
        said = (
            "In {size} nothing comes closer to the exact shadow than the {best}{worth}. The best of "
            "another kind, the {other}, {error}.{memory}"
        )
    elif side < 0:
        said = (
            "The best trained network, the {best}, is not worth its {size}: the {other} takes "
            "{bytes}, and {error}.{memory}"
        )
    else:
        said = "In {size} the {best} and the {other} are too close to tell which is better.{memory}"
    return Markup(said).format(
        size=size,
        best=with_psnr(best),
        other=with_psnr(other),
        worth=worth,
        bytes=bytes_beside(best["stored_bytes"], other["stored_bytes"]),
        memory=memory,
        error=error_beside(difference),
    )


def _rival(known: pd.DataFrame, best: pd.Series, column: str) -> pd.Series | None:
    """The best of another kind that has no more bytes than `best` in a column; None for none."""
    alike = known["encoding"].eq(best["encoding"]) & known["samples"].gt(0)
    fits = known[~alike & (known[column] <= ALIKE * best[column])]
    return None if fits.empty else _best(fits)


def training_adds(table: pd.DataFrame) -> Markup | None:
    """What training adds over the same grid with nothing trained in it."""
    fields = table[table["encoding"].eq("occupancy_field")].dropna(subset=["psnr_pooled"])
    built = fields[fields["samples"].eq(0)]
    for _, trained in fields[fields["samples"].gt(0)].sort_values("psnr_pooled")[::-1].iterrows():
        ratio = built["parameters"] / trained["parameters"]
        same = built[ratio.between(1 / SAME_GRID, SAME_GRID)]
        if len(same):
            break
    else:
        return None
    other = _best(same)
    difference, side = _compared(trained, other)
    said = {
        1: "Training pays: the {} is {} better than the same grid untrained ({}).",
        -1: "Training does not pay: the {} is {} worse than the same grid untrained ({}).",
        0: "Whether training pays is not clear: the {} is {} from the same grid untrained ({}), "
        "within what chance does.",
    }
    decibels = Markup("<strong>{:.1f} dB</strong>").format(abs(difference))
    return Markup(said[side]).format(name_of(trained), decibels, name_of(other))


def thesis_network(table: pd.DataFrame) -> Markup | None:
    """Which shadow map the thesis's network equals here, and in the thesis."""
    own = table[table["encoding"].eq("frequency")].dropna(subset=["psnr_pooled"])
    if own.empty:
        return None
    best = _best(own)
    if _failed(own).all():
        said = "The thesis's network has learned nothing here: not even its best variant, {}, is "
        return Markup(said + "better than drawing no shadow at all.").format(name_of(best))
    for column, metric in MAPS.items():
        if isinstance(best[column], str):
            printed = table.loc[table["method"].isin(NETWORKS.values()), column].dropna()
            said = Markup("The thesis's network, at its best here ({}), is worth {} by {}").format(
                name_of(best), map_of(best[column]), metric
            )
            theirs = (
                Markup("; in the thesis {}").format(map_of(printed.iloc[0])) if any(printed) else ""
            )
            return said + theirs + "."
    return None


def unlearned(table: pd.DataFrame) -> Markup | None:
    """How many of the trained networks have learned nothing, of all scenes."""
    trained = table[table["samples"].gt(0) & table["learned"].notna()]
    failed = trained[_failed(trained)]
    if failed.empty:
        return None
    names = [f"{row.method} ({row.scene})" for row in failed.itertuples()]
    if len(names) > MOST_NAMED:
        names[MOST_NAMED:] = [f"{len(names) - MOST_NAMED} more"]
    return Markup(
        "<strong>{} of {}</strong> trained networks have learned nothing, that is, are no better "
        "than drawing no shadow at all: {}."
    ).format(len(failed), len(trained), ", ".join(names))


def claims_counted(claims: pd.DataFrame) -> Markup:
    """How the thesis's claims came out, and the verdict that most of the others share.

    Those that the thesis's own tables decide say nothing of the run, and are counted apart.
    """
    claims = claims[claims.get("text", pd.Series("thesis", claims.index)).eq("thesis")]
    printed = claims.get("kind", pd.Series("", claims.index)).eq("printed")
    said = [_tested(claims.loc[~printed, "verdict"])] * bool((~printed).any())
    if printed.any():
        counts = claims.loc[printed, "verdict"].value_counts()
        own = "The thesis's own tables test {} of its claims: they support {} and contradict {}."
        held, lost = (counts.get(verdict, 0) for verdict in (SUPPORTED, CONTRADICTED))
        said.append(Markup(own).format(printed.sum(), held, lost))
    return Markup(" ").join(said)


def _tested(verdicts: pd.Series) -> Markup:
    """The verdicts that a run's data gave."""
    counts = verdicts.value_counts()
    held, lost = (counts.get(verdict, 0) for verdict in (SUPPORTED, CONTRADICTED))
    said = Markup(
        "Of {} claims of the thesis this run supports <strong>{}</strong> and contradicts "
        "<strong>{}</strong>"
    ).format(len(verdicts), held, lost)
    rest = counts.drop([SUPPORTED, CONTRADICTED], errors="ignore")
    if rest.empty:
        return said + "."
    most = "" if len(rest) == 1 else f"{rest.iloc[0]} of them "
    others = "; it cannot decide the other {}, {}since {}."
    return said + Markup(others).format(rest.sum(), most, REASONS[rest.index[0]])


def _best(rows: pd.DataFrame) -> pd.Series:
    return rows.loc[rows["psnr_pooled"].idxmax()]


def _failed(rows: pd.DataFrame) -> pd.Series:
    """Which are said not to have learned; of too few views nothing is said."""
    return rows["learned"].astype(str).eq("False")


def _compared(a: pd.Series, b: pd.Series) -> tuple[float, int]:
    """By how many dB `a` is better than `b`, and whether it is (1), is worse (-1) or neither (0).

    By the paired difference, if the table has theirs, or else only where intervals are apart.
    """
    for one, other, sign in ((a, b, 1), (b, a, -1)):
        # The row that the others' differences are to has none itself.
        if pd.isna(other.get("psnr_difference")) and pd.notna(one.get("psnr_difference")):
            value, *ends = sign * one[with_ends("psnr_difference")].astype(float)
            break
    else:
        value = a["psnr_pooled"] - b["psnr_pooled"]
        ends = [
            a["psnr_pooled_low"] - b["psnr_pooled_high"],
            a["psnr_pooled_high"] - b["psnr_pooled_low"],
        ]
    return value, int(min(ends) > 0) - int(max(ends) < 0)


def _first_scene(table: pd.DataFrame) -> pd.DataFrame:
    return table[table["scene"] == table["scene"].iloc[0]]
