"""No text of ours states on soft shadows what no claim has decided."""

import pytest
from checkout import ROOT
from claimed_sentences import mistakes, read_claims, sentences
from shipped import shipped

REFERENCE = ROOT / "reports" / "reference"
TEXTS = ["README.md", *(str(path.relative_to(ROOT)) for path in REFERENCE.glob("**/README.md"))]
VERDICTS = {
    "ahead": {"supported"},
    "calmer": {"contradicted"},
    "open": {"undecided"},
    "small": {"undecided (scale)"},
    "twice": {"supported", "undecided"},
    "desk/twice": {"supported"},
}
GOOD = """\
## Soft shadows

PCSS has 33.6 in five scenes, and took 50 ms. <!-- numbers: soft.csv --> Times are of one thread.

- **Four rays err less than PCSS**, by 12 [3, 21] (Hu et al. 2025).
  <!-- claim: ahead supported --> The table has all.
- That the network is calmer is contradicted. <!-- claim: calmer contradicted -->
- Whether kernels are better than PCSS is undecided <!-- claim: open undecided -->.
- **Of what it learns nothing is decided.** <!-- claim: small undecided (scale), open undecided -->
- It is ahead in the desk's run. <!-- claim: desk/twice supported -->

| better | PCSS is worse than rays |
| --- | --- |

## Shadows of one object

**The field has 42 dB, more than the map, and is faster.** Filters take less.
"""
BAD = {
    "PCSS is better than moments.": "names no claim",
    "**It carries over.**": "names no claim",
    "Four rays are ahead. <!-- claim: ahead supported --> They beat moments, too.": "no claim: They",
    "They beat moments. Four rays are ahead. <!-- claim: ahead supported -->": "no claim: They",
    "Kernels are better. <!-- claim: open supported -->": "open: is undecided, and not supported",
    "Kernels are better. <!-- claim: open undecided -->": "open: is undecided, and the sentence",
    "It is calmer. <!-- claim: calmer contradicted -->": "calmer: is contradicted, and the sentence",
    "It is calmer. <!-- claim: calmer supported -->": "calmer: is contradicted, and not supported",
    "Rays are ahead. <!-- claim: ahead -->": "ahead: is supported, and not without verdict",
    "Rays are ahead. <!-- claim: gone supported -->": "gone: is no claim of the reference",
    "Rays are ahead. <!-- claim: twice supported -->": "twice: is supported and undecided",
    "Rays are ahead, and it is calmer. <!-- claim: ahead supported, calmer supported -->": "calmer:",
    "At 25 cm the map errs 1.5 times as much.": "names no claim",
}


def test_sentences_that_are_right_pass():
    assert mistakes(GOOD, VERDICTS) == []


@pytest.mark.parametrize("sentence", BAD)
def test_sentences_that_are_wrong_are_named(sentence):
    (found,) = mistakes(f"### Datta et al. 2022 and others\n- One.\n- {sentence}", VERDICTS)
    assert BAD[sentence] in found


def test_elsewhere_a_sentence_on_soft_shadows_has_a_claim_too():
    """As in the README, which has no part for them."""
    text = (
        "# Neural shadows\n\n- A light of 12.5 cm: PCSS 175, less than moments.\n- A map is worse."
    )
    (found,) = mistakes(text, VERDICTS)
    assert "PCSS 175, less" in found


@pytest.mark.parametrize("name", TEXTS)
def test_our_sentences_say_what_their_claims_say(name):
    text = (ROOT / name).read_text(encoding="utf-8")
    assert mistakes(text, read_claims(REFERENCE.glob("*/claims.csv"))) == []
    assert any(in_part for _, _, in_part in sentences(text)) or name == "README.md"


@pytest.mark.parametrize("name", TEXTS)
def test_claims_that_our_sentences_name_are_those_that_are_judged_today(name):
    """A claim whose rivals have changed since has another statement, and its verdict is of the former."""
    judged = read_claims(REFERENCE.glob("*/claims.csv"), "statement")
    today = shipped()["claims"]
    today |= shipped("layout_curves")["claims"] | shipped("nsm_longer")["claims"]
    named = {
        claim
        for _, claims, _ in sentences((ROOT / name).read_text(encoding="utf-8"))
        for claim, _ in claims
    }
    assert named
    stated = {one: {today[one.rpartition("/")[2]]["statement"]} for one in named}
    assert {one: judged[one] for one in named} == {one: stated[one] for one in named}
