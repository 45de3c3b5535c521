"""What is free text in the configuration stays one cell of a table."""

import pandas as pd

from neural_shadows.reports.page_tables import table_block
from neural_shadows.reports.tables.writing import number_cells, write_twins


def test_a_bar_or_a_line_s_end_in_a_label_shifts_no_cell(tmp_path):
    columns = {
        "method": ["width 8|16", "plain\nand more"],
        "PSNR ↑": ["30.0", "5.0"],
        "a|b": ["1", "2"],
    }
    files = tmp_path / "table.csv", tmp_path / "table.md"
    write_twins(pd.DataFrame({"a": [1]}), columns, *files, title="A table", notes=["A note."])
    (part,) = table_block(files[1], {}).parts
    assert part.heads == ["method", "PSNR ↑", "a|b"]
    assert [[cell.text for cell in row] for row in part.rows] == [
        ["width 8|16", "30.0", "1"],
        ["plain; and more", "5.0", "2"],
    ]
    assert [row[1].best for row in part.rows] == [True, False]


def test_cells_by_a_format_and_by_a_function():
    assert number_cells([1.5, float("nan")], "{:.2f}") == ["1.50", ""]
    assert number_cells([2.0], str, 10) == ["20.0"]
