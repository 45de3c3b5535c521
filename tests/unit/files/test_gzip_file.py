import gzip

import numpy as np
import pytest

from neural_shadows.files import gzip_file
from neural_shadows.files.gzip_file import unpack


def test_gzip_is_unpacked_as_far_as_it_may_be(tmp_path, monkeypatch):
    path = tmp_path / "a.gz"
    noise = np.random.default_rng(0).bytes(3 * 2**20)
    path.write_bytes(gzip.compress(noise[: 2**20]) + gzip.compress(noise[2**20 :]))
    assert unpack(path, 3 * 2**20) == noise
    with pytest.raises(ValueError, match="unpacks to more than 3,145,727 bytes"):
        unpack(path, 3 * 2**20 - 1)
    # A ratio of 1,000 to 1 is no mesh's, whatever the size that is allowed.
    path.write_bytes(gzip.compress(bytes(2**20)))
    monkeypatch.setattr(gzip_file, "HARMLESS_BYTES", 2**18)
    with pytest.raises(ValueError, match="unpacks to more than 262,144 bytes"):
        unpack(path, 2**30)
