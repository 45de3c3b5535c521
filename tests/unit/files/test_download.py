"""Downloads from a local server that fails in each of the ways real ones do."""

import hashlib
import os
import resource
import signal
import subprocess
import sys
import threading
import time
from concurrent.futures import ThreadPoolExecutor

import pytest
from web_server import CUT, nobody, serving

from neural_shadows.errors import InputError
from neural_shadows.files import download
from neural_shadows.files.download import fetch

CONTENT = bytes(range(256)) * 4096  # 1 MiB: several blocks
SHA256 = hashlib.sha256(CONTENT).hexdigest()
REMEDY = "give a copy with `mesh: {path: ...}`"
PART = ".file.bin.part"


@pytest.fixture
def server(tmp_path_factory, monkeypatch):
    with serving(tmp_path_factory.mktemp("authority"), monkeypatch) as server:
        server.files["/folder/file.bin"] = CONTENT
        yield server


def url_of(server) -> str:
    return f"{server.url}/folder/file.bin"


def get(url, path, **options):
    options = {"sha256": SHA256, "max_bytes": len(CONTENT), "backoff_s": 1e-3} | options
    fetch(url, path, remedy=REMEDY, label="test file", **options)


def assert_refused(folder, url, reason, *, left=(), **options):
    """The download fails with one line, and leaves what is `left` and nothing else."""
    with pytest.raises(InputError, match=reason) as caught:
        get(url, folder / "file.bin", **options)
    message = str(caught.value)
    assert "\n" not in message
    assert message.startswith(f"cannot download {url}: ")
    assert message.endswith(f"; {REMEDY}")
    assert {path.name for path in folder.iterdir()} == set(left)


def assert_whole(folder):
    """The file is there, and nothing else."""
    assert [path.name for path in folder.iterdir()] == ["file.bin"]
    assert (folder / "file.bin").read_bytes() == CONTENT
    assert (folder / "file.bin").stat().st_mode & 0o777 == 0o644


@pytest.mark.parametrize("answer", ["whole", "no length"])
def test_success(server, tmp_path, capfd, answer):
    server.answers = [answer]
    get(url_of(server), tmp_path / "new" / "file.bin")
    assert_whole(tmp_path / "new")
    assert server.requests == ["/folder/file.bin"]
    out, err = capfd.readouterr()
    assert out == ""
    assert "test file" in err
    assert "1.05M" in err


def test_what_is_there_is_not_fetched_again(server, tmp_path):
    (tmp_path / "file.bin").write_bytes(CONTENT)
    tmp_path.chmod(0o500)  # nothing is written either: a cache that others filled
    get(url_of(server), tmp_path / "file.bin")
    assert server.requests == []
    tmp_path.chmod(0o700)
    (tmp_path / "file.bin").write_bytes(CONTENT[:-1])
    get(url_of(server), tmp_path / "file.bin")
    assert_whole(tmp_path)


@pytest.mark.parametrize(
    "failure", ["cut", "chunked", "stalls", "silent", "trickles", 500, 503, 429, 408]
)
def test_what_may_pass_is_tried_again(server, tmp_path, caplog, failure):
    server.answers = [failure, failure, "whole"]
    get(url_of(server), tmp_path / "file.bin", timeout_s=0.3)
    assert_whole(tmp_path)
    assert len(server.requests) == 3
    assert len(caplog.records) == 2
    assert url_of(server) in caplog.text


@pytest.mark.parametrize(
    ("failure", "reason", "left"),
    [
        ("cut, ignores ranges", "cut after 300,000 of 1,048,576 bytes", [PART]),
        ("chunked", "IncompleteRead", [PART]),
        (503, "503 Service Unavailable", []),
        ("silent", "timed out", []),
        ("trickles", "less than 1,000 bytes/s", [PART]),
        ("trickling headers", "no answer within", []),
    ],
)
def test_gives_up_after_the_last_try(server, tmp_path, failure, reason, left):
    server.answers = [failure]
    assert_refused(tmp_path, url_of(server), reason, left=left, tries=2, timeout_s=0.3)
    # The cut answer got further than ever the first time, and no further since.
    assert len(server.requests) == (3 if failure == "cut, ignores ranges" else 2)


def test_waits_twice_as_long_each_time(server, tmp_path, monkeypatch):
    waits = []

    def sleep(seconds: float) -> None:
        # A server that still trickles to an earlier test sleeps too.
        if threading.current_thread() is threading.main_thread():
            waits.append(seconds)

    monkeypatch.setattr(time, "sleep", sleep)
    server.answers = [500]
    assert_refused(tmp_path, url_of(server), "500", backoff_s=0.5)
    assert waits == [0.5, 1, 2]


@pytest.mark.parametrize("code", [401, 403, 404, 410])
def test_what_will_not_pass_is_not_tried_again(server, tmp_path, code):
    server.answers = [code, "whole"]
    assert_refused(tmp_path, url_of(server), f"the server answers {code}")
    assert len(server.requests) == 1


def test_an_attempt_goes_on_where_the_last_one_ended(server, tmp_path):
    """More cuts than tries: each brings the file further, so that none counts."""
    server.answers = ["cut"]
    get(url_of(server), tmp_path / "file.bin", tries=1)
    assert_whole(tmp_path)
    places = range(CUT, len(CONTENT), CUT)
    assert server.ranges == [None, *(f"bytes={place}-" for place in places)]


def test_another_run_goes_on_too(server, tmp_path):
    server.answers = ["cut", 500, "whole"]
    assert_refused(tmp_path, url_of(server), "500", left=[PART], tries=1)
    assert (tmp_path / PART).read_bytes() == CONTENT[:CUT]
    get(url_of(server), tmp_path / "file.bin")
    assert_whole(tmp_path)
    assert server.ranges == [None, f"bytes={CUT}-", f"bytes={CUT}-"]


def test_a_killed_process_is_gone_on_from(server, tmp_path):
    server.answers = ["slow", "whole"]
    code = (
        "import sys; from neural_shadows.download import fetch; fetch(sys.argv[1], sys.argv[2], "
        "sha256=sys.argv[3], max_bytes=1 << 20, remedy='', label='test')"
    )
    process = subprocess.Popen(
        [sys.executable, "-c", code, url_of(server), tmp_path / "file.bin", SHA256],
        env={**os.environ, "PYTHONPATH": os.pathsep.join(sys.path)},
        stderr=subprocess.DEVNULL,
    )
    part = tmp_path / PART
    while not (part.exists() and part.stat().st_size > 0):
        assert process.poll() is None
        time.sleep(0.01)
    process.send_signal(signal.SIGKILL)
    process.wait()
    had = part.stat().st_size
    assert 0 < had < len(CONTENT)
    get(url_of(server), tmp_path / "file.bin")
    assert_whole(tmp_path)
    assert server.ranges == [None, f"bytes={had}-"]


def test_a_server_without_ranges_starts_anew(server, tmp_path):
    server.answers = ["cut", "ignores ranges"]
    get(url_of(server), tmp_path / "file.bin")
    assert_whole(tmp_path)
    assert server.ranges == [None, f"bytes={CUT}-"]


@pytest.mark.parametrize("part", [CONTENT[:1000] + b"!", CONTENT, CONTENT + b"!", b"!" * 2_000_000])
def test_a_part_that_is_none_is_dropped(server, tmp_path, part):
    """Of an older file, of the whole of it and not renamed, or longer than there is."""
    (tmp_path / PART).write_bytes(part)
    get(url_of(server), tmp_path / "file.bin")
    assert_whole(tmp_path)
    assert server.ranges == [f"bytes={len(part)}-", None]


def test_an_answer_to_another_range_is_dropped(server, tmp_path):
    (tmp_path / PART).write_bytes(CONTENT[:1000])
    server.answers = ["other range", "whole"]
    get(url_of(server), tmp_path / "file.bin")
    assert_whole(tmp_path)
    assert server.ranges == ["bytes=1000-", None]


def test_two_processes_download_once(server, tmp_path):
    """Locks are of the open file, so that two threads stand for two processes."""
    server.answers = ["slow", 500]
    with ThreadPoolExecutor(2) as pool:
        first = pool.submit(get, url_of(server), tmp_path / "file.bin")
        while not server.requests:
            time.sleep(0.01)
        second = pool.submit(get, url_of(server), tmp_path / "file.bin")
        first.result(), second.result()
    assert_whole(tmp_path)
    assert len(server.requests) == 1


@pytest.mark.parametrize("sha256", ["0" * 64, SHA256[:-1] + "10"[SHA256[-1] == "1"]])
def test_wrong_checksum(server, tmp_path, sha256):
    reason = f"SHA-256 is {SHA256}, where {sha256}"
    assert_refused(tmp_path, url_of(server), reason, sha256=sha256)
    assert len(server.requests) == 1


def test_wrong_bytes(server, tmp_path):
    server.answers = ["wrong bytes"]
    assert_refused(tmp_path, url_of(server), f"where {SHA256} is expected")
    assert len(server.requests) == 1
    # The rest of a file that is changed meanwhile: from its start once more, and no further.
    server.answers = ["wrong bytes"]
    (tmp_path / PART).write_bytes(CONTENT[:CUT])
    assert_refused(tmp_path, url_of(server), f"where {SHA256} is expected")
    assert server.ranges[1:] == [f"bytes={CUT}-", None]


@pytest.mark.parametrize("answer", ["whole", "no length"])
def test_refuses_what_is_too_large(server, tmp_path, answer):
    server.answers = [answer]
    limit = len(CONTENT) - 1
    reason = f"larger than the {limit:,} bytes"
    assert_refused(tmp_path, url_of(server), reason, max_bytes=limit)
    assert len(server.requests) == 1


@pytest.mark.parametrize("had", [0, 1000])
def test_an_announced_size_is_refused_before_a_byte_is_read(server, monkeypatch, had):
    monkeypatch.setattr(download, "_BLOCK", None)  # a read of None bytes would fail
    blocks = download._blocks(url_of(server), had, len(CONTENT) - 1, 1, "test file")
    with pytest.raises(download._FailedError, match="larger"):
        next(blocks)


def test_an_older_file_stays_when_the_download_fails(server, tmp_path):
    (tmp_path / "file.bin").write_text("old")
    server.answers = [404]
    with pytest.raises(InputError):
        get(url_of(server), tmp_path / "file.bin")
    assert (tmp_path / "file.bin").read_text() == "old"
    assert len(list(tmp_path.iterdir())) == 1


def test_no_server(tmp_path):
    with nobody() as url:
        assert_refused(tmp_path, f"{url}/file.bin", "refused")


@pytest.mark.parametrize(
    "url",
    ["http://host/a", "ftp://host/a", "file:///etc/hostname", "data:,a", "/a/path", "HOST/file"],
)
def test_refuses_other_schemes(tmp_path, url):
    assert_refused(tmp_path, url, "only https")


def test_a_certificate_of_nobody_known_is_refused(tmp_path, monkeypatch):
    with serving(tmp_path, monkeypatch, trusted=False) as server:
        server.files["/folder/file.bin"] = CONTENT
        assert_refused(tmp_path, url_of(server), "certificate verify failed")
        assert server.requests == []


@pytest.mark.parametrize(
    ("location", "reason"),
    [
        ("file:///etc/hostname", "302"),
        ("http://127.0.0.1/file.bin", "302 Found, to http and not https"),
        ("ftp://127.0.0.1/file.bin", "302"),
    ],
)
def test_a_server_cannot_redirect_from_https(server, tmp_path, location, reason):
    server.answers, server.location = ["moved"], location
    assert_refused(tmp_path, url_of(server), reason)
    assert len(server.requests) == 1


def test_a_redirection_within_https_is_followed_with_its_range(server, tmp_path):
    server.files["/elsewhere"] = CONTENT
    server.answers, server.location = ["moved", "whole"], f"{server.url}/elsewhere"
    (tmp_path / PART).write_bytes(CONTENT[:CUT])
    get(url_of(server), tmp_path / "file.bin")
    assert_whole(tmp_path)
    assert server.requests == ["/folder/file.bin", "/elsewhere"]
    assert server.ranges == [f"bytes={CUT}-"] * 2


def test_an_error_of_the_disk_is_not_one_of_the_network(server, tmp_path):
    (tmp_path / "not_a_folder").write_text("")
    with pytest.raises(OSError, match="not_a_folder"):
        get(url_of(server), tmp_path / "not_a_folder" / "file.bin")
    assert len(server.requests) == 0


def test_a_disk_that_fills_is_not_one_of_the_network(server, tmp_path):
    """In its place a limit on the size of files; what has come is there for the next run."""
    limits = resource.getrlimit(resource.RLIMIT_FSIZE)
    resource.setrlimit(resource.RLIMIT_FSIZE, (500_000, limits[1]))
    try:
        with pytest.raises(OSError, match="File too large"):
            get(url_of(server), tmp_path / "file.bin")
    finally:
        resource.setrlimit(resource.RLIMIT_FSIZE, limits)
    assert len(server.requests) == 1
    assert [path.name for path in tmp_path.iterdir()] == [PART]
    get(url_of(server), tmp_path / "file.bin")
    assert_whole(tmp_path)


@pytest.mark.parametrize(
    "proxy",
    ["http://reader:pa55word", "http:/reader:pa55word@proxy:3128", "http://reader:pa55word@"],
)
def test_a_proxy_that_is_no_url_keeps_its_password(server, tmp_path, monkeypatch, proxy):
    monkeypatch.setenv("https_proxy", proxy)
    monkeypatch.setenv("no_proxy", "")
    with pytest.raises(InputError) as caught:
        get(url_of(server), tmp_path / "file.bin", tries=1)
    assert "pa55word" not in str(caught.value) and "cannot download" in str(caught.value)


def test_settings_of_tls_that_cannot_be_used_are_named(server, tmp_path, monkeypatch):
    monkeypatch.setenv("SSLKEYLOGFILE", str(tmp_path / "none" / "keys"))
    assert_refused(tmp_path, url_of(server), "settings of TLS cannot be used.*none/keys")
