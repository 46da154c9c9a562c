# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""
Hold the sources to ament's style.

Each linter gets the paths by name: at the root of a checkout it would also read what was built.
"""

import ast
from pathlib import Path
from xml.etree import ElementTree

from ament_flake8.main import main_with_errors as flake8_with_errors
from ament_pep257.main import main as pep257
from catkin_pkg.package import parse_package
import pytest

ROOT = Path(__file__).resolve().parents[1]
PYTHON_PLACES = (
    'benchmarks', 'cloth_sim_ros', 'examples', 'launch', 'scripts', 'setup.py', 'test')
HEADED_PLACES = (
    '.ci', 'benchmarks', 'cloth_sim_interfaces', 'cloth_sim_ros', 'examples', 'launch', 'scripts',
    'setup.py', 'shaders', 'test')
COMMENT_OF = {
    '.py': '#', '.sh': '#', '.txt': '#', '.comp': '//', '.glsl': '//', '': '#',
}
# Keys of rosdep that pip installs, without saying so in their name.
PIP_KEYS = {'mcap-ros2-support'}
HEADER = (
    'SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors',
    'SPDX-License-Identifier: Apache-2.0',
)


def files_in(places: tuple[str, ...], suffixes: tuple[str, ...]) -> list[Path]:
    """List the files of these kinds below the given places."""
    found = []
    for place in places:
        top = ROOT / place
        inside = [top] if top.is_file() else sorted(top.rglob('*'))
        found += [
            path for path in inside
            if path.is_file() and path.suffix in suffixes and '__pycache__' not in path.parts]
    return found


PYTHON_FILES = files_in(PYTHON_PLACES, ('.py',))


def test_flake8():
    """Names that don't exist, unused imports, wrong quotes or import order would be left."""
    code, errors = flake8_with_errors(argv=[str(path) for path in PYTHON_FILES])
    assert code == 0, '\n'.join(errors)


def test_pep257(caplog):
    """Docstrings would be missing or not in the imperative style of the rest of ROS."""
    caplog.set_level('WARNING')
    assert pep257(argv=[str(path) for path in PYTHON_FILES]) == 0


def test_license_header():
    """A file would not say whose it is and what may be done with it."""
    without = []
    for path in files_in(HEADED_PLACES, tuple(COMMENT_OF)):
        lines = path.read_text(encoding='utf-8').splitlines()
        if lines and lines[0].startswith(('#!', '#version')):
            del lines[0]
        if lines[:2] != [f'{COMMENT_OF[path.suffix]} {line}' for line in HEADER]:
            without.append(str(path.relative_to(ROOT)))
    assert not without


def test_no_file_is_long():
    """A file would hold more than one purpose."""
    long = {
        str(path.relative_to(ROOT)): count
        for path in files_in(HEADED_PLACES, ('.py', '.sh', '.comp', '.glsl'))
        if (count := len(path.read_text(encoding='utf-8').splitlines())) > 400}
    assert not long


def test_every_test_says_what_it_shows():
    """A failing test would not tell what is wrong."""
    silent = [
        f'{path.relative_to(ROOT)}: {node.name}'
        for path in PYTHON_FILES if path.name.startswith('test_')
        for node in ast.walk(ast.parse(path.read_text(encoding='utf-8')))
        if isinstance(node, ast.FunctionDef) and node.name.startswith('test_')
        and not ast.get_docstring(node)]
    assert not silent


@pytest.mark.parametrize('folder', ['.', 'cloth_sim_interfaces'])
def test_package_manifest(folder):
    """Colcon, rosdep and bloom would not accept the manifest."""
    warnings: list[str] = []
    package = parse_package(ROOT / folder, warnings=warnings)
    package.validate()
    assert not warnings
    assert {url.type for url in package.urls} == {'website', 'repository', 'bugtracker'}


@pytest.mark.parametrize('folder', ['.', 'cloth_sim_interfaces'])
def test_rosdep_installs_from_apt_alone(folder):
    """`rosdep install` would fail where pip may not write into the system's Python."""
    package = parse_package(ROOT / folder)
    needed = {depend.name for depend in (
        *package.build_depends, *package.exec_depends, *package.test_depends)}
    assert not needed & PIP_KEYS
    assert not {name for name in needed if name.endswith('-pip')}


def test_versions_agree():
    """Two packages of one repository would be released with different versions."""
    versions = {
        ROOT / folder: parse_package(ROOT / folder).version
        for folder in ('.', 'cloth_sim_interfaces')}
    assert len(set(versions.values())) == 1, versions
    version = set(versions.values()).pop()
    assert f"version='{version}'" in (ROOT / 'setup.py').read_text(encoding='utf-8')
    for folder in ('.', 'cloth_sim_interfaces'):
        log = (ROOT / folder / 'CHANGELOG.rst').read_text(encoding='utf-8')
        assert f'\nChangelog for package {parse_package(ROOT / folder).name}\n' in log
        assert f'\n{version} (' in log


@pytest.mark.parametrize(
    'path', [ROOT / 'package.xml', ROOT / 'cloth_sim_interfaces' / 'package.xml',
             *sorted((ROOT / 'config').glob('*.xml'))],
    ids=lambda path: str(path.relative_to(ROOT)))
def test_xml_is_well_formed(path):
    """A parser would refuse the file."""
    ElementTree.parse(path)
