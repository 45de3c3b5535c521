import pandas as pd
import pytest

from neural_shadows.files.csv_file import read_csv

KINDS = {"view": "int64", "name": "str", "value": "float64"}
TEXT = "view,name,value\n1,a,0.5\n2,,1e-3\n"


def refused(path, text, reason, **options):
    path.write_bytes(text if isinstance(text, bytes) else text.encode())
    with pytest.raises(ValueError, match=reason) as caught:
        read_csv(path, KINDS, **options)
    assert "\n" not in str(caught.value)


def test_whole_files(tmp_path):
    path = tmp_path / "a.csv"
    for text in TEXT, TEXT.replace("\n", "\r\n"), TEXT.replace(",", "\t"):
        path.write_bytes(text.encode())
        found = read_csv(path, KINDS, separator="\t" if "\t" in text else ",")
        assert found["view"].tolist() == [1, 2] and found["value"].tolist() == [0.5, 1e-3]
        assert found["name"][0] == "a" and pd.isna(found["name"][1])
    path.write_text("more,value,view,name\nx,0.5,1,a\n")
    assert read_csv(path, KINDS, others=True)["view"].tolist() == [1]


@pytest.mark.parametrize(
    ("text", "reason"),
    [
        ("", "no column view"),
        (TEXT[:-1], "cut short"),
        (TEXT.replace("value", "Value"), "no column value"),
        (TEXT.replace("view,name", "name,view"), "columns are not view,name,value"),
        (TEXT.replace("\n", ",more\n", 1), "columns are not"),
        (TEXT.replace("name", "view"), "3 columns, 2 different"),
        ("a," * 100_000 + "b\n", "100,001 columns"),
        (TEXT.replace("1,a", "one,a"), "one"),
        (TEXT.replace("1,a", f"{2**70},a"), "."),
        (TEXT + "1\n" + "1,a,0.5,7\n", "."),
        (TEXT.encode() + b"3,\xe4,1\n", "utf-8"),
    ],
)
def test_reasons(tmp_path, text, reason):
    refused(tmp_path / "a.csv", text, reason)


def test_files_that_cannot_be_read(tmp_path):
    with pytest.raises(FileNotFoundError):
        read_csv(tmp_path / "none.csv", KINDS)
    with pytest.raises(OSError):
        read_csv(tmp_path, KINDS)
