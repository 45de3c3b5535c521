"""Downloads: encrypted, bounded, checked, resumed and retried; they arrive whole or not at all."""

import fcntl
import hashlib
import http.client
import logging
import os
import queue
import re
import ssl
import sys
import threading
import time
import urllib.request
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import BinaryIO
from urllib.parse import urlsplit

from tqdm import tqdm

from neural_shadows.errors import InputError
from neural_shadows.files.whole_files import sha256_of, whole_file

# At most so much is read at once; an attempt that got further by it is none in vain.
_BLOCK = 1 << 18

# Times the limit for a byte that the whole answer with its headers may take.
_OPENING = 4

# Bytes a second below which a connection counts as lost.
_SLOWEST = 1000

_log = logging.getLogger(__name__)


def fetch(
    url: str,
    path: str | Path,
    *,
    sha256: str,
    max_bytes: int,
    remedy: str,
    label: str,
    tries: int = 4,
    timeout_s: float = 30,
    backoff_s: float = 1,
) -> None:
    """Make sure that the file `path` is the one of `url`: by its digest, or else by a download.

    What may pass by itself (no connection, one that is cut, hangs or trickles, HTTP 408, 429 and
    5xx) is tried again after `backoff_s`, then twice that, and so on. An attempt goes on where
    the last one ended, also where that was in an earlier run: what has come is kept beside `path`
    as `.NAME.part`. Of several processes that want the same file one downloads it, and the
    others wait.

    Args:
        url: https; a redirection to anything else is refused.
        path: where the file goes, once it is whole and checked.
        sha256: its digest in hexadecimal.
        max_bytes: refuse anything larger.
        remedy: sentence for the error message: what to do without this download.
        label: what the progress bar on stderr says.
        tries: so many attempts in a row that get less than 256 KiB further are the last.
        timeout_s: seconds without a byte, or with less than 1000 bytes a second, after which a
            connection counts as lost.
        backoff_s: seconds before the second attempt.

    Raises:
        InputError: the URL is not https, or the download failed for good; an older `path` is
            as it was then.
        OSError: `path` cannot be read or written.
    """
    path = Path(path)
    if urlsplit(url).scheme != "https":
        raise InputError(f"cannot download {url}: only https URLs; {remedy}")
    if _is_whole(path, sha256):
        return
    failed = reached = 0
    while True:
        try:
            _attempt(url, path, sha256, max_bytes, timeout_s, label)
            return
        except _FailedError as failure:
            failed = 0 if failure.size >= reached + _BLOCK else failed + 1
            reached = max(reached, failure.size)
            if not failure.may_pass or failed == tries:
                raise InputError(f"cannot download {url}: {failure}; {remedy}") from failure
            wait_s = backoff_s * 2 ** max(failed - 1, 0)
            _log.warning("%s: %s; trying again in %g s", url, failure, wait_s)
            time.sleep(wait_s)


class _FailedError(Exception):
    """One attempt failed.

    `may_pass`: another one can succeed; `keep`: what has come so far can be of use to it;
    `size`: bytes of the file that are there now.
    """

    def __init__(self, reason: str, *, may_pass: bool, keep: bool):
        super().__init__(" ".join(reason.split()))
        self.may_pass, self.keep = may_pass, keep
        self.size = 0


def _is_whole(path: Path, sha256: str) -> bool:
    return path.is_file() and sha256_of(path) == sha256


def _attempt(
    url: str, path: Path, sha256: str, max_bytes: int, timeout_s: float, label: str
) -> None:
    part = path.with_name(f".{path.name}.part")
    with _opened_alone(part) as file:
        if _is_whole(path, sha256):  # by another process, while this one waited for it
            part.unlink()
            return
        had = file.seek(0, os.SEEK_END)
        try:
            for offset, block in _blocks(url, had, max_bytes, timeout_s, label):
                file.seek(offset)
                file.truncate()  # the rest of an older part, where the server starts anew
                file.write(block)
            file.flush()
            # By this descriptor: on SMB no other may read what is locked.
            file.seek(0)
            found = hashlib.file_digest(file, "sha256").hexdigest()
            if found != sha256:
                reason = f"its SHA-256 is {found}, where {sha256} is expected"
                # With an older part, it may be that which was wrong.
                raise _FailedError(reason, may_pass=had > 0, keep=False)
        except _FailedError as failure:
            failure.size = file.tell()
            if not failure.keep or failure.size == 0:
                part.unlink()
            raise
        with whole_file(path) as written:
            part.replace(written)


@contextmanager
def _opened_alone(part: Path) -> Iterator[BinaryIO]:
    """A partial file, opened or made, for this process alone: waits until no other has it."""
    part.parent.mkdir(parents=True, exist_ok=True)
    while True:
        with open(part, "r+b", opener=_open_or_make) as file:
            try:
                fcntl.flock(file, fcntl.LOCK_EX | fcntl.LOCK_NB)
            except BlockingIOError:
                _log.warning("%s: waiting for the process that downloads it", part)
                fcntl.flock(file, fcntl.LOCK_EX)
            except OSError:
                pass  # some cluster file systems have no locks: the digest tells
            if _has_name(file, part):
                yield file
                return
        # It was renamed or removed by the process that had it.


def _open_or_make(path: str, flags: int) -> int:
    return os.open(path, flags | os.O_CREAT, 0o644)


def _has_name(file: BinaryIO, path: Path) -> bool:
    try:
        return os.path.samestat(os.fstat(file.fileno()), path.stat())
    except FileNotFoundError:
        return False


class _HttpsOnly(urllib.request.HTTPRedirectHandler):
    def redirect_request(self, request, response, code, reason, headers, new_url):
        if urlsplit(new_url).scheme != "https":
            reason = f"{reason}, to {urlsplit(new_url).scheme} and not https"
            raise urllib.error.HTTPError(new_url, code, reason, headers, response)
        return super().redirect_request(request, response, code, reason, headers, new_url)


def _opener() -> urllib.request.OpenerDirector:
    try:
        encrypted = urllib.request.HTTPSHandler(context=ssl.create_default_context())
    except OSError as error:  # SSL_CERT_FILE, SSLKEYLOGFILE
        reason = f"the environment's settings of TLS cannot be used: {error}"
        raise _FailedError(reason, may_pass=False, keep=True) from error
    return urllib.request.build_opener(encrypted, _HttpsOnly)


def _opened(
    opener: urllib.request.OpenerDirector, request: urllib.request.Request, timeout_s: float
) -> http.client.HTTPResponse:
    """The answer with its headers.

    In a thread: the opener's own limit is for each of a host's addresses, and for each byte of
    the headers, so that a slow server could take any time.
    """
    answers: queue.SimpleQueue[http.client.HTTPResponse | Exception] = queue.SimpleQueue()
    given_up = threading.Event()

    def ask() -> None:
        try:
            answer = opener.open(request, timeout=timeout_s)
        except Exception as error:
            answers.put(error)
            return
        answers.put(answer)
        if given_up.is_set():
            answer.close()

    threading.Thread(target=ask, daemon=True).start()
    try:
        answer = answers.get(timeout=_OPENING * timeout_s)
    except queue.Empty:
        given_up.set()
        raise TimeoutError(f"no answer within {_OPENING * timeout_s:g} s") from None
    if isinstance(answer, ValueError | http.client.InvalidURL):
        # Python's message would show the password that may be in a proxy's URL.
        reason = "the URL or that of https_proxy in the environment is not valid"
        raise _FailedError(reason, may_pass=False, keep=True)
    if isinstance(answer, Exception):
        raise answer
    return answer


def _blocks(
    url: str, had: int, max_bytes: int, timeout_s: float, label: str
) -> Iterator[tuple[int, bytes]]:
    """Yield the content of `url` from the byte `had` on: offsets and blocks.

    From the byte 0 on where the server can no other. All that goes wrong on the way is a
    `_FailedError`. A generator, so that an OSError of the disk, raised where the blocks go, is
    not taken for one of the network.
    """
    # Some servers refuse the default name of Python's client.
    headers = {"User-Agent": "neural-shadows"}
    if had:
        headers["Range"] = f"bytes={had}-"
    request = urllib.request.Request(url, headers=headers)
    opener = _opener()
    try:
        with _opened(opener, request, timeout_s) as response:
            offset, total = _extent(response, had)
            with tqdm(
                total=total,
                initial=offset,
                desc=label,
                unit="B",
                unit_scale=True,
                file=sys.stderr,
            ) as progress:
                since, before = time.monotonic(), offset
                # The announced size first, so that nothing of a file that is too large is read.
                while max(offset, total or 0) <= max_bytes and (block := response.read1(_BLOCK)):
                    yield offset, block
                    offset += len(block)
                    progress.update(len(block))
                    passed = time.monotonic() - since
                    if passed >= timeout_s:
                        if offset - before < _SLOWEST * passed:
                            raise TimeoutError(f"less than {_SLOWEST:,} bytes/s")
                        since, before = time.monotonic(), offset
    except urllib.error.HTTPError as error:
        error.close()  # it is also the response
        passing = error.code in (408, 429) or error.code >= 500
        # 416: there is nothing behind what we have, which can then not be right.
        raise _FailedError(
            f"the server answers {error.code} {error.reason}",
            may_pass=passing or (error.code == 416 and had > 0),
            keep=passing,
        ) from error
    except (OSError, http.client.HTTPException, UnicodeError) as error:
        # URLError is an OSError, and so are timeouts and lost connections.
        cause = getattr(error, "reason", error)
        wrong = isinstance(cause, ssl.SSLCertVerificationError)
        raise _FailedError(
            str(cause) or type(error).__name__, may_pass=not wrong, keep=True
        ) from error
    if max(offset, total or 0) > max_bytes:
        reason = f"larger than the {max_bytes:,} bytes allowed"
        raise _FailedError(reason, may_pass=False, keep=False)
    if total is not None and offset < total:
        reason = f"cut after {offset:,} of {total:,} bytes"
        raise _FailedError(reason, may_pass=True, keep=True)


def _extent(response: http.client.HTTPResponse, had: int) -> tuple[int, int | None]:
    """Where the content of an answer begins, and the size of the whole file if it says so."""
    if response.status == 206:
        stated = response.headers.get("Content-Range", "")
        found = re.fullmatch(r"bytes (\d+)-\d+/(\d+|\*)", stated)
        if not found or int(found[1]) != had:
            reason = f"the server answers the range {stated!r} to one from byte {had} on"
            raise _FailedError(reason, may_pass=had > 0, keep=False)
        return had, int(found[2]) if found[2].isdigit() else None
    length = response.headers.get("Content-Length", "")
    return 0, int(length) if length.isdigit() else None
