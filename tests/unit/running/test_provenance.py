"""What made a report: in a table's files and in a figure's, the same."""

import hashlib
import json
from importlib import import_module
from types import SimpleNamespace
from xml.etree import ElementTree

import pandas as pd
import pytest
from PIL import Image

from neural_shadows.reports.data.table import Table, write_table
from neural_shadows.reports.drawing.style import new_figure, provenance_of, write_figure
from neural_shadows.reports.page.figure_blocks import figure_blocks
from neural_shadows.reports.page.table_blocks import table_block
from neural_shadows.running import provenance
from neural_shadows.running.origin import CHECKOUT, describe_origin

SCRIPT = "workflow/neural_shadows/reports/tables/comparison.py"
CLAIMS = "workflow/neural_shadows/reports/claims/write_claims.py"


@pytest.fixture
def job(monkeypatch, tmp_path):
    """A table's job, in a folder with its two inputs."""
    monkeypatch.chdir(tmp_path)
    for name in ("a.csv", "b.csv", "figure.png"):
        (tmp_path / name).write_text(name)
    named = {"metrics": ["b.csv", "a.csv"], "mesh": "a.csv", "beside": ["figure.png"]}
    job = SimpleNamespace(
        rule="table",
        input=named,
        params={
            "module": "neural_shadows.reports.tables.comparison",
            "settings": {"run": {"scale": "desk", "seed": 2026}},
        },
        wildcards={"table": "table_4_3"},
    )
    import_module(job.params["module"])
    monkeypatch.setattr(provenance, "JOB", job)
    main = SimpleNamespace(__file__=str(CHECKOUT / CLAIMS))
    monkeypatch.setitem(provenance.sys.modules, "__main__", main)
    return job


def test_a_job_s_provenance(job):
    record = provenance.describe_provenance()
    assert record["script"] == SCRIPT and record["section"] == "tables.table_4_3"
    assert record["seed"] == 2026
    # Each once, and without the figure, which is made along with the table.
    digests = {name: hashlib.sha256(name.encode()).hexdigest() for name in ("a.csv", "b.csv")}
    assert record["inputs"] == digests
    assert describe_origin().items() <= record.items()
    line = provenance.provenance_line(record)
    assert f"`{SCRIPT}`; section `tables.table_4_3`; 2 inputs, SHA-256 of their list `" in line
    assert f"seed 2026; commit {record['commit']}" in line and record["machine"]["cpu"] in line


def test_a_line_names_other_inputs_otherwise(job, tmp_path):
    before = provenance.provenance_line(provenance.describe_provenance())
    (tmp_path / "a.csv").write_text("edited")
    after = provenance.provenance_line(provenance.describe_provenance())
    assert before != after and before.split("`;")[0] == after.split("`;")[0]


def test_a_rule_without_wildcards_is_its_own_section(job):
    job.wildcards, job.rule, job.params = {}, "claims", {}
    record = provenance.describe_provenance()
    assert record["script"] == CLAIMS
    assert record["section"] == "claims" and record["seed"] is None
    assert "seed" not in provenance.provenance_line(record)


def test_outside_of_a_job_there_is_the_origin_alone():
    assert provenance.describe_provenance() == describe_origin()
    line = provenance.provenance_line(describe_origin())
    assert line.startswith("Made by commit ") and "input" not in line


def test_a_table_says_what_made_it(job, tmp_path):
    csv, md, json_file = (tmp_path / f"table.{ending}" for ending in ("csv", "md", "json"))
    write_table(Table(pd.DataFrame({"a": [1]}), {"a": ["1"]}, [], "A table"), csv, md, json_file)
    record = provenance.describe_provenance()
    assert json.loads(json_file.read_text())["provenance"] == record
    assert provenance.provenance_line(record) in md.read_text().splitlines()[-1]
    assert f"<code>{SCRIPT}</code>" in table_block(json_file, {}).made


def test_a_figure_says_what_made_it(job, tmp_path):
    png, svg = tmp_path / "figure.png", tmp_path / "figure.svg"
    write_figure(new_figure("A figure", 4, 3), png, svg)
    record = provenance.describe_provenance()
    assert provenance_of(png) == record
    described = ElementTree.parse(svg).find(".//{http://purl.org/dc/elements/1.1/}description")
    assert json.loads(described.text) == record
    (block,) = figure_blocks([svg, png], {}, {})
    assert f"<code>{SCRIPT}</code>" in block.made and "metadata" not in block.html


def test_a_figure_without_a_provenance_says_nothing(tmp_path):
    Image.new("L", (2, 2)).save(tmp_path / "figure.png")
    assert provenance_of(tmp_path / "figure.png") == provenance_of(tmp_path / "no.png") == {}
