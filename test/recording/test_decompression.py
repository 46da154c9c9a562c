# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""What is decompressed is no larger than declared, and no larger than can be."""

from cloth_sim_ros.recording.decompression import decompress
from cloth_sim_ros.recording.decompression import decompress_file
from cloth_sim_ros.recording.decompression import decompress_message
from hostile_mcap import BOMB
from hostile_mcap import CHUNKS
import lz4.frame
import pytest
import zstandard

TEXT = b'the same again ' * 10_000
PACKED = {'zstd': zstandard.compress(TEXT), 'lz4': lz4.frame.compress(TEXT), '': TEXT}


@pytest.mark.parametrize('kind', PACKED)
def test_it_comes_as_it_was(kind):
    """A recording could not be read."""
    assert decompress(PACKED[kind], kind, len(TEXT)) == TEXT


@pytest.mark.parametrize('kind', PACKED)
@pytest.mark.parametrize('size', [0, len(TEXT) - 1, len(TEXT) + 1, 1 << 40, 1 << 63])
def test_another_size_than_declared_is_refused(kind, size):
    """More would be allocated than there is."""
    with pytest.raises(ValueError, match='are declared'):
        decompress(PACKED[kind], kind, size)


@pytest.mark.parametrize('name', [name for name in CHUNKS if name.startswith(('zstd', 'lz4'))])
def test_bombs_are_refused(name):
    """The memory would be full before the size could be compared."""
    compression, data, size = CHUNKS[name]
    with pytest.raises((ValueError, RuntimeError, zstandard.ZstdError)):
        decompress(data, compression, size)


def test_decompressed_size_limit_in_older_bags(tmp_path):
    """A compressed bag would fill the memory or the disk."""
    assert decompress_message(PACKED['zstd']) == TEXT
    (tmp_path / 'packed').write_bytes(PACKED['zstd'])
    decompress_file(tmp_path / 'packed', tmp_path / 'plain')
    assert (tmp_path / 'plain').read_bytes() == TEXT
    with pytest.raises(ValueError, match='bytes come of'):
        decompress_message(BOMB)
    (tmp_path / 'packed').write_bytes(BOMB)
    with pytest.raises(ValueError, match='bytes come of'):
        decompress_file(tmp_path / 'packed', tmp_path / 'plain')
    assert (tmp_path / 'plain').stat().st_size < 1 << 28
