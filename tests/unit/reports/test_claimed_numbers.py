"""Tables of the README and of the reference have the numbers of their CSVs."""

from pathlib import Path

import pytest
from claimed_numbers import MARK, miscounts, mistakes, said, unmarked

ROOT = Path(__file__).parents[3]
REFERENCE = ROOT / "reports/reference"
TEXTS = [ROOT / "README.md", *sorted(REFERENCE.glob("**/README.md"))]
CSV = "method,label,mse,ms,bytes\nmap,Map of 512²,0.0232,11.04,1048576\npcss,PCSS,0.00246,92.7,0\n"
TABLE = """<!-- numbers: some.csv -->

| | error | ms | KiB |
| --- | --- | --- | --- |
| map | 232 | 11 | 1,024 |
| PCSS | 24.6 | 92.7 | 0 |
"""


@pytest.mark.parametrize("text", TEXTS, ids=lambda text: str(text.relative_to(ROOT)))
def test_tables_have_the_numbers_of_their_files(text):
    content = text.read_text(encoding="utf-8")
    folder = REFERENCE if text.parent == ROOT else text.parent
    assert len(MARK.findall(content)) >= 2
    assert text.parent != REFERENCE or [*said(content)]
    assert mistakes(content, folder) == []
    assert miscounts(content, folder) == []
    assert unmarked(content) == []


@pytest.mark.parametrize(
    "wrong", [("232", "233"), ("11 |", "12 |"), ("| 92.7", "| 11.0"), ("24.6", "232")]
)
def test_another_number_or_another_method_s_is_a_mistake(tmp_path, wrong):
    (tmp_path / "some.csv").write_text(CSV)
    assert mistakes(TABLE, tmp_path) == []
    (fault,) = mistakes(TABLE.replace(*wrong), tmp_path)
    assert "no method has all numbers of" in fault


def test_methods_side_by_side(tmp_path):
    (tmp_path / "some.csv").write_text(CSV)
    table = "<!-- numbers by column: some.csv -->\n\n| | map | PCSS |\n|---|---|---|\n| error | 232 | 24.6 |\n| ms | 11 | 93 |\n"
    assert mistakes(table, tmp_path) == []
    assert len(mistakes(table.replace("93", "94"), tmp_path)) == 1
    pair = "<!-- numbers: of 2: some.csv -->\n\n| | map | PCSS |\n|---|---|---|\n| error | 232 | 24.6 |\n"
    assert mistakes(pair, tmp_path) == []
    assert len(mistakes(pair.replace("of 2: ", ""), tmp_path)) == 1


def test_marked_sentences(tmp_path):
    """Targets of links, other comments, other items and what another mark is on are left out."""
    (tmp_path / "some.csv").write_text(CSV)
    text = """\
Of 99 views.

- Of 98 views a map of 512² has 231.
  - [**PCSS has 24.6**](a_8.csv) in 92.7 ms. <!-- claim: a_9 b --> <!-- numbers: some.csv --> It took
    3 s; the map errs by 232, PCSS by 24.6. <!-- numbers: of 2: some.csv -->
"""
    (fault,) = mistakes(text, tmp_path)
    assert fault.startswith(
        "some.csv: no method has all numbers of It took 3 s; the map errs by 232"
    )
    assert mistakes(text.replace("3 s", "11 ms"), tmp_path) == []
    assert len(mistakes(text.replace("92.7", "93.7"), tmp_path)) == 2
    assert (
        len(mistakes(text.replace("PCSS by 24.6. <!-- numbers: of 2", "<!-- numbers"), tmp_path))
        == 1
    )


def test_verdicts_are_counted_by_text(tmp_path):
    rows = [
        "a,nsm,ratio,supported",
        "b,nsm,better,undecided (scale)",
        "c,nsm,printed,supported",
        "d,own,ratio,supported",
    ]
    head = "claim,text,kind,verdict"
    (tmp_path / "claims.csv").write_text("\n".join([head, *rows]))
    (tmp_path / "newer.csv").write_text("\n".join([head, "b,nsm,better,supported"]))
    table = "<!-- verdicts: claims.csv -->\n| | all | supported |\n|---|---|---|\n| Datta et al. 2022 | 2 | 1 |\n"
    assert miscounts(table, tmp_path) == []
    more = table.replace("| 1 |", "| 2 |")
    (fault,) = miscounts(more, tmp_path)
    assert "Datta et al. 2022" in fault
    assert miscounts(more.replace("claims.csv", "claims.csv newer.csv"), tmp_path) == []


def test_a_measured_number_without_a_file_is_found():
    text = "A map takes 11 ms. <!-- numbers: some.csv --> Of 512 texels.\n\n- PCSS has 24.6 dB.\n"
    assert unmarked(text) == ["- PCSS has 24.6 dB."]
