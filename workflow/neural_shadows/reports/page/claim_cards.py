"""Claims as cards: statement, verdict, number and evidence."""

from dataclasses import dataclass
from pathlib import Path

import pandas as pd

from neural_shadows.reports.data.phrases import TEXTS, describe_samples, section_of
from neural_shadows.reports.data.verdicts import IN_SHORT, MEANINGS, SYMBOLS, css_class
from neural_shadows.settings.kinds import kinds

# Of a claim, by its `text`.
SOURCES = {"thesis": "Spanhoff 2026", **TEXTS, "own": "Claims of ours"}


@dataclass(frozen=True)
class Verdict:
    """A verdict as cards and filters show it.

    `count`: of its claims; `printed`: of those judged by the thesis's own tables.
    """

    name: str
    count: int = 1
    printed: int = 0

    @property
    def style(self) -> str:
        """Its class in the style sheet."""
        return css_class(self.name)

    @property
    def symbol(self) -> str:
        """Its sign, equivalent to the colour."""
        return SYMBOLS[self.name]

    @property
    def meaning(self) -> str:
        """Its meaning for a claim."""
        return MEANINGS[self.name]

    @property
    def in_short(self) -> str:
        """Its meaning for a first-time reader."""
        return IN_SHORT[self.name]


@dataclass(frozen=True)
class Card:
    """A claim; `number` is of the least favourable comparison, or empty."""

    name: str
    source: str
    statement: str
    section: str
    verdict: Verdict
    reason: str
    number: str
    evidence: list[str]
    printed: bool


def read_cards(csv: Path) -> list[Card]:
    """Read the claims of claims.csv, in its order."""
    claims = pd.read_csv(csv, dtype=str, keep_default_na=False)
    cards = []
    for claim in claims.itertuples():
        evidence = claim.evidence.split("\n")
        number = number_text(claim.number_of, claim.number, len(evidence))
        section = section_of({"text": claim.text, "section": claim.section})
        texts = claim.claim, SOURCES[claim.text], claim.statement, section
        judgement = Verdict(claim.verdict), claim.reason, number, evidence, _without_run(claim.kind)
        cards.append(Card(*texts, *judgement))
    return cards


def _without_run(kind: str) -> bool:
    """Check for a kind that judges a text by itself."""
    return getattr(kinds("reports/claims/kinds").get(kind), "WITHOUT_RUN", False)


def number_text(metric: str, number: str, comparisons: int) -> str:
    """A number of claims.csv in words; one with a sign is an advantage."""
    if not number:
        return ""
    advantage = "advantage in " if number.startswith(("+", "-")) else ""
    of = f" (the least favourable of {comparisons} comparisons)" if comparisons > 1 else ""
    return f"{advantage}{metric}: {number.replace('-', '−')}{of}"


def by_source(cards: list[Card]) -> dict[str, list[Card]]:
    """Cards of each text, in the order of `SOURCES`."""
    of = {source: [card for card in cards if card.source == source] for source in SOURCES.values()}
    return {source: own for source, own in of.items() if own}


def counted(cards: list[Card]) -> list[Verdict]:
    """Count claims by verdict, in the order of verdicts."""
    verdicts = []
    for name in reversed(MEANINGS):
        judged = [card for card in cards if card.verdict.name == name]
        if judged:
            verdicts.append(Verdict(name, len(judged), sum(card.printed for card in judged)))
    return verdicts


def budget(csv: Path) -> str:
    """Compare training samples with the thesis's; empty without training."""
    claims = pd.read_csv(csv).query("text == 'thesis'")
    theirs = claims["text_samples"].max()
    seen = claims["samples"].max()
    return "" if pd.isna(seen) else describe_samples(seen, theirs)
