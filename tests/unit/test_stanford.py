"""The dragon's archive: a tiny one in its place, from a local server."""

import hashlib
import io
import socket
import tarfile
import threading
from http.server import SimpleHTTPRequestHandler, ThreadingHTTPServer
from urllib.parse import urlsplit

import pytest

from neural_shadows import stanford
from neural_shadows.errors import InputError
from neural_shadows.stanford import fetch_stanford_dragon

MESH = b"ply\n(not a real one)\n" * 1000
MEMBER = "dragon_recon/dragon_vrip_res2.ply"
OTHER = "dragon_recon/dragon_vrip_res3.ply"
DIGEST = hashlib.sha256(MESH).hexdigest()


def regular(name, content=MESH):
    info = tarfile.TarInfo(name)
    info.size = len(content)
    return info, content


def link(name, target, kind=tarfile.SYMTYPE):
    info = tarfile.TarInfo(name)
    info.type, info.linkname = kind, target
    return info, b""


def write_archive(path, *members):
    with tarfile.open(path, "w:gz") as tar:
        for info, content in members:
            tar.addfile(info, io.BytesIO(content))
    return path


@pytest.fixture
def site(tmp_path):
    """A folder, and the URL of a server of it."""
    folder = tmp_path / "site"
    folder.mkdir()

    class Handler(SimpleHTTPRequestHandler):
        def __init__(self, *args):
            super().__init__(*args, directory=folder)

        def log_message(self, *_):
            pass

    with ThreadingHTTPServer(("127.0.0.1", 0), Handler) as server:
        thread = threading.Thread(target=server.serve_forever, kwargs={"poll_interval": 0.01})
        thread.start()
        yield folder, f"http://127.0.0.1:{server.server_port}/dragon_recon.tar.gz"
        server.shutdown()
        thread.join()


def assert_refused(target, reason, **options):
    """One line that says what to do, and nothing left behind."""
    with pytest.raises(InputError, match=reason) as caught:
        fetch_stanford_dragon(target, backoff_s=1e-3, **{"sha256": DIGEST} | options)
    message = str(caught.value)
    assert "\n" not in message
    assert f"download {options.get('url', stanford.DRAGON_URL)} by hand" in message
    assert "`--config dragon=PATH/TO/dragon_vrip_res2.ply` (any .ply or .ply.gz)" in message
    assert not target.parent.exists()


def test_the_published_constants():
    url = urlsplit(stanford.DRAGON_URL)
    assert (url.hostname, url.path.rsplit("/", 1)[1]) == (
        "graphics.stanford.edu",
        "dragon_recon.tar.gz",
    )
    assert stanford.DRAGON_MEMBER == MEMBER
    assert len(bytes.fromhex(stanford.DRAGON_SHA256)) == 32


def test_success(site, tmp_path):
    folder, url = site
    write_archive(
        folder / "dragon_recon.tar.gz",
        regular("dragon_recon/README", b"about"),
        regular(OTHER, b"another"),
        regular(MEMBER),
    )
    target = tmp_path / "out" / "dragon.ply"
    fetch_stanford_dragon(target, url=url, sha256=DIGEST)
    assert target.read_bytes() == MESH
    assert list(target.parent.iterdir()) == [target]
    fetch_stanford_dragon(
        target, url=url, member=OTHER, sha256=hashlib.sha256(b"another").hexdigest()
    )
    assert target.read_bytes() == b"another"


def test_a_local_archive_needs_no_server(tmp_path):
    archive = write_archive(tmp_path / "copy.tar.gz", regular(MEMBER))
    target = tmp_path / "out" / "dragon.ply"
    fetch_stanford_dragon(target, archive=archive, sha256=DIGEST)
    assert target.read_bytes() == MESH


def test_wrong_checksum_of_the_member(site, tmp_path):
    folder, url = site
    write_archive(folder / "dragon_recon.tar.gz", regular(MEMBER, MESH + b"!"))
    assert_refused(tmp_path / "out" / "dragon.ply", f"where {DIGEST} is expected", url=url)


def test_the_published_digest_is_checked_by_default(tmp_path):
    archive = write_archive(tmp_path / "copy.tar.gz", regular(MEMBER))
    target = tmp_path / "out" / "dragon.ply"
    assert_refused(target, "f64cd2d0", archive=archive, sha256=stanford.DRAGON_SHA256)
    with pytest.raises(InputError, match="f64cd2d0"):
        fetch_stanford_dragon(target, archive=archive)


@pytest.mark.parametrize(
    "members",
    [
        [],
        [regular(OTHER)],
        [regular(f"../{MEMBER}"), regular("dragon_recon/../" + MEMBER), regular(f"/{MEMBER}")],
        [regular("other"), link(MEMBER, "other")],
        [link(MEMBER, "/etc/hostname")],
        [regular("other"), link(MEMBER, "other", tarfile.LNKTYPE)],
        [link(MEMBER, "", tarfile.DIRTYPE)],
        [link(MEMBER, "", tarfile.FIFOTYPE)],
    ],
)
def test_only_a_regular_file_of_exactly_this_name(tmp_path, members):
    archive = write_archive(tmp_path / "copy.tar.gz", *members)
    before = sorted(tmp_path.parent.rglob("*"))
    assert_refused(tmp_path / "out" / "dragon.ply", f"no file {MEMBER} in it", archive=archive)
    assert sorted(tmp_path.parent.rglob("*")) == before


def test_names_that_lead_elsewhere_are_ignored(tmp_path):
    archive = write_archive(
        tmp_path / "copy.tar.gz",
        regular("../escaped", b"bad"),
        regular(f"../{MEMBER}", b"bad"),
        link("dragon_recon", "/tmp"),
        regular(MEMBER),
    )
    target = tmp_path / "out" / "dragon.ply"
    fetch_stanford_dragon(target, archive=archive, sha256=DIGEST)
    assert target.read_bytes() == MESH
    assert sorted(path.name for path in tmp_path.rglob("*")) == ["copy.tar.gz", "dragon.ply", "out"]


def test_members_are_bounded(tmp_path, monkeypatch):
    archive = write_archive(tmp_path / "copy.tar.gz", regular(MEMBER))
    monkeypatch.setattr(stanford, "MAX_MEMBER_BYTES", len(MESH) - 1)
    target = tmp_path / "out" / "dragon.ply"
    assert_refused(target, "21,000 bytes, more than the 20,999 allowed", archive=archive)


def test_damaged_archives(tmp_path):
    whole = write_archive(tmp_path / "whole.tar.gz", regular(MEMBER)).read_bytes()
    archive = tmp_path / "copy.tar.gz"
    for content in b"", b"<html>moved</html>", whole[: len(whole) // 2], whole[:30]:
        archive.write_bytes(content)
        reason = "copy.tar.gz: damaged or truncated"
        assert_refused(tmp_path / "out" / "dragon.ply", reason, archive=archive)
    archive.unlink()
    assert_refused(tmp_path / "out" / "dragon.ply", "no such file", archive=archive)


def test_offline(tmp_path):
    with socket.socket() as held:  # bound but not listening: nobody else takes the port
        held.bind(("127.0.0.1", 0))
        url = f"http://127.0.0.1:{held.getsockname()[1]}/dragon_recon.tar.gz"
        assert_refused(tmp_path / "out" / "dragon.ply", "refused", url=url)


def test_not_found(site, tmp_path):
    _, url = site
    assert_refused(tmp_path / "out" / "dragon.ply", "404", url=url)
