"""The dragon's archive: a tiny one in its place, from a local server."""

import gc
import hashlib
import io
import tarfile
import threading
from http.server import BaseHTTPRequestHandler, ThreadingHTTPServer

import pytest

from neural_shadows.errors import InputError
from neural_shadows.meshes import download_mesh as stage
from neural_shadows.meshes.download_mesh import download_mesh

MESH = b"ply\n(not a real one)\n" * 1000


def archive(**members: bytes) -> bytes:
    file = io.BytesIO()
    with tarfile.open(fileobj=file, mode="w:gz") as tar:
        for name, content in members.items():
            info = tarfile.TarInfo(name)
            info.size = len(content)
            tar.addfile(info, io.BytesIO(content))
    return file.getvalue()


@pytest.fixture
def serve(monkeypatch):
    """Let a local server have an archive in the place of the published one."""

    class Handler(BaseHTTPRequestHandler):
        def do_GET(self):
            if self.content is None:
                return self.send_error(503)
            self.send_response(200)
            self.send_header("Content-Length", str(len(self.content)))
            self.end_headers()
            self.wfile.write(self.content[: self.sent])

        def log_message(self, *_):
            pass

    with ThreadingHTTPServer(("127.0.0.1", 0), Handler) as server:
        threading.Thread(target=server.serve_forever, args=(0.01,)).start()

        def serve(content, mesh=MESH, sent=None):
            Handler.content, Handler.sent = content, sent
            url = f"http://127.0.0.1:{server.server_port}/dragon_recon.tar.gz"
            monkeypatch.setattr(stage, "URL", url)
            monkeypatch.setattr(stage, "DRAGON_SHA256", hashlib.sha256(mesh).hexdigest())
            digest = hashlib.sha256(content or b"").hexdigest()
            monkeypatch.setattr(stage, "ARCHIVE_SHA256", digest)

        yield serve
        server.shutdown()


def test_the_one_mesh_is_taken_out_of_the_archive(serve, tmp_path):
    serve(archive(**{"dragon_recon/README": b"about", stage.MEMBER: MESH}))
    target = tmp_path / "out" / "downloaded.ply"
    download_mesh(target)
    assert target.read_bytes() == MESH
    assert list(target.parent.iterdir()) == [target]


WHOLE = archive(**{stage.MEMBER: MESH})


# requests leaves the socket of a cut answer to the garbage collector.
@pytest.mark.filterwarnings("ignore::pytest.PytestUnraisableExceptionWarning")
@pytest.mark.parametrize(
    ("options", "reason"),
    [
        ({"content": None}, "503"),
        ({"content": WHOLE, "sent": 50}, ""),  # cut
        ({"content": WHOLE, "mesh": b"another"}, "is not in it, or not as published"),
        ({"content": archive(other=MESH)}, "is not in it, or not as published"),
    ],
)
def test_anything_else_is_refused_with_what_to_do(serve, tmp_path, options, reason):
    serve(**options)
    with pytest.raises(InputError, match=f"cannot download http.*{reason}") as caught:
        download_mesh(tmp_path / "downloaded.ply")
    assert "`--config dragon=PATH/TO/dragon_vrip_res2.ply`" in str(caught.value)
    assert list(tmp_path.iterdir()) == []
    del caught
    gc.collect()


def test_another_archive_and_no_server_are_refused(serve, tmp_path, monkeypatch):
    serve(WHOLE)
    monkeypatch.setattr(stage, "ARCHIVE_SHA256", "0" * 64)
    with pytest.raises(InputError, match="does not match the known hash"):
        download_mesh(tmp_path / "downloaded.ply")
    monkeypatch.setattr(stage, "URL", "http://127.0.0.1:9/dragon_recon.tar.gz")
    with pytest.raises(InputError, match="refused"):
        download_mesh(tmp_path / "downloaded.ply")
