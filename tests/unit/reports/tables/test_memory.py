from report_samples import row, written_table

from neural_shadows.reports.tables.memory import table as make_table

METHODS = ("shadow_map_128", "dragon", "shadow_map_512")


def test_table_agrees_with_the_thesis_to_its_last_printed_digit(tmp_path):
    rows = [row(name, published="network" if name == "dragon" else name) for name in METHODS]
    table, md = written_table(make_table, tmp_path, rows=rows, published="4.7")
    assert table["method"].tolist() == ["dragon", "shadow_map_512", "shadow_map_128"]
    assert table["bytes"].tolist() == [2_227_200, 4 * 512**2, 4 * 128**2]
    assert table["thesis_memory_mib"].tolist() == [2.12, 1, 0.0625]
    assert table["memory_mib_minus_thesis"].abs().max() < 0.005
    assert "2,227,200" in md.read_text()
