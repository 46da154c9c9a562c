# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""Messages that were built once are taken from the cache, if they are whole."""

from pathlib import Path
import shlex
import subprocess
import sys

import pytest
from setup_parts import run_bash

ROOT = Path(__file__).resolve().parents[3]
PARTS = 'progress counts stamps interface_cache interfaces'
PACKAGE = 'tf2_msgs'
pytestmark = pytest.mark.long
INSTALL = f'install_interfaces scripts/setup/{PACKAGE}'
IN_WHEELS = pytest.mark.skipif(
    not (Path(sys.prefix) / 'share' / 'rosidl_default_generators').is_dir(),
    reason='a sourced ROS can change under the same version: nothing is kept')


def setup(folder, command, cache, with_cpp='no'):
    """Run a function of the set-up on the environment in ``folder``; return code and output."""
    return run_bash(
        PARTS, f'export XDG_CACHE_HOME={shlex.quote(str(cache))}\n{command}', ROOT, root=str(ROOT),
        venv=str(folder), stamps=str(folder / '.setup'), ros_source='wheels',
        with_cpp=with_cpp)


def environment(folder):
    """Make an environment that has all packages of this one but the messages."""
    folder.mkdir()
    for name in ('bin', 'include', 'lib', 'share', 'tools', 'pyvenv.cfg'):
        if (Path(sys.prefix) / name).exists():
            subprocess.run(['cp', '-rs', f'{sys.prefix}/{name}', folder], check=True)
    (folder / '.setup').mkdir()
    (folder / '.setup' / 'packages').write_text('locked\n')
    assert setup(folder, f'remove_package {PACKAGE}', folder)[0] == 0
    return folder


def contents(folder):
    """Return what is installed of the messages, without the folder's name and compiled Python."""
    code, output = setup(folder, f'interface_files {PACKAGE}', folder)
    assert code == 0
    paths = [folder / line for line in output.splitlines()]
    return {
        str(path.relative_to(folder)): path.read_bytes().replace(bytes(folder), b'')
        for top in paths for path in [top, *top.rglob('*')]
        if path.is_file() and path.suffix != '.pyc'}


@pytest.fixture(scope='module')
def built(tmp_path_factory):
    """Build the messages once; return the environment and the folder of the cache."""
    base = tmp_path_factory.mktemp('built')
    folder = environment(base / 'first.one')
    code, output = setup(folder, INSTALL, base / 'cache')
    assert code == 0, output
    assert f'Building {PACKAGE}: done' in output
    return folder, base / 'cache'


def archive_in(cache):
    """Return the one archive, beside which nothing is left over."""
    path, = (cache / 'cloth_sim_ros' / 'interfaces').iterdir()
    return path


@IN_WHEELS
def test_another_checkout_gets_the_same_files(built, tmp_path):
    """It would lack files, or name the folder of the first checkout."""
    first, cache = built
    second = environment(tmp_path / 'second')
    code, output = setup(second, INSTALL, cache)
    assert code == 0, output
    assert f'{PACKAGE}: built before' in output
    assert 'Building' not in output
    assert contents(second) == contents(first)
    installed = (first / 'build' / PACKAGE / 'install_manifest.txt').read_text().splitlines()
    assert {str(Path(line).relative_to(first)) for line in installed} <= set(contents(second))
    loaded = subprocess.run(
        [second / 'bin' / 'python', '-c', 'from tf2_msgs.msg import TFMessage as kind; '
         'kind.__class__.__import_type_support__(); import tf2_msgs; print(tf2_msgs.__file__)'],
        capture_output=True, text=True)
    assert loaded.returncode == 0, loaded.stderr
    assert Path(loaded.stdout.strip()).is_relative_to(second)


@IN_WHEELS
def test_a_broken_archive_is_built_again(built, tmp_path):
    """Every set-up of this user would fail, or run without some of the messages."""
    first, cache = built
    archive = archive_in(cache)
    whole = archive.read_bytes()
    archive.write_bytes(whole[:len(whole) // 2])
    second = environment(tmp_path / 'second')
    code, output = setup(second, INSTALL, cache)
    assert code == 0, output
    assert f'Building {PACKAGE}: done' in output
    assert set(contents(second)) == set(contents(first))
    subprocess.run(['gzip', '-t', archive_in(cache)], check=True)


@IN_WHEELS
def test_messages_for_cpp_serve_python_as_well(built, tmp_path):
    """A set-up after one with --tests would build all messages again."""
    first, _ = built
    keep = f'keep_interfaces scripts/setup/{PACKAGE}'
    assert setup(first, keep, tmp_path / 'cache', 'yes') == (0, '')
    second = environment(tmp_path / 'second')
    code, output = setup(second, INSTALL, tmp_path / 'cache')
    assert code == 0, output
    assert f'{PACKAGE}: built before' in output
    assert contents(second) == contents(first)
    third = environment(tmp_path / 'third')
    missing = f'take_kept_interfaces scripts/setup/{PACKAGE} || echo missing'
    assert setup(first, f'{keep}', tmp_path / 'plain') == (0, '')
    assert setup(third, missing, tmp_path / 'plain', 'yes') == (0, 'missing\n')


@IN_WHEELS
def test_two_set_ups_keep_the_same_package(built):
    """The second would write into the archive of the first."""
    folder, cache = built
    keep = f'keep_interfaces scripts/setup/{PACKAGE}'
    code, output = setup(folder, f'rm -r {cache}/*\n{keep} & {keep} & wait', cache)
    assert code == 0, output
    subprocess.run(['gzip', '-t', archive_in(cache)], check=True)


@IN_WHEELS
def test_other_sources_have_another_archive(tmp_path):
    """A changed message would be taken from before its change."""
    named = [
        setup(Path(sys.prefix), f'interface_archive {source}', tmp_path)[1]
        for source in (
            f'scripts/setup/{PACKAGE}', f'scripts/setup/{PACKAGE}/msg', 'cloth_sim_interfaces')]
    assert len(set(named)) == 3


def test_nothing_is_kept_of_a_sourced_ros(tmp_path):
    """It can change under the same version, and the messages would not fit."""
    code, output = run_bash(
        PARTS, f'export XDG_CACHE_HOME={tmp_path}\ninterface_archive cloth_sim_interfaces',
        ROOT, root=str(ROOT), venv=sys.prefix, stamps=str(tmp_path), ros_source='jazzy',
        with_cpp='no')
    assert (code, output) == (0, '')


@IN_WHEELS
def test_a_cache_that_cannot_be_written_is_no_hindrance(built, tmp_path):
    """The set-up would fail where the home is read-only."""
    (tmp_path / 'file').touch()
    code, output = setup(
        built[0], f'keep_interfaces scripts/setup/{PACKAGE}', tmp_path / 'file')
    assert (code, output) == (0, '')
