"""The dragon's archive: a tiny one in its place, from a local server."""

import hashlib
import io
import tarfile

import pytest
from served import served

from neural_shadows.errors import InputError
from neural_shadows.meshes import stanford_dragon
from neural_shadows.meshes.get_mesh import get_mesh

DRAGON = {"download": "stanford_dragon"}
MESH = b"ply\n(not a real one)\n" * 1000


def archive() -> bytes:
    file = io.BytesIO()
    with tarfile.open(fileobj=file, mode="w:gz") as tar:
        for name, content in (("dragon_recon/README", b"about"), (stanford_dragon.MEMBER, MESH)):
            info = tarfile.TarInfo(name)
            info.size = len(content)
            tar.addfile(info, io.BytesIO(content))
    return file.getvalue()


WHOLE = archive()


@pytest.fixture
def serve(monkeypatch, tmp_path_factory):
    """A function: let a local server have an archive in the place of the published one."""
    folder = tmp_path_factory.mktemp("served")
    with served(folder) as address:

        def serve(content):
            (folder / "dragon.tar.gz").write_bytes(content)
            url = f"{address}dragon.tar.gz"
            digests = [hashlib.sha256(part).hexdigest() for part in (WHOLE, MESH)]
            for name, value in zip(("URL", "ARCHIVE_SHA256", "DRAGON_SHA256"), (url, *digests)):
                monkeypatch.setattr(stanford_dragon, name, value)

        yield serve


def test_the_one_mesh_is_taken_out_of_the_archive(serve, tmp_path):
    serve(WHOLE)
    target = tmp_path / "out" / "source.ply"
    get_mesh(target, DRAGON)
    assert target.read_bytes() == MESH
    assert list(target.parent.iterdir()) == [target]


def test_anything_else_is_refused_with_what_to_do(serve, tmp_path, monkeypatch):
    serve(WHOLE[:50])
    for reason in ("does not match the known hash", "refused"):
        with pytest.raises(InputError, match=f"cannot download http.*{reason}") as caught:
            get_mesh(tmp_path / "source.ply", DRAGON)
        assert "`--config dragon=PATH/TO/dragon_vrip_res2.ply`" in str(caught.value)
        assert list(tmp_path.iterdir()) == []
        monkeypatch.setattr(stanford_dragon, "URL", "http://127.0.0.1:9/dragon.tar.gz")
