from neural_shadows.reports.claim_cards import Verdict, counted, number_of, read_cards
from neural_shadows.reports.verdicts import CONTRADICTED, SUPPORTED, TOO_SMALL, VERDICTS

EVIDENCE = [
    "LPIPS of A 0.09 against B 0.09: 6 views are too few",
    "PSNR of A 11.8 dB against B 11.2 dB: +0.6 [+0.1, +1.1]",
    "loss of A 0.32 against B 0.27: -0.058 [-0.06, -0.05], moving away",
]


def test_a_card_has_the_number_that_decides():
    assert number_of(EVIDENCE, SUPPORTED) == "advantage in PSNR: +0.6 [+0.1, +1.1] (3 comparisons)"
    assert number_of(EVIDENCE[1:2], TOO_SMALL) == "advantage in PSNR: +0.6 [+0.1, +1.1]"
    assert number_of(EVIDENCE, CONTRADICTED).startswith("advantage in loss: −0.058 [−0.06, −0.05]")
    assert number_of(EVIDENCE[:1], TOO_SMALL) == ""


def test_cards_and_their_counts(tmp_path):
    csv = tmp_path / "claims.csv"
    lines = [f"c{i},4.3,S,{verdict},R,a; b" for i, verdict in enumerate([TOO_SMALL, SUPPORTED] * 2)]
    csv.write_text("\n".join(["claim,section,statement,verdict,reason,evidence", *lines]))
    cards = read_cards(csv)
    assert cards[0].evidence == ["a", "b"] and cards[0].verdict.style == "undecided-scale"
    assert [(one.name, one.count) for one in counted(cards)] == [(SUPPORTED, 2), (TOO_SMALL, 2)]


def test_verdicts_differ_without_their_colours():
    assert len({Verdict(name).symbol for name in VERDICTS}) == len(VERDICTS)
