# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""Files of arrays that may be hostile."""

from io import BytesIO
import zipfile

from cloth_sim_ros.files.checked_npz import load_arrays
from cloth_sim_ros.files.errors import ClothSimError
import numpy as np
import pytest


def header(text: str, version: int = 1) -> bytes:
    """Return the beginning of an npy file with ``text`` as its header."""
    return b'\x93NUMPY' + bytes((version, 0)) + len(text).to_bytes(2, 'little') + text.encode()


def described(kind: str, shape: str) -> bytes:
    """Return the beginning of an npy file of this type and shape."""
    return header(f"{{'descr': {kind}, 'fortran_order': False, 'shape': {shape}, }}\n")


def packed(content: bytes, compression: int = zipfile.ZIP_STORED) -> bytes:
    """Return a zip file with ``content`` as its only array."""
    stream = BytesIO()
    with zipfile.ZipFile(stream, 'w', compression) as archive:
        archive.writestr('positions.npy', content)
    return stream.getvalue()


def encrypted() -> bytes:
    """Return a zip file that says that it is encrypted."""
    data = bytearray(packed(described("'<f8'", '(1,)') + bytes(8)))
    for place, signature in ((6, b'PK\x03\x04'), (8, b'PK\x01\x02')):
        data[data.index(signature) + place] |= 1
    return bytes(data)


def bomb() -> bytes:
    """Return a zip file of 256 KiB whose array has 256 MiB."""
    return packed(described("'|u1'", f'({1 << 28},)') + bytes(1 << 28), zipfile.ZIP_DEFLATED)


HOSTILE = {
    'declared too long': packed(described("'<f4'", '(1000000, 1000000, 3)')),
    'declared without end': packed(described("'<f4'", '(10**30,)')),
    'declared negative': packed(described("'<f4'", '(-1, 4)')),
    'declared too short': packed(described("'<f4'", '(1,)') + bytes(400)),
    'objects': packed(described("'|O'", '(1,)') + b'cos\nsystem\n.'),
    'records': packed(described("[('a', '<f4')]", '(1,)') + bytes(4)),
    'dates': packed(described("'<M8[s]'", '(1,)') + bytes(8)),
    'nothing a word': packed(described("'<U0'", '(1000000000,)')),
    'nested header': packed(header('(' * 9000)),
    'signs as a header': packed(header('-' * 9000 + '1')),
    'no header': packed(b'\x93NUMPY'), 'other version': packed(header('{}', 9)),
    # Made where it is wanted: that takes as long as all else here.
    'bomb': bomb,
    'bzip2': packed(described("'<f8'", '(1,)') + bytes(8), zipfile.ZIP_BZIP2),
    'lzma': packed(described("'<f8'", '(1,)') + bytes(8), zipfile.ZIP_LZMA),
    'encrypted': encrypted(), 'cut': packed(described("'<f8'", '(9,)') + bytes(72))[:-60],
    'empty': b'', 'text': b'no archive', 'npy': described("'<f8'", '(1,)') + bytes(8),
}


@pytest.mark.parametrize('content', HOSTILE.values(), ids=HOSTILE)
def test_what_is_no_npz_is_refused_in_one_sentence(tmp_path, content):
    """A user would get a traceback, or the memory would be full."""
    (tmp_path / 'state.npz').write_bytes(content() if callable(content) else content)
    with pytest.raises(
            ClothSimError, match=r'state\.npz is not a state file \(.+\): try') as error:
        load_arrays(tmp_path / 'state.npz', 'state file', 'try another')
    assert len(str(error.value).splitlines()) == 1


@pytest.mark.parametrize('compression', [zipfile.ZIP_STORED, zipfile.ZIP_DEFLATED])
def test_a_wrong_byte_is_noticed(tmp_path, compression):
    """A damaged state would be drawn as if it were whole."""
    numbers = np.arange(1000.0)
    stream = BytesIO()
    np.save(stream, numbers)
    data = bytearray(packed(stream.getvalue(), compression))
    data[len(data) // 2] ^= 16
    (tmp_path / 'state.npz').write_bytes(data)
    with pytest.raises(ClothSimError, match='is not a state file'):
        load_arrays(tmp_path / 'state.npz', 'state file', 'try another')


@pytest.mark.parametrize('save', [np.savez, np.savez_compressed])
def test_arrays_come_as_numpy_wrote_them(tmp_path, save):
    """A state would be read as another one than was written."""
    arrays = {
        'scalar': np.array(1.5), 'turned': np.asfortranarray(np.arange(6).reshape(2, 3)),
        'flags': np.arange(4, dtype=np.uint32), 'large': np.zeros((300, 300, 3), np.float32),
        'none': np.zeros((0, 3)), 'words': np.array(['a', 'bc']),
        'big end': np.arange(3, dtype='>f4')}
    save(tmp_path / 'arrays.npz', **arrays)
    read = load_arrays(tmp_path / 'arrays.npz', 'file', 'try another')
    assert read.keys() == arrays.keys()
    for name, array in arrays.items():
        np.testing.assert_array_equal(read[name], array)
        assert read[name].dtype == array.dtype and read[name].flags.writeable
