"""LPIPS's trunk: each way to supply it, and one readable line for each way to fail."""

import functools
import hashlib
import pickle
from collections.abc import Iterator
from pathlib import Path

import pytest
import torch
import torchvision
from web_server import WebServer, nobody, serving

from neural_shadows.errors import InputError
from neural_shadows.files.download import fetch
from neural_shadows.files.whole_files import read_json
from neural_shadows.metrics import lpips_trunk
from neural_shadows.metrics.find_lpips import find_lpips
from neural_shadows.metrics.lpips_distance import Lpips
from neural_shadows.metrics.lpips_trunk import TRUNKS, Trunk, find_trunk


@pytest.fixture(scope="module")
def classifier() -> dict[str, torch.Tensor]:
    torch.manual_seed(3)
    return torchvision.models.squeezenet1_1(weights=None).state_dict()


@pytest.fixture
def features(classifier) -> dict[str, torch.Tensor]:
    prefix = "features."
    return {k[len(prefix) :]: v for k, v in classifier.items() if k.startswith(prefix)}


def saved(state: object, path: Path, **options: bool) -> Path:
    torch.save(state, path, **options)
    return path


def refusal(net: str, trunk: Path | None, cache: Path) -> str:
    """The message, which must be one line that says how to supply the trunk."""
    with pytest.raises(InputError) as caught:
        find_trunk(net, trunk, cache)
    message = str(caught.value)
    assert "\n" not in message
    assert "metrics.lpips.trunk" in message
    assert f"metrics.lpips.net to {net!r}" in message
    assert TRUNKS[net].file in message
    return message


def assert_same(found: dict[str, torch.Tensor], expected: dict[str, torch.Tensor]) -> None:
    assert found.keys() == expected.keys()
    assert all(torch.equal(found[key], expected[key]) for key in expected)


def test_published_files():
    """torchvision's names hold the first eight digits of the files' SHA-256."""
    for net, (file, digits) in {
        "alex": ("alexnet-owt-7be5be79.pth", "7be5be79"),
        "squeeze": ("squeezenet1_1-b8a52dc0.pth", "b8a52dc0"),
        "vgg": ("vgg16-397923af.pth", "397923af"),
    }.items():
        trunk = TRUNKS[net]
        assert trunk.url == f"https://download.pytorch.org/models/{file}" and trunk.file == file
        assert trunk.sha256.startswith(digits) and len(bytes.fromhex(trunk.sha256)) == 32


@pytest.mark.parametrize("zipped", [True, False], ids=["zip", "before-torch-1.6"])
def test_whole_classifier_and_features_alone_are_the_same(classifier, features, tmp_path, zipped):
    format = {"_use_new_zipfile_serialization": zipped}
    whole = saved(classifier, tmp_path / "whole.pth", **format)
    alone = saved(features, tmp_path / "features.pth", **format)
    assert_same(find_trunk("squeeze", whole, tmp_path), features)
    assert_same(find_trunk("squeeze", alone, tmp_path), features)


@pytest.fixture
def published(classifier, tmp_path, monkeypatch) -> Iterator[tuple[bytes, WebServer]]:
    """A file in the place of torchvision's for `squeeze`, and the server that has it."""
    content = saved(classifier, tmp_path / "whole.pth").read_bytes()
    with serving(tmp_path, monkeypatch) as server:
        server.files["/squeeze.pth"] = content
        trunk = Trunk(
            "squeezenet1_1", f"{server.url}/squeeze.pth", hashlib.sha256(content).hexdigest()
        )
        monkeypatch.setitem(TRUNKS, "squeeze", trunk)
        yield content, server


def test_download(published, features, tmp_path):
    _, server = published
    cache = tmp_path / "cache"
    for _ in range(2):  # the second time it is there
        assert_same(find_trunk("squeeze", None, cache), features)
    assert [path.name for path in cache.iterdir()] == ["squeeze.pth"]
    assert server.requests == ["/squeeze.pth"]


def test_another_file_in_the_cache_is_replaced(published, features, tmp_path):
    """One that was cut short, or is of the same shapes and not torchvision's."""
    content, server = published
    cached = tmp_path / "cache" / "squeeze.pth"
    cached.parent.mkdir()
    for wrong in (content[:-1000], content[:-1] + b"!"):
        cached.write_bytes(wrong)
        assert_same(find_trunk("squeeze", None, tmp_path / "cache"), features)
        assert cached.read_bytes() == content
    assert len(server.requests) == 2


def test_download_of_another_file(published, tmp_path):
    content, server = published
    server.files["/squeeze.pth"] = content[:-1] + b"!"
    assert "where" in refusal("squeeze", None, tmp_path / "cache")
    assert list((tmp_path / "cache").iterdir()) == []


def test_offline(tmp_path, monkeypatch):
    with nobody() as url:
        monkeypatch.setitem(TRUNKS, "alex", Trunk("alexnet", f"{url}/alexnet.pth", "0" * 64))
        monkeypatch.setattr(lpips_trunk, "fetch", functools.partial(fetch, backoff_s=0))
        assert "refused" in refusal("alex", None, tmp_path)
        monkeypatch.setenv("TORCH_HOME", str(tmp_path))
        with pytest.raises(InputError, match="metrics.lpips.trunk"):
            Lpips("alex", None)


def test_why_lpips_is_missing_names_no_folder(published, tmp_path, monkeypatch):
    """It is shown in reports, and the cache is in somebody's home."""
    _, server = published
    monkeypatch.setenv("TORCH_HOME", str(tmp_path / "home"))
    (tmp_path / "home").write_text("a file where the folder should be")

    def reason() -> str:
        find_lpips(tmp_path / "lpips.json", net="squeeze", trunk=None)
        found = read_json(tmp_path / "lpips.json")
        assert not found["available"]
        assert "squeeze.pth" in found["reason"] and str(tmp_path) not in found["reason"]
        return found["reason"]

    assert "squeeze.pth in torch's cache cannot be used: cannot write it: Not a dir" in reason()
    (tmp_path / "home").unlink()
    server.answers = [404]
    assert "404" in reason()
    server.answers = ["whole"]
    server.files["/squeeze.pth"] = b"no weights"
    digest = hashlib.sha256(b"no weights").hexdigest()
    monkeypatch.setitem(TRUNKS, "squeeze", TRUNKS["squeeze"]._replace(sha256=digest))
    assert "squeeze.pth in torch's cache cannot be used: it is not a whole PyTorch" in reason()


def test_cache_that_cannot_be_written(tmp_path):
    (tmp_path / "cache").write_text("a file where the folder should be")
    assert "cannot write" in refusal("alex", None, tmp_path / "cache")


def test_cache_is_that_of_torch(published, tmp_path, monkeypatch):
    monkeypatch.setenv("TORCH_HOME", str(tmp_path))
    Lpips("squeeze", None)
    assert (tmp_path / "hub" / "checkpoints" / "squeeze.pth").is_file()


def test_missing_file(tmp_path):
    message = refusal("squeeze", tmp_path / "absent.pth", tmp_path)
    assert "absent.pth" in message
    assert "No such file" in message


def test_broken_files(classifier, tmp_path):
    whole = saved(classifier, tmp_path / "whole.pth").read_bytes()
    for name, content in {
        "empty.pth": b"",
        "truncated.pth": whole[: len(whole) // 2],
        "page.pth": b"<html>403 Forbidden</html>",
        "garbage.pth": bytes(range(256)) * 40,
        "text.pth": b"weights of a network\n" * 100,
    }.items():
        (tmp_path / name).write_bytes(content)
        assert name in refusal("squeeze", tmp_path / name, tmp_path)


class Payload:
    """Makes the folder `path` when it is unpickled."""

    def __init__(self, path: Path) -> None:
        self.path = path

    def __reduce__(self):
        return Path.mkdir, (self.path,)


@pytest.mark.parametrize("zipped", [True, False, None])
def test_code_in_a_file_is_not_run(features, tmp_path, zipped):
    evidence = tmp_path / "executed"
    state = {**features, "0.weight": Payload(evidence)}
    path = tmp_path / "evil.pth"
    if zipped is None:
        path.write_bytes(pickle.dumps(state))
    else:
        saved(state, path, _use_new_zipfile_serialization=zipped)
    assert "evil.pth" in refusal("squeeze", path, tmp_path)
    assert not evidence.exists()

    pickle.loads(pickle.dumps(Payload(evidence)))
    assert evidence.exists()  # the payload does work where it is let


def test_no_state_dict(tmp_path):
    path = saved(torch.zeros(3), tmp_path / "tensor.pth")
    assert "Tensor" in refusal("squeeze", path, tmp_path)


def test_first_missing_key_is_named(features, tmp_path):
    del features["3.squeeze.weight"]
    message = refusal("squeeze", saved(features, tmp_path / "t.pth"), tmp_path)
    assert "t.pth" in message
    assert "'3.squeeze.weight'" in message


def test_wrong_shape_is_named(features, tmp_path):
    features["0.bias"] = torch.zeros(65)
    message = refusal("squeeze", saved(features, tmp_path / "t.pth"), tmp_path)
    assert "'0.bias'" in message
    assert "(65,)" in message
    assert "(64,)" in message


def test_trunk_of_another_network(classifier, tmp_path):
    path = saved(classifier, tmp_path / "squeeze.pth")
    assert "alexnet" in refusal("alex", path, tmp_path)
