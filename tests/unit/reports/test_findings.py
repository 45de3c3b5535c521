"""What a run found: sentences that turn round with the data."""

import pandas as pd
import pytest

from neural_shadows.reports.finding_rivals import _with_bytes as with_bytes
from neural_shadows.reports.finding_words import size_of
from neural_shadows.reports.findings import claims_counted, findings
from neural_shadows.reports.verdicts import CONTRADICTED, SUPPORTED, TOO_SMALL, VACUOUS

NAN = float("nan")
NETWORKS = {  # label: encoding, samples, stored bytes, pooled PSNR, learned, equal map
    "512² map": (None, NAN, 2**20, 35.0, NAN, None),
    "256² map": (None, NAN, 2**18, 32.0, NAN, None),
    "Grid": ("occupancy_field", 0, 700_000, 39.0, NAN, "900"),
    "Field": ("occupancy_field", 3e7, 710_000, 41.0, True, "> 2048"),
    "Thesis": ("frequency", 2e7, 2_000_000, 25.0, True, "< 128"),
    "No shadow": (None, NAN, NAN, 12.0, NAN, None),
}


def found_table(half=0.5, views=48, **changes):
    """A table of networks with intervals of ± `half` dB."""
    names = ["encoding", "samples", "stored_bytes", "psnr_pooled", "learned", "map_lpips"]
    table = pd.DataFrame.from_dict(NETWORKS, orient="index", columns=names)
    for label, values in changes.items():
        for column, value in values.items():
            table.loc[label, column] = value
    table = table.rename_axis("method").reset_index().assign(scene="dragon", views=views)
    table = table.assign(parameters=1000, map_psnr=table["map_lpips"])
    table = table.assign(training_seconds=range(len(table)))
    table = table.assign(resident_bytes=3 * table["stored_bytes"])
    ends = {"psnr_pooled_low": -half, "psnr_pooled_high": half}
    return table.assign(**{name: table["psnr_pooled"] + by for name, by in ends.items()})


def said_of(folder, table):
    """The findings of a table, and why some are missing."""
    table.to_csv(folder / "beyond.csv", index=False)
    said, gaps = findings([folder / "beyond.csv"], None)
    return [str(sentence.striptags()) for sentence in said], gaps


def found(folder, **given):
    """The findings of `found_table`."""
    return said_of(folder, found_table(**given))


def test_what_is_best_at_equal_bytes_turns_round_with_the_data(tmp_path):
    (best, trained, thesis), _ = found(tmp_path)
    assert best == (
        "In 693 KiB nothing measured comes closer to the exact shadow than the Field (41.0 dB [40.5, 41.5]),"
        " worth more than a 2048² shadow map of 16 MiB."
        " The best of another kind, the Grid (39.0 dB [38.5, 39.5]) in as many bytes, has 1.6 times its squared error."
    )
    assert (
        trained == "Training pays: the Field is 2.0 dB better than the same grid untrained (Grid)."
    )
    assert thesis.endswith(
        "(Thesis), trained on 3,277 times fewer samples than the thesis's, is worth less than a "
        "128² shadow map by LPIPS."
    )

    (best, trained, _), _ = found(tmp_path, Grid={"psnr_pooled": 44.0})
    assert best == (
        "The best trained network, the Field (41.0 dB [40.5, 41.5]) in 693 KiB, loses to the Grid "
        "(44.0 dB [43.5, 44.5]), which takes as many bytes and has 2 times less squared error."
    )
    assert trained.startswith("Training does not pay: the Field is 3.0 dB worse")

    (best, trained, _), _ = found(tmp_path, half=2.5)
    assert best.endswith("are too close to tell which is better.")
    assert trained.startswith("Whether training pays is not clear")


@pytest.mark.parametrize(
    ("grid", "said"),
    [
        ({"psnr_pooled": 63.0}, "takes as many bytes and has 158 times less squared error."),
        ({"psnr_pooled": 41.5}, "takes as many bytes and is 0.5 dB better."),
        ({"psnr_pooled": 44.0, "stored_bytes": 717_000}, "takes as many bytes and has 2"),
        ({"psnr_pooled": 44.0, "stored_bytes": 512_000}, "takes 500 KiB and has 2 times less"),
        (
            {"psnr_pooled": 40.5},
            "the Grid (40.5 dB [40.4, 40.6]) in as many bytes, is 0.5 dB worse.",
        ),
        (
            {"psnr_pooled": 15.0},
            "the 256² map (32.0 dB [31.9, 32.1]) in 256 KiB, has 7.9 times its",
        ),
    ],
)
def test_numbers_are_told_in_words_that_suit_their_size(tmp_path, grid, said):
    (best, *_), _ = found(tmp_path, half=0.1, Grid=grid)
    assert said in best


def test_in_memory_another_rival_may_be_the_strongest(tmp_path):
    table = found_table(half=0.5, Grid={"psnr_pooled": 44.0})
    table.loc[table["method"] == "Grid", "resident_bytes"] = 9e6
    (best, *_), _ = said_of(tmp_path, table)
    assert "the Grid (44.0 dB [43.5, 44.5]), which takes as many bytes and has 2 times" in best
    assert best.endswith(
        "In memory the Field takes 2.03 MiB, the Grid 8.58 MiB; the best of another kind that takes "
        "no more is the 256² map (32.0 dB [31.5, 32.5]), which has 7.9 times the network's squared "
        "error."
    )


def test_the_largest_network_that_wins_comes_before_a_better_one_that_loses(tmp_path):
    table = found_table(Grid={"psnr_pooled": 44.0})
    small = table[table["method"] == "Field"].assign(
        method="Small", stored_bytes=300_000, psnr_pooled=36.0, psnr_pooled_low=35.5
    )
    (small_one, best, *_), _ = said_of(tmp_path, pd.concat([table, small]))
    assert small_one.startswith(
        "In 293 KiB nothing measured comes closer to the exact shadow than the Small"
    )
    assert (
        "the 256² map (32.0 dB [31.5, 32.5]) in 256 KiB, has 2.5 times its squared error."
        in small_one
    )
    assert best.startswith("The best trained network, the Field")
    # A smaller rival's kind may have as much with as many bytes.
    meshes = pd.concat([small.assign(encoding="mesh", samples=0)] * 2).assign(
        method=["Mesh", "Larger mesh"], stored_bytes=[270_000, 400_000]
    )
    for low, first in ((34.0, "The best trained network"), (20.0, "In 293 KiB")):
        ends = dict.fromkeys(("psnr_pooled", "psnr_pooled_low", "psnr_pooled_high"), [low, 45.0])
        sizes = meshes.assign(**ends)
        (best, *_), _ = said_of(tmp_path, pd.concat([table, small, sizes]))
        assert best.startswith(first)
    # Of two that are too close to tell, none is said to win.
    close = table["method"] == "256² map"
    table.loc[close, ["psnr_pooled", "psnr_pooled_high"]] = 35.8, 36.3
    (best, *_), _ = said_of(tmp_path, pd.concat([table, small]))
    assert best.startswith("The best trained network, the Field")


def test_nothing_is_said_of_memory_that_is_not_known(tmp_path):
    table = found_table(half=0.5, Grid={"psnr_pooled": 44.0}).assign(resident_bytes=NAN)
    (best, *_), _ = said_of(tmp_path, table)
    assert best.endswith("has 2 times less squared error.")


def test_of_several_scenes_the_one_that_is_meant_is_named(tmp_path):
    table = found_table()
    # Of another scene there are too few views; what is said is of the first.
    other = table.assign(scene="fence", views=6, psnr_pooled=10.0)
    (best, trained, thesis), _ = said_of(tmp_path, pd.concat([table, other]))
    assert best.startswith("On the dragon, in 693 KiB nothing measured comes closer")
    assert trained.startswith("On the dragon, training pays: the Field is 2.0 dB better")
    assert thesis.startswith("On the dragon, the thesis's network")


def test_a_paired_difference_decides_where_intervals_overlap(tmp_path):
    paired = {"psnr_difference": -2.0, "psnr_difference_low": -2.1, "psnr_difference_high": -1.9}
    (best, trained, _), _ = found(tmp_path, half=2.5, Grid=paired)
    assert best.startswith("In 693 KiB nothing measured comes closer") and trained.startswith(
        "Training pays"
    )


def test_the_thesis_s_network_beside_the_thesis_and_what_has_not_learned(tmp_path):
    printed = {"Thesis's network, as printed": {"map_lpips": "386", "stored_bytes": 2.2e6}}
    (*_, thesis), _ = found(tmp_path, **printed)
    assert thesis.endswith("less than a 128² shadow map by LPIPS; in the thesis a 386² shadow map.")
    (*_, thesis, failed), _ = found(tmp_path, Thesis={"learned": False})
    assert "in its best variant, Thesis, not better in every metric than drawing no sha" in thesis
    assert failed.startswith("1 of 2 trained networks are not better in every metric")
    assert failed.endswith(": Thesis (dragon).")
    # A network of two rows is one, and has learned if it has with its depth bias.
    table = found_table(Thesis={"learned": False})
    rows = [table, table[table["method"] == "Thesis"].assign(method="Thesis, biased")]
    (*_, failed), _ = said_of(tmp_path, pd.concat(rows))
    assert failed.startswith("1 of 2 trained networks are")
    (*_, last), _ = said_of(tmp_path, pd.concat([rows[0], rows[1].assign(learned=True)]))
    assert "drawing no shadow" not in last
    # A field that has not learned is no finding.
    (trained, *_), _ = found(tmp_path, Field={"learned": False, "psnr_pooled": 12.0})
    assert trained.startswith("The best trained network, the Thesis")


def test_what_is_missing_is_said_in_place_of_findings(tmp_path):
    said, gaps = found(tmp_path, views=6)
    assert said == [] and gaps[0].startswith("Nothing is said of quality: 6 views")
    assert findings([], None) == (
        [],
        [
            "Nothing is said of quality: no table of networks has been made.",
            "The thesis's claims have not been tested.",
        ],
    )


@pytest.mark.parametrize(
    ("verdicts", "end"),
    [
        ([SUPPORTED, CONTRADICTED], "supports 1 and contradicts 1."),
        ([SUPPORTED, TOO_SMALL, TOO_SMALL], "cannot decide the other 2, because the run"),
        ([TOO_SMALL, VACUOUS, TOO_SMALL], "cannot decide the other 3, 2 of them because the run"),
    ],
)
def test_claims_are_counted(verdicts, end):
    said = claims_counted(pd.DataFrame({"verdict": verdicts})).striptags()
    assert said.startswith(f"Of {len(verdicts)} claims") and end in said


def test_claims_that_the_thesis_s_tables_decide_are_no_result_of_the_run():
    claims = pd.DataFrame({"verdict": [SUPPORTED, CONTRADICTED, CONTRADICTED]})
    claims["kind"] = ["better", "printed", "printed"]
    own = "The thesis's own tables test 2 of its claims: they support 0 and contradict 2."
    said = claims_counted(claims).striptags()
    assert said == f"Of 1 claims of the thesis this run supports 1 and contradicts 0. {own}"
    assert claims_counted(claims[1:]).striptags() == own


def test_sizes():
    assert [size_of(size) for size in (2**10, 783_360, 2**24)] == ["1 KiB", "765 KiB", "16 MiB"]


def test_a_coded_rival_is_measured_between_coded_sizes():
    """Packed meshes take four times the bytes: between both it would be nothing's quality."""
    table = pd.DataFrame(
        [
            ("mesh", 0, 40e3, 37.0, True),
            ("mesh", 0, 160e3, 45.0, True),
            ("mesh", 0, 80e3, 24.0, False),
        ],
        columns=["encoding", "samples", "stored_bytes", "psnr_pooled", "coded"],
    )
    assert with_bytes(table, table.iloc[0], 80e3) == pytest.approx(41)
