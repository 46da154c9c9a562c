# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""The fresh folder of a recording."""

from pathlib import Path
import re

from cloth_sim_ros.recording.bag_folder import make_bag_folder
from cloth_sim_ros.recording.bag_folder import MOST_BYTES
from cloth_sim_ros.sim.errors import ClothSimError
import pytest


def everything_in(folder):
    """Return all paths below ``folder``."""
    return sorted(folder.rglob('*'))


@pytest.mark.parametrize('name', [
    'a', '7', '_a', 'run_1', 'Prüfung-2', 'a.b+c=d,e@f-', 'x' * MOST_BYTES])
def test_a_plain_name_is_taken_as_it_is(tmp_path, name):
    """A recording would not be where it was asked for."""
    assert make_bag_folder(tmp_path / 'bags', name) == tmp_path / 'bags' / name
    assert everything_in(tmp_path) == [tmp_path / 'bags', tmp_path / 'bags' / name]


@pytest.mark.parametrize('name', [
    '..', '.', '/tmp/x', '/', '../x', 'a/../../x', 'a/b', 'a//b', 'a/', './a', 'a\nb', 'a\x00b',
    '\x1b[2J', '\udcff', '\u202ea', 'x' * (MOST_BYTES + 1), 'ü' * 200, 'x' * 1_000_000,
    # What a shell or a command takes for something else.
    '-rf', '--help', '+x', '=ls', '@file', '.hidden', '..a', '~', '*', 'a*', 'a?', '[a]', '{a,b}',
    '`id`', '$(id)', '$HOME', 'a b', ' a', 'a;b', 'a&b', 'a|b', 'a>b', "it's", '"a"', '!!', '#a',
    'a\\b', '%s', 'a:b', '\u00a0',
], ids=lambda name: ascii(name)[:20])
def test_a_name_that_may_lead_elsewhere_is_refused(tmp_path, name):
    """A service call could write anywhere on the machine."""
    bags = tmp_path / 'bags'
    bags.mkdir()
    with pytest.raises(ClothSimError, match='plain name of a folder inside') as error:
        make_bag_folder(bags, name)
    str(error.value).encode()
    assert len(str(error.value)) < 600
    assert everything_in(tmp_path) == [bags]


def test_a_taken_name_is_refused(tmp_path):
    """A recording would be overwritten."""
    (tmp_path / 'a').mkdir()
    (tmp_path / 'a' / 'kept').write_text('data')
    (tmp_path / 'b').write_text('data')
    for name in ('a', 'b'):
        with pytest.raises(ClothSimError, match='give another name'):
            make_bag_folder(tmp_path, name)
    assert (tmp_path / 'a' / 'kept').read_text() == (tmp_path / 'b').read_text() == 'data'


@pytest.mark.parametrize('exists', [True, False])
def test_a_link_is_not_followed(tmp_path, exists):
    """A link in the directory would lead the recording out of it."""
    bags, outside = tmp_path / 'bags', tmp_path / 'outside'
    bags.mkdir()
    if exists:
        outside.mkdir()
    (bags / 'a').symlink_to(outside)
    with pytest.raises(ClothSimError, match='give another name'):
        make_bag_folder(bags, 'a')
    assert not outside.exists() or everything_in(outside) == []


def test_without_a_name_the_time_is_taken_and_made_unique(tmp_path):
    """Two recordings of one second would be one folder, or fail."""
    names = [make_bag_folder(tmp_path).name for _ in range(3)]
    assert len(set(names)) == 3
    pattern = r'cloth_\d{4}_\d\d_\d\d-\d\d_\d\d_\d\d(_\d)?'
    assert all(re.fullmatch(pattern, name) for name in names)


@pytest.mark.parametrize('name', ['', 'a'])
def test_a_directory_that_cannot_be_written_is_told(tmp_path, name):
    """The node would end with a traceback instead of saying which parameter is wrong."""
    (tmp_path / 'file').write_text('data')
    for directory in (tmp_path / 'file', tmp_path / 'file' / 'bags', Path('/proc/bags')):
        with pytest.raises(ClothSimError, match=r'\(.+\): set recording.directory'):
            make_bag_folder(directory, name)
    assert (tmp_path / 'file').read_text() == 'data'
    assert everything_in(tmp_path) == [tmp_path / 'file']


def test_the_home_folder_may_be_meant(tmp_path, monkeypatch):
    """A folder called ~ would appear where the node runs."""
    monkeypatch.setenv('HOME', str(tmp_path))
    assert make_bag_folder('~/bags', 'a') == tmp_path / 'bags' / 'a'
