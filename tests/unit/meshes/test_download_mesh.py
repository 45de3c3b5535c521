"""The dragon's archive: a tiny one in its place, from a local server."""

import hashlib
import io
import tarfile
from urllib.parse import urlsplit

import numpy as np
import pytest
from web_server import CUT, nobody, serving

from neural_shadows.errors import InputError
from neural_shadows.meshes import download_mesh as stanford
from neural_shadows.meshes.download_mesh import fetch_stanford_dragon

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


PATH = "/pub/dragon_recon.tar.gz"


def archive_of(tmp_path, *members):
    return write_archive(tmp_path / "packed.tar.gz", *members).read_bytes()


@pytest.fixture
def server(tmp_path_factory, monkeypatch):
    with serving(tmp_path_factory.mktemp("authority"), monkeypatch) as server:
        yield server


def serve(server, content):
    """Let the server have this archive; gives what to fetch it with."""
    server.files[PATH] = content
    digest = hashlib.sha256(content).hexdigest()
    return {"url": f"{server.url}{PATH}", "archive_sha256": digest}


def assert_refused(target, reason, **options):
    """One line that says what to do, and nothing left behind."""
    with pytest.raises(InputError, match=reason) as caught:
        fetch_stanford_dragon(target, backoff_s=1e-3, **{"sha256": DIGEST} | options)
    message = str(caught.value)
    assert "\n" not in message
    assert f"download {options.get('url', stanford.DRAGON_URL)} by hand" in message
    assert "`--config dragon=PATH/TO/dragon_vrip_res2.ply` (any .ply or .ply.gz)" in message
    assert not target.parent.exists() or list(target.parent.iterdir()) == []


def test_the_published_constants():
    url = urlsplit(stanford.DRAGON_URL)
    assert (url.scheme, url.hostname) == ("https", "graphics.stanford.edu")
    assert url.path.endswith("/dragon_recon.tar.gz")
    assert stanford.DRAGON_MEMBER == MEMBER
    for digest in (stanford.DRAGON_SHA256, stanford.ARCHIVE_SHA256):
        assert len(bytes.fromhex(digest)) == 32


def test_success(server, tmp_path):
    packed = archive_of(
        tmp_path,
        regular("dragon_recon/README", b"about"),
        regular(OTHER, b"another"),
        regular(MEMBER),
    )
    options = serve(server, packed)
    target = tmp_path / "out" / "dragon.ply"
    fetch_stanford_dragon(target, **options, sha256=DIGEST)
    assert target.read_bytes() == MESH
    assert list(target.parent.iterdir()) == [target]
    another = hashlib.sha256(b"another").hexdigest()
    fetch_stanford_dragon(target, **options, member=OTHER, sha256=another)
    assert target.read_bytes() == b"another"


def test_a_cut_archive_is_gone_on_from_in_the_next_run(server, tmp_path):
    mesh = np.random.default_rng(0).bytes(500_000)  # which no archive makes smaller
    options = serve(server, archive_of(tmp_path, regular(MEMBER, mesh)))
    options |= {"sha256": hashlib.sha256(mesh).hexdigest()}
    target = tmp_path / "out" / "dragon.ply"
    server.answers = ["cut", 503, "whole"]
    with pytest.raises(InputError, match="503"):
        fetch_stanford_dragon(target, **options, tries=1, backoff_s=1e-3)
    assert [path.name for path in target.parent.iterdir()] == [".dragon_recon.tar.gz.part"]
    fetch_stanford_dragon(target, **options)
    assert target.read_bytes() == mesh
    assert list(target.parent.iterdir()) == [target]
    assert server.ranges[2] == f"bytes={CUT}-"


def test_a_local_archive_needs_no_server(tmp_path):
    archive = write_archive(tmp_path / "copy.tar.gz", regular(MEMBER))
    target = tmp_path / "out" / "dragon.ply"
    fetch_stanford_dragon(target, archive=archive, sha256=DIGEST)
    assert target.read_bytes() == MESH


def test_wrong_checksum_of_the_member(server, tmp_path):
    options = serve(server, archive_of(tmp_path, regular(MEMBER, MESH + b"!")))
    assert_refused(tmp_path / "out" / "dragon.ply", f"where {DIGEST} is expected", **options)


def test_an_archive_that_is_another_is_not_opened(server, tmp_path, monkeypatch):
    options = serve(server, archive_of(tmp_path, regular(MEMBER))) | {"archive_sha256": "0" * 64}
    monkeypatch.setattr(tarfile, "open", lambda *_: pytest.fail("opened before it was checked"))
    assert_refused(tmp_path / "out" / "dragon.ply", f"where {'0' * 64} is expected", **options)
    options.pop("archive_sha256")
    assert_refused(tmp_path / "out" / "dragon.ply", "where 74ac1d90", **options)


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
    with nobody() as url:
        assert_refused(tmp_path / "out" / "dragon.ply", "refused", url=f"{url}{PATH}")


def test_not_found(server, tmp_path):
    assert_refused(tmp_path / "out" / "dragon.ply", "404", url=f"{server.url}{PATH}")
