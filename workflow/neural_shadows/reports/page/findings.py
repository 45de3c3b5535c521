"""What was found: questions, the verdicts of claims that answer them, and a picture each."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

from PIL import Image

from neural_shadows.reports.page.blocks import lossy_uri
from neural_shadows.reports.page.claim_cards import Card

SIZE = (480, 320)  # pixels of a picture: twice those it is shown in
QUALITY = 50


@dataclass(frozen=True)
class Finding:
    """A question and the claim that answers it.

    Args:
        figure, title: of the figure that shows it; picture: its upper part, an address within the
            page; all empty without the figure.
    """

    question: str
    card: Card
    figure: str = ""
    title: str = ""
    picture: str = ""


def findings(
    questions: Sequence[Mapping[str, str]],
    cards: Sequence[Card],
    figures: Sequence[Path],
    titles: Mapping[str, str],
) -> list[Finding]:
    """Findings whose claims were judged, in the order of `questions`.

    Args:
        questions: `claim`, `question` and `figure`, a name, or "".
        figures: `.svg` and `.png` of each that is there; titles: by name.
    """
    judged = {card.name: card for card in cards}
    drawn = {path.stem: path for path in figures if path.suffix == ".png"}
    return [
        _finding(one["question"], judged[one["claim"]], drawn.get(one["figure"]), titles)
        for one in questions
        if one["claim"] in judged
    ]


def _finding(question: str, card: Card, png: Path | None, titles: Mapping[str, str]) -> Finding:
    if png is None:
        return Finding(question, card)
    with Image.open(png) as image:
        picture = image.convert("RGB")
    width, height = SIZE
    picture.thumbnail((width, picture.height))
    part = picture.crop((0, 0, picture.width, min(picture.height, height)))
    title = titles.get(png.stem, png.stem)
    return Finding(question, card, png.stem, title, lossy_uri(part, QUALITY))
