"""An https server of this machine, with a certificate of its own, that can fail in many ways."""

import re
import socket
import ssl
import threading
import time
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from http.server import BaseHTTPRequestHandler, ThreadingHTTPServer
from pathlib import Path

import pytest
import trustme

CUT = 300_000  # bytes that a cut answer brings


class WebServer(ThreadingHTTPServer):
    """Serves `files`; the n-th request gets the n-th of `answers`, the last of them for ever.

    An answer is a status, or the name of a way to answer: see `Handler.do_GET`.
    """

    daemon_threads = True

    def __init__(self, context: ssl.SSLContext):
        super().__init__(("127.0.0.1", 0), Handler)
        self.context = context
        self.files: dict[str, bytes] = {}
        self.answers: list[str | int] = ["whole"]
        self.location = ""
        self.requests: list[str] = []
        """Of each request, the path."""
        self.ranges: list[str | None] = []
        """Of each request, the header Range."""
        self.stop = threading.Event()

    @property
    def url(self) -> str:
        return f"https://127.0.0.1:{self.server_port}"

    def finish_request(self, request: socket.socket, address) -> None:
        # Here, in the connection's own thread: a client that says nothing holds up no other.
        with suppress(OSError), self.context.wrap_socket(request, server_side=True) as encrypted:
            super().finish_request(encrypted, address)


class Handler(BaseHTTPRequestHandler):
    def do_GET(self):
        server = self.server
        answer = server.answers[min(len(server.requests), len(server.answers) - 1)]
        server.requests.append(self.path)
        server.ranges.append(self.headers["Range"])
        content = server.files.get(self.path)
        if isinstance(answer, int) or content is None:
            self.send_error(404 if content is None else answer)
            return
        if answer == "silent":
            server.stop.wait()
            return
        if answer == "trickling headers":
            self.wfile.write(b"HTTP/1.1 200 OK\r\nX-Slow: ")
            while not server.stop.wait(0.05):
                self.wfile.write(b"x")
            return
        if answer == "moved":
            self.send_response(302)
            self.send_header("Location", server.location)
            self.end_headers()
            return
        if answer == "wrong bytes":
            content = content[::-1]
        start = 0
        if self.headers["Range"] and answer not in ("ignores ranges", "cut, ignores ranges"):
            start = int(re.fullmatch(r"bytes=(\d+)-", self.headers["Range"])[1])
            if start >= len(content):
                self.send_error(416)
                return
            stated = 1 if answer == "other range" else start
            self.send_response(206)
            self.send_header("Content-Range", f"bytes {stated}-{len(content) - 1}/{len(content)}")
        else:
            self.send_response(200)
        content = content[start:]
        if answer == "chunked":
            self.send_header("Transfer-Encoding", "chunked")
            self.end_headers()
            self.wfile.write(b"10000\r\n" + content[:1000])  # less than the 65,536 announced
            return
        if answer != "no length":
            self.send_header("Content-Length", str(len(content)))
        self.end_headers()
        if answer.startswith("cut"):
            content = content[:CUT]
        if answer == "stalls":
            self.wfile.write(content[:CUT])
            server.stop.wait()
        elif answer == "trickles":
            for i in range(len(content)):
                self.wfile.write(content[i : i + 1])
                time.sleep(0.01)
        elif answer == "slow":
            for i in range(0, len(content), 1 << 16):
                self.wfile.write(content[i : i + (1 << 16)])
                time.sleep(0.05)
        else:
            self.wfile.write(content)

    def log_message(self, *_):
        pass


@contextmanager
def serving(folder: Path, monkeypatch: pytest.MonkeyPatch, *, trusted: bool = True):
    """A server; the tests' client takes its certificate for one of a known authority."""
    authority = trustme.CA()
    context = ssl.SSLContext(ssl.PROTOCOL_TLS_SERVER)
    authority.issue_cert("127.0.0.1").configure_cert(context)
    if trusted:
        authority.cert_pem.write_to_path(folder / "authority.pem")
        monkeypatch.setenv("SSL_CERT_FILE", str(folder / "authority.pem"))
    with WebServer(context) as server:
        thread = threading.Thread(target=server.serve_forever, kwargs={"poll_interval": 0.01})
        thread.start()
        yield server
        server.stop.set()
        server.shutdown()
        thread.join()


@contextmanager
def nobody() -> Iterator[str]:
    """The URL of a port of this machine where nobody listens, held so that nobody can."""
    with socket.socket() as held:
        held.bind(("127.0.0.1", 0))
        yield f"https://127.0.0.1:{held.getsockname()[1]}"
