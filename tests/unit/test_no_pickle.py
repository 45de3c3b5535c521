"""Nothing that is loaded can run code: no pickle from results, cache or network."""

import ast
from pathlib import Path

import pytest
import yaml

from neural_shadows.config import reading

WORKFLOW = Path(__file__).parents[2] / "workflow"

# Modules that unpickle, or read what may hold pickles.
FORBIDDEN = {"pickle", "_pickle", "marshal", "shelve", "dill", "cloudpickle", "joblib", "dbm"}

# What calls must say, by the function.
SAID = {
    "np.load": "allow_pickle=False",
    "torch.load": "weights_only=True",
    "yaml.load": "_NoDuplicates",
}


def problems_of(source: str) -> list[str]:
    """Imports and calls in a module that unpickle, or run what they are given."""
    found = []
    for node in ast.walk(ast.parse(source)):
        if isinstance(node, ast.Import):
            found += [name.name for name in node.names if name.name in FORBIDDEN]
        elif isinstance(node, ast.ImportFrom) and node.module in FORBIDDEN:
            found.append(node.module)
        elif isinstance(node, ast.Call):
            name = ast.unparse(node.func)
            arguments = [ast.unparse(argument) for argument in (*node.args, *node.keywords)]
            # A network is put into evaluation by `.eval()`, which takes no argument.
            runs = name.rpartition(".")[2] in ("eval", "exec", "read_pickle") and arguments
            if runs or (name in SAID and SAID[name] not in arguments):
                found.append(name)
    return found


def test_nothing_unpickles():
    modules = {path: problems_of(path.read_text("utf-8")) for path in WORKFLOW.rglob("*.py")}
    assert {path: problems for path, problems in modules.items() if problems} == {}
    safe = (yaml.SafeLoader, getattr(yaml, "CSafeLoader", yaml.SafeLoader))
    assert issubclass(reading._NoDuplicates, safe)


@pytest.mark.parametrize(
    "source",
    [
        "import pickle",
        "from pickle import loads",
        "np.load(path, allow_pickle=True)",
        "torch.load(path)",
        "yaml.load(file, yaml.Loader)",
        "pd.read_pickle(path)",
        "eval(text)",
    ],
)
def test_the_check_finds_what_unpickles(source):
    assert problems_of(source)
