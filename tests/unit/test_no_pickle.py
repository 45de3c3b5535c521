"""Nothing that is loaded can run code: no pickle from results, cache or network."""

import ast
from pathlib import Path

import pytest

WORKFLOW = Path(__file__).parents[2] / "workflow"
MODULES = sorted(WORKFLOW.rglob("*.py"))

# Modules that unpickle, or read what may hold pickles.
FORBIDDEN = {"pickle", "_pickle", "marshal", "shelve", "dill", "cloudpickle", "joblib", "dbm"}


def has(call: ast.Call, name: str, value: bool) -> bool:
    return any(
        word.arg == name and isinstance(word.value, ast.Constant) and word.value.value is value
        for word in call.keywords
    )


def problems_of(source: str) -> list[str]:
    """Imports and calls in a module that unpickle, or run what they are given."""
    tree = ast.parse(source)
    found = []
    for node in ast.walk(tree):
        names = []
        if isinstance(node, ast.Import):
            names = [alias.name for alias in node.names]
        elif isinstance(node, ast.ImportFrom):
            names = [node.module or ""]
        found += [name for name in names if name.split(".")[0] in FORBIDDEN]
    for call in (node for node in ast.walk(tree) if isinstance(node, ast.Call)):
        name = ast.unparse(call.func)
        last = name.rpartition(".")[2]
        if last in ("eval", "exec", "read_pickle", "unsafe_load", "full_load"):
            # A network is put into evaluation by `.eval()`, which takes no argument.
            if call.args or last != "eval":
                found.append(name)
        elif name in ("np.load", "numpy.load") and not has(call, "allow_pickle", False):
            found.append(name)
        elif name == "torch.load" and not has(call, "weights_only", True):
            found.append(name)
        elif name == "yaml.load" and ast.unparse(call.args[1]) not in ("_NoDuplicates",):
            found.append(name)
    return found


@pytest.mark.parametrize("module", MODULES, ids=lambda path: path.stem)
def test_nothing_unpickles(module):
    assert problems_of(module.read_text(encoding="utf-8")) == []


@pytest.mark.parametrize(
    "source",
    [
        "import pickle",
        "from pickle import loads",
        "import numpy as np\nnp.load(path)",
        "np.load(path, allow_pickle=True)",
        "torch.load(path)",
        "torch.load(path, weights_only=False)",
        "yaml.load(file, yaml.Loader)",
        "pd.read_pickle(path)",
        "eval(text)",
    ],
)
def test_the_check_finds_what_unpickles(source):
    assert problems_of(source)


def test_the_yaml_loader_is_a_safe_one():
    import yaml

    from neural_shadows.config import whole as config

    assert issubclass(config._NoDuplicates, yaml.SafeLoader)
