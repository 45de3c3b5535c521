import pytest

from neural_shadows.reports.data.verdicts import SUPPORTED, TOO_SMALL, VERDICTS
from neural_shadows.reports.page.claim_cards import Verdict, counted, number_text, read_cards


@pytest.mark.parametrize(
    ("given", "said"),
    [
        (
            ("PSNR", "-0.6 [-1.1, -0.1]", 3),
            "advantage in PSNR: −0.6 [−1.1, −0.1] (the least favourable of 3 comparisons)",
        ),
        (("PSNR", "+1.2e+03", 1), "advantage in PSNR: +1.2e+03"),
        (("own milliseconds", "ratio 2 [1.9, 2.1]", 1), "own milliseconds: ratio 2 [1.9, 2.1]"),
        (("", "", 1), ""),
    ],
)
def test_a_card_has_its_number_whole(given, said):
    assert number_text(*given) == said


def test_cards_and_their_counts(tmp_path):
    csv = tmp_path / "claims.csv"
    lines = [
        f'c{i},thesis,better,,,4.3,S,{verdict},R,"a; of its b\nc"'
        for i, verdict in enumerate([TOO_SMALL, SUPPORTED] * 2)
    ]
    columns = "claim,text,kind,number_of,number,section,statement,verdict,reason,evidence"
    csv.write_text("\n".join([columns, *lines]))
    cards = read_cards(csv)
    assert cards[0].evidence == ["a; of its b", "c"] and cards[0].verdict.style == "undecided-scale"
    assert [(one.name, one.count) for one in counted(cards)] == [(SUPPORTED, 2), (TOO_SMALL, 2)]


def test_verdicts_differ_without_their_colours():
    assert len({Verdict(name).symbol for name in VERDICTS}) == len(VERDICTS)
