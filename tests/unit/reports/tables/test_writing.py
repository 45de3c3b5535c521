"""What is free text in the configuration stays one cell of a table."""

import pandas as pd

from neural_shadows.reports.data.table import Table, number_cells, numbers, write_table
from neural_shadows.reports.page.table_blocks import table_block


def test_a_bar_or_a_line_s_end_in_a_label_shifts_no_cell(tmp_path):
    columns = {
        "method": ["width 8|16", "plain\nand more"],
        "PSNR ↑": numbers([30, 5], "{:.1f}"),
        "a|b": ["1", "2"],
    }
    csv, md, json = (tmp_path / f"table.{ending}" for ending in ("csv", "md", "json"))
    write_table(Table(pd.DataFrame({"a": [1]}), columns, ["A note."], "A table"), csv, md, json)
    rows = [line for line in md.read_text().splitlines() if line.startswith("|")]
    assert [line.replace("\\|", "").count("|") for line in rows] == [4] * 4
    (part,) = table_block(json, {}).parts
    assert part.heads == ["method", "PSNR ↑", "a|b"]
    assert [[cell.text for cell in row] for row in part.rows] == [
        ["width 8|16", "30.0", "1"],
        ["plain\nand more", "5.0", "2"],
    ]
    assert [row[1].best for row in part.rows] == [True, False]


def test_cells_by_a_format_and_by_a_function():
    assert number_cells([1.5, float("nan")], "{:.2f}") == ["1.50", ""]
    assert number_cells([2.0], str, 10) == ["20.0"]
    # What is rounded to 0 has no sign.
    assert number_cells([-0.001, 0.2, -2], "{:+.1f} dB") == ["+0.0 dB", "+0.2 dB", "-2.0 dB"]
