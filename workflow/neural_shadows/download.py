"""Downloads that are bounded, checked and retried, and arrive whole or not at all."""

import hashlib
import http.client
import logging
import re
import sys
import time
import urllib.error
import urllib.request
from collections.abc import Iterator
from pathlib import Path
from urllib.parse import urlsplit

from tqdm import tqdm

from neural_shadows.errors import InputError
from neural_shadows.files import whole_file

_BLOCK = 1 << 18
_log = logging.getLogger(__name__)


def fetch(
    url: str,
    path: str | Path,
    *,
    sha256: str | None,
    max_bytes: int,
    remedy: str,
    label: str,
    tries: int = 4,
    timeout_s: float = 30,
    backoff_s: float = 1,
) -> None:
    """Download `url` to `path`, with a progress bar on stderr.

    What may pass by itself (no connection, a cut one, HTTP 408, 429 and 5xx) is tried again
    after `backoff_s`, then twice that, and so on.

    Args:
        url: http, https or file.
        path: where the file goes, once it is whole and checked.
        sha256: digest in hexadecimal, or its first digits (at least 8); None to skip the check.
        max_bytes: refuse anything larger.
        remedy: sentence for the error message: what to do without this download.
        label: what the progress bar says.
        tries: attempts in all.
        timeout_s: seconds without a byte after which a connection counts as lost.
        backoff_s: seconds before the second attempt.

    Raises:
        InputError: the URL or the digest is malformed, or the download failed for good;
            nothing is left behind then.
        OSError: `path` cannot be written.
    """
    if urlsplit(url).scheme not in ("http", "https", "file"):
        raise InputError(f"cannot download {url}: only http, https and file URLs; {remedy}")
    if sha256 is not None and not re.fullmatch("[0-9a-fA-F]{8,64}", sha256):
        raise InputError(f"cannot download {url}: '{sha256}' is not 8 to 64 digits of a SHA-256")
    for attempt in range(tries):
        try:
            _fetch_once(url, path, sha256, max_bytes, timeout_s, label)
            return
        except _FailedError as failure:
            if not failure.may_pass or attempt == tries - 1:
                raise InputError(f"cannot download {url}: {failure}; {remedy}") from failure
            wait_s = backoff_s * 2**attempt
            _log.warning("%s: %s; trying again in %g s", url, failure, wait_s)
            time.sleep(wait_s)


class _FailedError(Exception):
    """One attempt failed; `may_pass` says whether another one can succeed."""

    def __init__(self, reason: str, *, may_pass: bool):
        super().__init__(" ".join(reason.split()))
        self.may_pass = may_pass


def _fetch_once(
    url: str, path: str | Path, sha256: str | None, max_bytes: int, timeout_s: float, label: str
) -> None:
    digest = hashlib.sha256()
    with whole_file(path) as part:
        with part.open("wb") as file:
            for block in _blocks(url, max_bytes, timeout_s, label):
                file.write(block)
                digest.update(block)
        if sha256 is not None and not digest.hexdigest().startswith(sha256.lower()):
            raise _FailedError(
                f"its SHA-256 is {digest.hexdigest()}, where {sha256} is expected", may_pass=False
            )


def _blocks(url: str, max_bytes: int, timeout_s: float, label: str) -> Iterator[bytes]:
    """Yield the content of `url`; all that goes wrong on the way is a `_FailedError`.

    A generator, so that an OSError of the disk, raised where the blocks go, is not taken for
    one of the network.
    """
    # Some servers refuse the default name of Python's client.
    request = urllib.request.Request(url, headers={"User-Agent": "neural-shadows"})
    try:
        with urllib.request.urlopen(request, timeout=timeout_s) as response:
            length = response.headers.get("Content-Length", "")
            total = int(length) if length.isdigit() else None
            received = 0
            with tqdm(
                total=total, desc=label, unit="B", unit_scale=True, file=sys.stderr
            ) as progress:
                # The announced size first, so that nothing of a file that is too large is read.
                while max(received, total or 0) <= max_bytes and (block := response.read(_BLOCK)):
                    received += len(block)
                    progress.update(len(block))
                    yield block
    except urllib.error.HTTPError as error:
        error.close()  # it is also the response
        may_pass = error.code in (408, 429) or error.code >= 500
        reason = f"the server answers {error.code} {error.reason}"
        raise _FailedError(reason, may_pass=may_pass) from error
    except (OSError, http.client.HTTPException, UnicodeError) as error:
        # URLError is an OSError, and so are timeouts and lost connections. What is not on
        # this disk will not appear by waiting.
        reason = str(getattr(error, "reason", error)) or type(error).__name__
        raise _FailedError(reason, may_pass=request.type != "file") from error
    if max(received, total or 0) > max_bytes:
        raise _FailedError(f"larger than the {max_bytes:,} bytes allowed", may_pass=False)
    if total is not None and received < total:
        raise _FailedError(f"cut after {received:,} of {total:,} bytes", may_pass=True)
