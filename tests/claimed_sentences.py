"""Sentences on soft shadows in our texts, and the verdicts of the claims that they name.

A sentence names its claims in a comment behind it: `<!-- claim: NAME VERDICT, NAME VERDICT -->`.
"""

import csv
import re
from collections.abc import Iterable, Iterator, Mapping
from pathlib import Path

DECIDED = ("supported", "contradicted")
PARTS = ("Soft shadows", "Datta et al. 2022")  # how their headings begin
# What a sentence is about that is in no such part, as in the README.
SUBJECTS = re.compile(
    r"soft shadow|penumbra|PCSS|\bE?VSM|MSM|moments|SVGF|denois|\bOIDN|perturbation|kernels?\b"
    r"|Neural Shadow Map|\bK?P?NSM\b|(rays?|samples) a pixel",
    re.I,
)
DIRECTIONS = re.compile(
    r"\b(better|best|worse|worst|ahead|behind|beats?|beaten|outperforms?|wins?|loses?|less|fewer|more"
    r"|below|above|lower|higher|smaller|larger|faster|slower|exceeds?|surpass\w*|superior|inferior|helps?"
    r"|halves|doubles|costs? (nothing|little)|level with|as good as|nearer|calms?|calmer|sharpens?"
    r"|carries over|reaches|worth|times (as|the) (much|many|fast|error)|half (of )?the error)\b",
    re.I,
)
COMMENT = re.compile(r"\s*<!--\s*claim:(.*?)-->", re.S)
MARK = "\N{SECTION SIGN}"  # stands for a comment while sentences are split
END = re.compile(rf"(?<=[.!?])\**(?:\s*{MARK}\d+)*\s+(?!{MARK})(?=[A-Z0-9*\[`(])")
ABBREVIATED = re.compile(r"\b(et al|e\.g|i\.e|vs|cf)\.")


def read_claims(paths: Iterable[Path], column: str = "verdict") -> dict[str, set[str]]:
    """Of each claim in files of claims its verdicts, or another column; also by `FOLDER/claim`."""
    found: dict[str, set[str]] = {}
    for path in paths:
        with path.open(encoding="utf-8", newline="") as file:
            for row in csv.DictReader(file):
                for name in (row["claim"], f"{path.parent.name}/{row['claim']}"):
                    found.setdefault(name, set()).add(row[column])
    return found


def mistakes(text: str, verdicts: Mapping[str, set[str]]) -> list[str]:
    """What is wrong with sentences of a Markdown text, one line each."""
    found = []
    for sentence, claims, in_part in sentences(text):
        wrong = [fault for claim in claims for fault in _of_claim(sentence, claim, verdicts)]
        stated = _states(sentence) if in_part else _directed(sentence)
        if stated and not claims:
            wrong.append("states a direction and names no claim")
        found += [f"{fault}: {sentence}" for fault in wrong]
    return found


def sentences(text: str) -> Iterator[tuple[str, list[tuple[str, str]], bool]]:
    """Sentences of prose, the (name, verdict) of the claims that each names, and whether it stands in
    one of `PARTS`.
    """
    part = ""
    for block in re.split(r"\n\s*\n|\n(?=- |#)", re.sub(r"```.*?```", "", text, flags=re.S)):
        block = block.strip()
        if block.startswith("#"):
            part = block.splitlines()[0].strip("# ")
            block = "\n".join(block.splitlines()[1:])
        if block.startswith(("|", "![")):
            continue
        named: list[str] = []

        def marked(comment: re.Match, named: list[str] = named) -> str:
            named.append(comment[1])
            return f" {MARK}{len(named) - 1}"

        block = re.sub(r"<!--.*?-->", "", COMMENT.sub(marked, block), flags=re.S)
        block = ABBREVIATED.sub(r"\1", " ".join(block.split()))
        for sentence in _split(block):
            numbers = re.findall(rf"{MARK}(\d+)", sentence)
            claims = [one for number in numbers for one in _claims(named[int(number)])]
            plain = re.sub(rf"\s*{MARK}\d+", "", sentence).strip("- ")
            yield plain, claims, part.startswith(PARTS)


def _split(block: str) -> Iterator[str]:
    start = 0
    for end in END.finditer(block):
        yield block[start : end.end()]
        start = end.end()
    yield block[start:]


def _claims(comment: str) -> list[tuple[str, str]]:
    return [tuple(one.strip().partition(" ")[::2]) for one in comment.split(",") if one.strip()]


def _states(sentence: str) -> bool:
    """Whether a sentence concludes: it has a direction, or is bold."""
    return bool("**" in sentence or DIRECTIONS.search(sentence))


def _directed(sentence: str) -> bool:
    return bool(SUBJECTS.search(sentence) and DIRECTIONS.search(sentence))


def _of_claim(
    sentence: str, claim: tuple[str, str], verdicts: Mapping[str, set[str]]
) -> Iterator[str]:
    name, stated = claim
    if name not in verdicts:
        yield f"{name}: is no claim of the reference"
    elif verdicts[name] != {stated}:
        yield f"{name}: is {' and '.join(sorted(verdicts[name]))}, and not {stated or 'without verdict'}"
    elif stated == "contradicted" and "contradict" not in sentence:
        yield f"{name}: is contradicted, and the sentence does not say so"
    elif stated not in DECIDED and not re.search(r"decided|comparable|vacuous|learned", sentence):
        yield f"{name}: is {stated}, and the sentence does not say so"
