"""What a run found, in words that are made from its tables: a sentence each, or none."""

from collections.abc import Iterable
from pathlib import Path

import pandas as pd
from markupsafe import Markup

from neural_shadows.metrics.intervals import FEWEST_VIEWS
from neural_shadows.reports.claims.measured import THESIS_SAMPLES
from neural_shadows.reports.finding_rivals import best_of, best_of_their_size, failed, training_adds
from neural_shadows.reports.finding_words import map_of, name_of, on_scene
from neural_shadows.reports.published import NETWORKS
from neural_shadows.reports.verdicts import CONTRADICTED, REASONS, SUPPORTED

OF_NETWORKS = {"scene", "method", "encoding", "samples", "psnr_pooled", "views"}
OF_NETWORKS |= {"stored_bytes", "resident_bytes", "training_seconds"}
MAPS = {"map_lpips": "LPIPS", "map_psnr": "PSNR"}  # what a map's equality is by
MOST_NAMED = 3
ONE_NETWORK = ["encoding", "parameters", "samples", "training_seconds"]


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
        said = [*best_of_their_size(scene), training_adds(scene), thesis_network(scene)]
        if networks["scene"].nunique() > 1:
            said = [on_scene(scene["scene"].iloc[0], sentence) for sentence in said if sentence]
        found += [*said, unlearned(networks)]
    if claims_csv is None:
        gaps.append("The thesis's claims have not been tested.")
    else:
        found.append(claims_counted(pd.read_csv(claims_csv)))
    return [sentence for sentence in found if sentence], gaps


def thesis_network(table: pd.DataFrame) -> Markup | None:
    """Which shadow map the thesis's network equals here, and in the thesis."""
    own = table[table["encoding"].eq("frequency")].dropna(subset=["psnr_pooled"])
    if own.empty:
        return None
    best = best_of(own)
    if failed(own).all():
        said = "The thesis's network is here, even in its best variant, {}, not better in every "
        return Markup(said + "metric than drawing no shadow at all.").format(name_of(best))
    for column, metric in MAPS.items():
        if isinstance(best[column], str):
            printed = table.loc[table["method"].isin(NETWORKS.values()), column].dropna()
            said = Markup("The thesis's network, at its best here ({}){}, is worth {} by {}")
            said = said.format(name_of(best), fewer_samples(best), map_of(best[column]), metric)
            theirs = (
                Markup("; in the thesis {}").format(map_of(printed.iloc[0])) if any(printed) else ""
            )
            return said + theirs + "."
    return None


def fewer_samples(network: pd.Series) -> str:
    """How many times fewer samples than the thesis's networks one saw, where it saw fewer."""
    times = THESIS_SAMPLES / network["samples"]
    return f", trained on {times:,.0f} times fewer samples than the thesis's" if times >= 2 else ""


def unlearned(table: pd.DataFrame) -> Markup | None:
    """How many of the trained networks are in no row of theirs better than no shadow; all scenes."""
    trained = table[table["samples"].gt(0) & table["learned"].notna()]
    # A network stands in one row with a depth bias and in another without.
    networks = trained.assign(failed=failed(trained)).groupby(["scene", *ONE_NETWORK], sort=False)
    networks = networks.agg({"failed": "all", "method": "last"}).reset_index()
    lost = networks[networks["failed"]]
    if lost.empty:
        return None
    names = [f"{row.method} ({row.scene})" for row in lost.itertuples()]
    if len(names) > MOST_NAMED:
        names[MOST_NAMED:] = [f"{len(names) - MOST_NAMED} more"]
    return Markup(
        "<strong>{} of {}</strong> trained networks are not better in every metric than drawing "
        "no shadow at all: {}."
    ).format(len(lost), len(networks), ", ".join(names))


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
    others = "; it cannot decide the other {}, {}because {}."
    return said + Markup(others).format(rest.sum(), most, REASONS[rest.index[0]])


def _first_scene(table: pd.DataFrame) -> pd.DataFrame:
    return table[table["scene"] == table["scene"].iloc[0]]
