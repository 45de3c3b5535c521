import pytest

from neural_shadows.reports.data import run_command


@pytest.mark.parametrize(
    ("command", "published"),
    [
        ("snakemake --cores 2 reports/table_4_3.csv", None),
        ("snakemake --config dragon=/home/me/a/x.ply up=z", "snakemake --config dragon=x.ply up=z"),
        ("snakemake '--config dragon=/home/me/x.ply'", "snakemake '--config dragon=x.ply'"),
        ("snakemake --configfile ../mine.yaml", None),
        ("x=https://me:password@example.org/x.ply", "x=https://example.org/x.ply"),
    ],
)
def test_a_command_names_no_folder_and_no_password(command, published, monkeypatch):
    monkeypatch.setenv(run_command.VARIABLE, command)
    assert run_command.run_command() == (published or command)
