"""Downloads from a local server that fails in each of the ways real ones do."""

import hashlib
import socket
import threading
import time
from contextlib import suppress
from http.server import BaseHTTPRequestHandler, ThreadingHTTPServer

import pytest

from neural_shadows import download
from neural_shadows.download import fetch
from neural_shadows.errors import InputError

CONTENT = bytes(range(256)) * 4096  # 1 MiB: several blocks
SHA256 = hashlib.sha256(CONTENT).hexdigest()
REMEDY = "give a copy with `mesh: {path: ...}`"


class Server(ThreadingHTTPServer):
    """Answers the n-th request with the n-th of `answers`, the last of them for ever."""

    daemon_threads = True

    def __init__(self):
        super().__init__(("127.0.0.1", 0), Handler)
        self.answers = ["whole"]
        self.requests = []
        self.url = f"http://127.0.0.1:{self.server_port}/folder/file.bin"


class Handler(BaseHTTPRequestHandler):
    def do_GET(self):
        answers = self.server.answers
        answer = answers[min(len(self.server.requests), len(answers) - 1)]
        self.server.requests.append(self.path)
        if isinstance(answer, int):
            self.send_error(answer)
            return
        if answer == "silent":
            self.connection.recv(1)  # until the client gives up
            return
        if answer == "moved to a file":
            self.send_response(302)
            self.send_header("Location", "file:///etc/hostname")
            self.end_headers()
            return
        self.send_response(200)
        if answer == "chunked":
            self.send_header("Transfer-Encoding", "chunked")
            self.end_headers()
            self.wfile.write(b"10000\r\n" + CONTENT[:1000])  # less than the 65,536 announced
            return
        if answer != "no length":
            self.send_header("Content-Length", str(len(CONTENT)))
        self.end_headers()
        with suppress(ConnectionError):  # a client that refuses the size hangs up
            self.wfile.write(CONTENT[:300_000] if answer == "cut" else CONTENT)

    def log_message(self, *_):
        pass


@pytest.fixture
def server():
    with Server() as server:
        thread = threading.Thread(target=server.serve_forever, kwargs={"poll_interval": 0.01})
        thread.start()
        yield server
        server.shutdown()
        thread.join()


def get(url, path, **options):
    options = {"sha256": SHA256, "max_bytes": len(CONTENT), "backoff_s": 1e-3} | options
    fetch(url, path, remedy=REMEDY, label="test file", **options)


def assert_refused(folder, url, reason, **options):
    """The download fails with one line, and leaves no file behind."""
    with pytest.raises(InputError, match=reason) as caught:
        get(url, folder / "file.bin", **options)
    message = str(caught.value)
    assert "\n" not in message
    assert message.startswith(f"cannot download {url}: ")
    assert message.endswith(f"; {REMEDY}")
    assert list(folder.iterdir()) == []


@pytest.mark.parametrize("answer", ["whole", "no length"])
@pytest.mark.parametrize("sha256", [SHA256, SHA256.upper(), SHA256[:8], None])
def test_success(server, tmp_path, capfd, answer, sha256):
    server.answers = [answer]
    get(server.url, tmp_path / "new" / "file.bin", sha256=sha256)
    assert (tmp_path / "new" / "file.bin").read_bytes() == CONTENT
    assert [path.name for path in (tmp_path / "new").iterdir()] == ["file.bin"]
    assert server.requests == ["/folder/file.bin"]
    out, err = capfd.readouterr()
    assert out == ""
    assert "test file" in err
    assert "1.05M" in err


@pytest.mark.parametrize("failure", ["cut", "chunked", 500, 503, 429, 408, "silent"])
def test_what_may_pass_is_tried_again(server, tmp_path, caplog, failure):
    server.answers = [failure, failure, "whole"]
    get(server.url, tmp_path / "file.bin", timeout_s=0.5)
    assert (tmp_path / "file.bin").read_bytes() == CONTENT
    assert len(server.requests) == 3
    assert len(caplog.records) == 2
    assert server.url in caplog.text


@pytest.mark.parametrize(
    ("failure", "reason"),
    [
        ("cut", "(cut after|IncompleteRead)"),
        (503, "503 Service Unavailable"),
        ("silent", "timed out"),
    ],
)
def test_gives_up_after_the_last_try(server, tmp_path, failure, reason):
    server.answers = [failure]
    assert_refused(tmp_path, server.url, reason, tries=3, timeout_s=0.5)
    assert len(server.requests) == 3


def test_waits_twice_as_long_each_time(server, tmp_path, monkeypatch):
    waits = []
    monkeypatch.setattr(time, "sleep", waits.append)
    server.answers = [500]
    assert_refused(tmp_path, server.url, "500", backoff_s=0.5)
    assert waits == [0.5, 1, 2]


@pytest.mark.parametrize("code", [401, 403, 404, 410])
def test_what_will_not_pass_is_not_tried_again(server, tmp_path, code):
    server.answers = [code, "whole"]
    assert_refused(tmp_path, server.url, f"the server answers {code}")
    assert len(server.requests) == 1


@pytest.mark.parametrize("sha256", ["0" * 64, "0" * 8, SHA256[:-1] + "10"[SHA256[-1] == "1"]])
def test_wrong_checksum(server, tmp_path, sha256):
    assert_refused(tmp_path, server.url, f"SHA-256 is {SHA256}, where {sha256}", sha256=sha256)
    assert len(server.requests) == 1


@pytest.mark.parametrize("sha256", ["", SHA256[:7], SHA256 + "0", "not a digest"])
def test_malformed_checksum(server, tmp_path, sha256):
    with pytest.raises(InputError, match="is not 8 to 64 digits of a SHA-256"):
        get(server.url, tmp_path / "file.bin", sha256=sha256)
    assert server.requests == []


@pytest.mark.parametrize("answer", ["whole", "no length"])
def test_refuses_what_is_too_large(server, tmp_path, answer):
    server.answers = [answer]
    limit = len(CONTENT) - 1
    assert_refused(tmp_path, server.url, f"larger than the {limit:,} bytes", max_bytes=limit)
    assert len(server.requests) == 1


def test_an_announced_size_is_refused_before_a_byte_is_read(server, tmp_path, monkeypatch):
    monkeypatch.setattr(download, "_BLOCK", None)  # a read of None bytes would take it all
    blocks = download._blocks(server.url, len(CONTENT) - 1, 1, "test file")
    with pytest.raises(download._FailedError, match="larger"):
        next(blocks)


def test_an_older_file_stays_when_the_download_fails(server, tmp_path):
    (tmp_path / "file.bin").write_text("old")
    server.answers = ["cut"]
    with pytest.raises(InputError):
        get(server.url, tmp_path / "file.bin", tries=2)
    assert (tmp_path / "file.bin").read_text() == "old"
    assert len(list(tmp_path.iterdir())) == 1


def test_no_server(tmp_path):
    with socket.socket() as held:  # bound but not listening: nobody else takes the port
        held.bind(("127.0.0.1", 0))
        url = f"http://127.0.0.1:{held.getsockname()[1]}/file.bin"
        assert_refused(tmp_path, url, "refused")


def test_file_urls(tmp_path, monkeypatch):
    source = tmp_path / "source.bin"
    source.write_bytes(CONTENT)
    folder = tmp_path / "target"
    get(source.as_uri(), folder / "file.bin")
    assert (folder / "file.bin").read_bytes() == CONTENT
    (folder / "file.bin").unlink()
    missing = (tmp_path / "missing.bin").as_uri()
    monkeypatch.setattr(time, "sleep", lambda _: pytest.fail("a local file was tried again"))
    assert_refused(folder, missing, "No such file")


@pytest.mark.parametrize("url", ["ftp://host/a", "data:,a", "/a/path", "HOST/file", "s3://b/a"])
def test_refuses_other_schemes(tmp_path, url):
    assert_refused(tmp_path, url, "only http, https and file")


def test_a_server_cannot_redirect_to_a_file(server, tmp_path):
    server.answers = ["moved to a file"]
    assert_refused(tmp_path, server.url, "302", sha256=None)


def test_an_error_of_the_disk_is_not_one_of_the_network(server, tmp_path):
    (tmp_path / "not_a_folder").write_text("")
    with pytest.raises(OSError, match="not_a_folder"):
        get(server.url, tmp_path / "not_a_folder" / "file.bin")
    assert len(server.requests) == 0
