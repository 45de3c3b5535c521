"""Texts lead where they say, and stay short enough to be read."""

import re
from pathlib import Path

import pytest
from checkout import ROOT
from claimed_numbers import MARK

TEXTS = sorted(
    path
    for pattern in (
        "*.md",
        "*/*.md",
        "workflow/*/**/*.md",
        "reports/reference/**/*.md",
    )
    for path in ROOT.glob(pattern)
    if not path.relative_to(ROOT).parts[0].startswith(".")
    and (path.parent != ROOT / "reports" or path.stem == "README")  # what a run made
)
LINK = re.compile(r"(!?)\[((?:[^\]\[]|\[[^\]]*\])*)\]\(([^)\s]+)\)")
GITHUB = "../../issues/"  # from where GitHub shows a text


def anchors(text: str) -> set[str]:
    """Anchors of a Markdown text's headings, as GitHub makes them."""
    headings = re.findall(r"^#+ +(.+)$", re.sub(r"```.*?```", "", text, flags=re.S), re.M)
    return {re.sub(r"[^\w\- ]", "", one.lower()).strip().replace(" ", "-") for one in headings}


def dead_links(path: Path) -> list[str]:
    """Links of a Markdown text to no file or heading, and pictures without a text."""
    text = path.read_text(encoding="utf-8")
    found = []
    for picture, words, target in LINK.findall(re.sub(r"```.*?```", "", text, flags=re.S)):
        if picture and not words.strip():
            found.append(f"{target}: a picture without a text")
        if re.match(r"\w+:", target) or target.startswith(GITHUB):
            continue
        name, _, anchor = target.partition("#")
        file = path.parent / name if name else path
        if not file.exists():
            found.append(f"{target}: no such file")
        elif anchor and anchor not in anchors(file.read_text(encoding="utf-8")):
            found.append(f"{target}: no such heading")
    return found


def test_texts_are_found():
    assert {"README.md", "config/README.md", "reports/reference/README.md"} <= {
        str(path.relative_to(ROOT)) for path in TEXTS
    }


@pytest.mark.parametrize("path", TEXTS, ids=lambda path: str(path.relative_to(ROOT)))
def test_links_lead_somewhere(path):
    assert dead_links(path) == []


def test_a_dead_link_is_found(tmp_path):
    (tmp_path / "other.md").write_text("# A heading, of two\n")
    path = tmp_path / "text.md"
    path.write_text(
        "[a](other.md#a-heading-of-two) [b](other.md#b) [c](gone.md) ![](other.md) [d](#d)"
    )
    assert [line.partition(":")[0] for line in dead_links(path)] == [
        "other.md#b",
        "gone.md",
        "other.md",
        "#d",
    ]


@pytest.mark.parametrize(
    "page",
    sorted((ROOT / "reports/reference").glob("**/index.html")),
    ids=lambda page: page.parent.name,
)
def test_a_page_is_small_and_its_links_lead_somewhere(page):
    assert page.stat().st_size < 10e6
    html = page.read_text(encoding="utf-8")
    ids = set(re.findall(r'\bid="([^"]+)"', html))
    links = set(re.findall(r'<a [^>]*?href="([^"]+)"', html))
    assert {link[1:] for link in links if link.startswith("#")} <= ids
    files = {link for link in links if not re.match(r"#|\w+:", link)}
    assert [file for file in files if not (page.parent / file).exists()] == []


def test_the_readme_has_120_lines_at_most():
    assert len((ROOT / "README.md").read_text(encoding="utf-8").splitlines()) <= 120


def test_of_each_question_the_reference_has_eight_rows_and_five_findings_at_most():
    """What a newcomer reads; all else is in the folders' own tables."""
    text = (ROOT / "reports/reference/README.md").read_text(encoding="utf-8")
    parts = dict(part.split("\n", 1) for part in text.split("\n## ")[1:])
    questions = {name: body for name, body in parts.items() if MARK.search(body)}
    assert len(questions) == 6
    for name, body in questions.items():
        rows = re.findall(r"^\|(?! \|| ---)", body, re.M)
        findings = re.findall(r"^- ", body, re.M)
        assert (name, len(rows) <= 8, len(findings) <= 5) == (name, True, True)
