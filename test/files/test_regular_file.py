# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""The door that files are read through."""

import ast
import os
from pathlib import Path
import socket

from cloth_sim_ros.files.errors import ClothSimError
from cloth_sim_ros.files.regular_file import is_folder
from cloth_sim_ros.files.regular_file import is_regular
from cloth_sim_ros.files.regular_file import open_regular
from cloth_sim_ros.files.regular_file import read_regular
import pytest

PACKAGE = Path(__file__).resolve().parents[2] / 'cloth_sim_ros'
# What reads a file: of these modules by these names, and methods by these names of anything.
READERS = {
    'yaml': {'load', 'safe_load', 'full_load', 'parse', 'compose', 'scan'},
    'np': {'load', 'loadtxt', 'genfromtxt', 'fromfile', 'memmap'}, 'json': {'load'},
    'zipfile': {'ZipFile'}, 'sqlite3': {'connect'}, 'os': {'open'}}
METHODS = {'read_text', 'read_bytes'}
# Where each may stand: the door, and what reads files that are the project's own.
ALLOWED = {
    'files/regular_file.py': {'os.open'}, 'files/checked_yaml.py': {'yaml.parse'},
    'files/checked_npz.py': {'zipfile.ZipFile'},
    'recording/sqlite_bag.py': {'sqlite3.connect'},
    'recording/message_definition.py': {'read_text'},
    'gl/shader_source.py': {'read_text'}, 'study/answers.py': {'read_text'},
    'study/node_cost.py': {'read_text'}, 'study/paper/printed.py': {'read_text'},
    # Not to read from: a lock, a folder whose names are to be on the disk, and files to append to.
    'node/shared_memory.py': {'os.open'}, 'recording/bag_folder.py': {'os.open'},
    'recording/recording_faults.py': {'os.open'},
    # Names of this process's threads, and the null device.
    'gl/forked.py': {'read_text'}, 'verb/termination.py': {'os.open'},
}


def calls_of(path: Path) -> set[str]:
    """Return the readers that a source file calls, and open() for reading."""
    found = set()
    for node in ast.walk(ast.parse(path.read_text(encoding='utf-8'))):
        if not isinstance(node, ast.Call):
            continue
        called = node.func
        if isinstance(called, ast.Name) and called.id == 'open':
            mode = node.args[1] if len(node.args) > 1 else None
            if not (isinstance(mode, ast.Constant) and set(mode.value) & set('wxa')):
                found.add('open')
        elif isinstance(called, ast.Attribute):
            owner = called.value.id if isinstance(called.value, ast.Name) else ''
            if called.attr in READERS.get(owner, ()):
                found.add(f'{owner}.{called.attr}')
            elif called.attr in METHODS:
                found.add(called.attr)
    return found


def test_no_file_is_read_around_the_door():
    """A pipe, a device or a file of any size would be read, by whatever parser there is."""
    sources = {str(path.relative_to(PACKAGE)): calls_of(path) for path in PACKAGE.rglob('*.py')}
    found = {name: calls - ALLOWED.get(name, set()) for name, calls in sources.items()}
    assert {name: calls for name, calls in found.items() if calls} == {}
    assert all(ALLOWED[name] <= sources[name] for name in ALLOWED), 'no longer needed'


def test_a_regular_file_is_read(tmp_path):
    """Nothing could be read at all."""
    file = tmp_path / 'file'
    file.write_bytes(b'12345')
    (tmp_path / 'link').symlink_to(file)
    for path in (file, str(file), tmp_path / 'link'):
        assert read_regular(path, 5) == b'12345'
        with open_regular(path) as stream:
            assert stream.read() == b'12345'
        assert is_regular(path) and not is_folder(path)


def test_what_is_no_regular_file_is_refused_at_once(tmp_path):
    """A verb would wait forever for a pipe, or read a device until the memory is full."""
    os.mkfifo(tmp_path / 'pipe')
    listener = socket.socket(socket.AF_UNIX)
    listener.bind(str(tmp_path / 'socket'))
    for path, kind in (
            (tmp_path / 'pipe', 'a named pipe'), ('/dev/zero', 'a device'),
            ('/dev/urandom', 'a device'), (tmp_path, 'a folder')):
        with pytest.raises(ClothSimError, match=f'is {kind}, and only regular files'):
            read_regular(path, 100)
        assert not is_regular(path)
    with pytest.raises(OSError):
        read_regular(tmp_path / 'socket', 100)
    listener.close()


def test_a_large_file_is_refused_without_reading_it(tmp_path):
    """A file of the size of the disk would be read into memory."""
    with (tmp_path / 'large').open('wb') as file:
        file.truncate(1 << 40)
    with pytest.raises(ClothSimError, match=f'{1 << 40} bytes.* the limit for its kind is 1000'):
        read_regular(tmp_path / 'large', 1000)
    # The kernel gives no size for its own.
    with pytest.raises(ClothSimError, match='bytes.* the limit for its kind is 10'):
        read_regular('/proc/self/maps', 10)


@pytest.mark.parametrize('name', ['none', 'x' * 5000, 'a\x00b', '\udcff' * 300])
def test_a_name_that_is_none_is_a_missing_file(tmp_path, name):
    """A name out of a file would end a verb as a traceback."""
    assert not is_regular(tmp_path / name) and not is_folder(tmp_path / name)
    with pytest.raises(OSError):
        read_regular(tmp_path / name, 100)
