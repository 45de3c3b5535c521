"""LPIPS's trunk: each way to supply it, and one readable line for each way to fail."""

import functools
import http.server
import pickle
import threading
from collections.abc import Iterator
from pathlib import Path

import pytest
import torch
import torchvision

from neural_shadows import lpips_trunk
from neural_shadows.download import fetch
from neural_shadows.errors import InputError
from neural_shadows.files import sha256_of
from neural_shadows.lpips_trunk import TRUNKS, Trunk, find_trunk
from neural_shadows.metrics import Lpips


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
    assert {net: (trunk.file, trunk.sha256) for net, trunk in TRUNKS.items()} == {
        "alex": ("alexnet-owt-7be5be79.pth", "7be5be79"),
        "squeeze": ("squeezenet1_1-b8a52dc0.pth", "b8a52dc0"),
        "vgg": ("vgg16-397923af.pth", "397923af"),
    }


@pytest.mark.parametrize("zipped", [True, False], ids=["zip", "before-torch-1.6"])
def test_whole_classifier_and_features_alone_are_the_same(classifier, features, tmp_path, zipped):
    format = {"_use_new_zipfile_serialization": zipped}
    whole = saved(classifier, tmp_path / "whole.pth", **format)
    alone = saved(features, tmp_path / "features.pth", **format)
    assert_same(find_trunk("squeeze", whole, tmp_path), features)
    assert_same(find_trunk("squeeze", alone, tmp_path), features)


def test_cached_file_is_not_fetched_again(classifier, features, tmp_path, monkeypatch):
    def fetch(*_, **__):
        raise AssertionError("fetched although it is there")

    monkeypatch.setattr(lpips_trunk, "fetch", fetch)
    saved(classifier, tmp_path / "squeezenet1_1-b8a52dc0.pth")
    assert_same(find_trunk("squeeze", None, tmp_path), features)


@pytest.fixture
def server(tmp_path) -> Iterator[str]:
    class Quiet(http.server.SimpleHTTPRequestHandler):
        def log_message(self, *_):
            pass

    folder = tmp_path / "served"
    folder.mkdir()
    handler = functools.partial(Quiet, directory=folder)
    with http.server.ThreadingHTTPServer(("127.0.0.1", 0), handler) as httpd:
        thread = threading.Thread(target=httpd.serve_forever)
        thread.start()
        yield f"http://127.0.0.1:{httpd.server_port}"
        httpd.shutdown()
        thread.join()


def test_download(classifier, features, tmp_path, monkeypatch, server):
    whole = saved(classifier, tmp_path / "served" / "whole.pth")
    name = f"squeezenet1_1-{sha256_of(whole)[:8]}.pth"
    whole.rename(tmp_path / "served" / name)
    monkeypatch.setitem(TRUNKS, "squeeze", Trunk("squeezenet1_1", f"{server}/{name}"))
    cache = tmp_path / "cache"
    assert_same(find_trunk("squeeze", None, cache), features)
    assert [path.name for path in cache.iterdir()] == [name]


def test_download_of_another_file(classifier, tmp_path, monkeypatch, server):
    saved(classifier, tmp_path / "served" / "squeezenet1_1-00000000.pth")
    trunk = Trunk("squeezenet1_1", f"{server}/squeezenet1_1-00000000.pth")
    monkeypatch.setitem(TRUNKS, "squeeze", trunk)
    refusal("squeeze", None, tmp_path / "cache")


def test_offline(tmp_path, monkeypatch):
    # Port 9 of this machine: nobody listens, as behind a firewall that refuses.
    trunk = Trunk("alexnet", "http://127.0.0.1:9/alexnet-owt-7be5be79.pth")
    monkeypatch.setitem(TRUNKS, "alex", trunk)
    monkeypatch.setattr(lpips_trunk, "fetch", functools.partial(fetch, backoff_s=0))
    refusal("alex", None, tmp_path)
    monkeypatch.setenv("TORCH_HOME", str(tmp_path))
    with pytest.raises(InputError, match="metrics.lpips.trunk"):
        Lpips("alex", None)


def test_cache_that_cannot_be_written(tmp_path):
    (tmp_path / "cache").write_text("a file where the folder should be")
    assert "cannot write" in refusal("alex", None, tmp_path / "cache")


def test_cache_is_that_of_torch(classifier, tmp_path, monkeypatch):
    monkeypatch.setenv("TORCH_HOME", str(tmp_path))
    folder = tmp_path / "hub" / "checkpoints"
    folder.mkdir(parents=True)
    saved(classifier, folder / "squeezenet1_1-b8a52dc0.pth")
    Lpips("squeeze", None)


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
