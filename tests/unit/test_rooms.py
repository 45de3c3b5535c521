"""A room of the package imports only those before it; pyproject.toml has their order."""

from pathlib import Path

from importlinter.cli import EXIT_STATUS_SUCCESS, lint_imports

PROJECT = Path(__file__).parents[2] / "pyproject.toml"


def test_rooms_import_only_those_before_them(capsys):
    status = lint_imports(str(PROJECT), no_cache=True)
    assert status == EXIT_STATUS_SUCCESS, capsys.readouterr().out
