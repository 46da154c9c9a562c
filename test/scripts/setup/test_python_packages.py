# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""What pip installs is what the lock files hold, down to the bytes."""

import ast
import hashlib
from importlib.metadata import packages_distributions
from pathlib import Path
import re
import sys
import zipfile

import pytest
from session_processes import kill_all_of
from setup_parts import run_bash
from setup_parts import start_bash

ROOT = Path(__file__).resolve().parents[3]
REQUIREMENTS = ROOT / 'requirements'
LOCKS = ('run', 'view', 'test', 'sourced_ros')
PIN = re.compile(r'([A-Za-z0-9._-]+)(?:\[[a-z,]+\])?==(\S+)(?: ; (.*?))?(?: \\)?$')
HASH = re.compile(r'    --hash=sha256:[0-9a-f]{64}(?: \\)?$')
PARTS_OF_VENV = 'progress stamps find_python python_packages'
# Studies on several machines, the environment for training, tables, the live view, recording by a
# sourced ROS; each says so. The two behind viser come with it.
OPTIONAL = {
    'distributed', 'gymnasium', 'pandas', 'viser', 'msgspec', 'websockets', 'rosbag2_py'}


def pins(name):
    """Return the (name, version, marker) of each requirement of a lock file."""
    return [
        (pin[1].lower().replace('_', '-').replace('.', '-'), pin[2], pin[3])
        for line in (REQUIREMENTS / f'{name}.txt').read_text(encoding='utf-8').splitlines()
        if (pin := PIN.match(line))]


@pytest.mark.parametrize('name', LOCKS)
def test_a_lock_file_holds_pins_and_hashes_alone(name):
    """Something could be installed that nobody looked at, or from a place named in the file."""
    lines = (REQUIREMENTS / f'{name}.txt').read_text(encoding='utf-8').splitlines()
    for number, line in enumerate(lines):
        if line.startswith('#'):
            continue
        assert PIN.match(line) or HASH.match(line), line
        if PIN.match(line):
            assert HASH.match(lines[number + 1]), line
    assert len(pins(name)) > (15 if name == 'view' else 80)


@pytest.mark.parametrize('name', LOCKS)
def test_what_is_asked_for_is_locked(name):
    """A changed *.in would have no effect: scripts/lock.sh was not run."""
    inputs = {
        'run': ('ros', 'build', 'runtime'), 'view': ('view',),
        'test': ('ros', 'build', 'runtime', 'view', 'test'), 'sourced_ros': ('sourced_ros',)}[name]
    locked = {pin[:2] for pin in pins(name)}
    for part in inputs:
        for line in (REQUIREMENTS / f'{part}.in').read_text(encoding='utf-8').splitlines():
            if asked := PIN.match(line):
                wanted = asked[1].lower().replace('_', '-').replace('.', '-'), asked[2]
                assert wanted in locked, line


def test_the_tests_run_with_what_users_have():
    """The tests would pass with versions that no user has."""
    # Markers differ where something else asks for the same package.
    tested = {pin[:2] for pin in pins('test')}
    for name in ('run', 'view'):
        assert {pin[:2] for pin in pins(name)} <= tested


def wheel(folder, name, version):
    """Write the smallest wheel that pip installs; return its hash."""
    path = folder / f'{name}-{version}-py3-none-any.whl'
    info = f'{name}-{version}.dist-info'
    with zipfile.ZipFile(path, 'w') as file:
        file.writestr(f'{name}.py', '')
        file.writestr(
            f'{info}/METADATA', f'Metadata-Version: 2.1\nName: {name}\nVersion: {version}\n')
        file.writestr(
            f'{info}/WHEEL', 'Wheel-Version: 1.0\nRoot-Is-Purelib: true\nTag: py3-none-any\n')
        file.writestr(f'{info}/RECORD', '')
    return hashlib.sha256(path.read_bytes()).hexdigest()


def install(folder, lock):
    """Install a lock file as the set-up does, from wheels in ``folder`` into it."""
    (folder / 'lock.txt').write_text(lock)
    return run_bash(
        'progress python_packages',
        'export PIP_NO_INDEX=1 PIP_FIND_LINKS=$PWD PIP_TARGET=$PWD/in\ninstall_locked lock.txt',
        folder, venv=sys.prefix)


def test_other_bytes_are_not_installed(tmp_path):
    """A file that was exchanged on its way, or on the server, would run on the user's machine."""
    right, wrong = wheel(tmp_path, 'setuptools', '79.0.1'), '0' * 64
    wheel(tmp_path, 'towel', '1.0')
    lock = f'setuptools==79.0.1 \\\n    --hash=sha256:{right}\n'
    code, output = install(tmp_path, f'{lock}towel==1.0 \\\n    --hash=sha256:{wrong}\n')
    assert code != 0
    assert 'DO NOT MATCH THE HASHES' in output
    assert not (tmp_path / 'in' / 'towel.py').exists()


def test_nothing_is_installed_without_a_hash(tmp_path):
    """A requirement without a hash would be installed unchecked."""
    right = wheel(tmp_path, 'setuptools', '79.0.1')
    wheel(tmp_path, 'towel', '1.0')
    code, output = install(
        tmp_path, f'setuptools==79.0.1 \\\n    --hash=sha256:{right}\ntowel==1.0\n')
    assert code != 0
    assert 'Hashes are required' in output


def test_what_is_locked_is_installed(tmp_path):
    """The set-up would fail."""
    lock = ''.join(
        f'{name}=={version} \\\n    --hash=sha256:{wheel(tmp_path, name, version)}\n'
        for name, version in (('setuptools', '79.0.1'), ('towel', '1.0')))
    code, output = install(tmp_path, lock)
    assert code == 0, output
    assert (tmp_path / 'in' / 'towel.py').exists()


def test_setup_after_a_kill_during_a_fresh_start(tmp_path):
    """A half removed .venv would be taken for the user's own, and never be repaired."""
    venv = tmp_path / '.venv'
    (venv / '.setup').mkdir(parents=True)
    for name in ('a', 'lib', 'z'):
        (venv / name).mkdir()
        for number in range(5000):
            (venv / name / str(number)).touch()
    make = (PARTS_OF_VENV, 'make_venv\necho made', tmp_path)
    places = {
        'root': str(tmp_path), 'venv': str(venv), 'stamps': str(venv / '.setup'),
        'ros_source': 'wheels'}
    process = start_bash(*make, **places)
    while (venv / 'a' / '0').exists():
        assert process.poll() is None
    kill_all_of(process.pid)
    process.communicate(timeout=300.0)
    code, output = run_bash(*make, **places)
    assert code == 0, output
    assert output.endswith('made\n')
    assert {path.name for path in tmp_path.iterdir()} == {'.venv'}
    assert (venv / 'bin' / 'python').exists()


def imported_modules():
    """Return the top modules that the package imports, wherever it does."""
    found = set()
    for path in (ROOT / 'cloth_sim_ros').rglob('*.py'):
        for node in ast.walk(ast.parse(path.read_text(encoding='utf-8'))):
            if isinstance(node, ast.Import):
                found.update(alias.name.partition('.')[0] for alias in node.names)
            elif isinstance(node, ast.ImportFrom):
                found.add(node.module.partition('.')[0])
    return found - set(sys.stdlib_module_names)


def test_a_plain_set_up_brings_all_that_the_package_imports():
    """A command of the README would fail after scripts/setup.sh, for want of a package."""
    brought = {pin[0] for pin in pins('run')} | {'cloth-sim-ros'}
    where = packages_distributions()
    built_here = {'cloth_sim_interfaces', 'simulation_interfaces', 'tf2_msgs'}
    missing = {
        module for module in imported_modules() - built_here - OPTIONAL
        if not {name.lower().replace('_', '-') for name in where.get(module, [])} & brought}
    assert not missing
