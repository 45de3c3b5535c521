"""The thesis's claims as cards: statement, verdict, one number, and the evidence to unfold."""

import re
from dataclasses import dataclass
from pathlib import Path

import pandas as pd

from neural_shadows.reports.phrases import describe_samples
from neural_shadows.reports.verdicts import CONTRADICTED, MEANINGS, SYMBOLS, css_class

# An advantage in the evidence: signed, with its interval if it has one.
ADVANTAGE = re.compile(r": ([+-][\d.e-]+(?: \[[^\]]+\])?)")
METRIC = re.compile(r"(.+?) of ")  # what the evidence of a comparison begins with


@dataclass(frozen=True)
class Verdict:
    """A verdict as cards and filters show it; `count`: how many claims have it."""

    name: str
    count: int = 1

    @property
    def style(self) -> str:
        """Its class in the style sheet."""
        return css_class(self.name)

    @property
    def symbol(self) -> str:
        """Its sign, which says the same as the colour."""
        return SYMBOLS[self.name]

    @property
    def meaning(self) -> str:
        """What it says of a claim."""
        return MEANINGS[self.name]


@dataclass(frozen=True)
class Card:
    """A claim; `number` is the advantage in one comparison of `evidence`, or empty."""

    name: str
    statement: str
    section: str
    verdict: Verdict
    reason: str
    number: str
    evidence: list[str]


def read_cards(csv: Path) -> list[Card]:
    """The claims of claims.csv, in its order."""
    claims = pd.read_csv(csv, dtype=str, keep_default_na=False)
    cards = []
    for claim in claims.itertuples():
        evidence = claim.evidence.split("; ")
        number = number_of(evidence, claim.verdict)
        texts = claim.claim, claim.statement, claim.section
        cards.append(Card(*texts, Verdict(claim.verdict), claim.reason, number, evidence))
    return cards


def number_of(evidence: list[str], verdict: str) -> str:
    """The first advantage in the evidence; of a contradicted claim the first that is negative."""
    found = [(METRIC.match(text), ADVANTAGE.search(text)) for text in evidence]
    numbers = [(metric[1] if metric else "", number[1]) for metric, number in found if number]
    against = [pair for pair in numbers if pair[1].startswith("-")]
    chosen = against if verdict == CONTRADICTED and against else numbers
    if not chosen:
        return ""
    metric, advantage = chosen[0]
    of = f" ({len(evidence)} comparisons)" if len(evidence) > 1 else ""
    return f"advantage in {metric}: {advantage}{of}".replace("-", "−")


def counted(cards: list[Card]) -> list[Verdict]:
    """The verdicts that claims have, as the verdicts are ordered, and how often each."""
    names = [card.verdict.name for card in cards]
    return [Verdict(name, names.count(name)) for name in reversed(MEANINGS) if name in names]


def budget(csv: Path) -> str:
    """How the run's training samples compare with the thesis's; empty if nothing was trained."""
    claims = pd.read_csv(csv)
    seen, theirs = claims["samples"].max(), claims["thesis_samples"].max()
    return "" if pd.isna(seen) else describe_samples(seen, theirs)
