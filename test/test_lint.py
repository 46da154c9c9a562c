# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""
Hold the sources to ament's style.

Each linter gets the paths by name: at the root of a checkout it would also read what was built.
"""

import ast
import json
from pathlib import Path
import re
import subprocess
import sys
from xml.etree import ElementTree

from ament_flake8.main import main_with_errors as flake8_with_errors
from ament_pep257.main import main as pep257
from catkin_pkg.package import parse_package
from flake8_docstrings import pep257Checker
from pycodestyle import StyleGuide
import pytest

ROOT = Path(__file__).resolve().parents[1]
PYTHON_PLACES = (
    'benchmarks', 'cloth_sim_ros', 'examples', 'launch', 'scripts', 'setup.py', 'test')
HEADED_PLACES = (
    '.ci', 'benchmarks', 'cloth_sim_interfaces', 'cloth_sim_ros', 'examples', 'launch', 'scripts',
    'setup.py', 'shaders', 'test')
COMMENT_OF = {
    '.c': '//', '.py': '#', '.sh': '#', '.txt': '#', '.comp': '//', '.glsl': '//', '': '#',
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


# A file for each kind of rule, named after a rule that it breaks; flake8 gives those of imports
# other numbers.
FLAWS = {
    'A001': 'list = 3\n',
    'A002': 'def function(id):\n    return id\n',
    'C400': 'numbers = list(n for n in range(3))\n',
    'C408': 'empty = dict()\n',
    'C416': 'numbers = [n for n in range(3)]\n',
    'D200': 'def function():\n    """\n    Do it.\n    """\n',
    'D205': 'def function():\n    """\n    Do it.\n    Then this.\n    """\n',
    'D213': 'def function():\n    """Do it.\n\n    Then this.\n    """\n',
    'D300': "def function():\n    '''Do it.'''\n",
    'D400': 'def function():\n    """Do it"""\n',
    'D401': 'def function():\n    """Does it."""\n',
    'D403': 'def function():\n    """do it."""\n',
    'E111': 'if True:\n  number = 3\n',
    'E128': 'number = max(3,\n    4)\n',
    'E131': 'numbers = {\n    3:\n        4,\n    5:\n            6}\n',
    'E201': 'numbers = [ 3]\n',
    'E225': 'number= 3\n',
    'E231': 'numbers = [3,4]\n',
    'E251': 'number = max(3, key = abs)\n',
    'E261': 'number = 3 # so\n',
    'E302': 'number = 3\ndef function():\n    pass\n',
    'E303': 'number = 3\n\n\n\nother = 4\n',
    'E305': 'def function():\n    pass\nnumber = 3\n',
    'E501': f'number = {"1" * 99}\n',
    'E502': 'number = max(3, \\\n             4)\n',
    'E701': 'if True: number = 3\n',
    'E711': 'number = 3\nif number == None:\n    number = 4\n',
    'E722': 'try:\n    number = 3\nexcept:\n    number = 4\n',
    'E731': 'function = lambda: 3\n',
    'E741': 'l = 3\n',
    'F401': 'import os\n',
    'F541': "text = f'x'\n",
    'F821': 'number = other\n',
    'F841': 'def function():\n    number = 3\n',
    'I001': 'import sys\nimport os\nprint(os, sys)\n',
    'I001_of_parts': 'from os import path, sep\nprint(path, sep)\n',
    'I001_of_groups': 'import numpy\n\nimport os\nprint(numpy, os)\n',
    'I001_of_names': 'from os import sep\nfrom os import path\nprint(path, sep)\n',
    'Q000': 'text = "x"\n',
    'Q001': "text = '''x\ny'''\n",
    'Q003': "text = 'It\\'s'\n",
    'W191': 'if True:\n\tnumber = 3\n',
    'W291': 'number = 3 \n',
    'W292': 'number = 3',
    'W391': 'number = 3\n\n',
    'W605': "text = '\\d'\n",
}


def ruff(paths: list[Path]) -> str:
    """Return what ruff finds by the rules of ruff.toml, a finding a line."""
    done = subprocess.run(
        [sys.executable, '-m', 'ruff', 'check', '--no-cache', '--quiet', '--output-format',
         'json-lines', '--config', ROOT / 'ruff.toml', *paths], capture_output=True, text=True)
    assert not done.stderr, done.stderr
    return '\n'.join(
        f'{finding["filename"]}:{finding["location"]["row"]}: {finding["code"]} '
        f'{finding["message"]}' for finding in map(json.loads, done.stdout.splitlines()))


def continuation_lines(paths: list[Path]) -> int:
    """Print and count lines that are not indented as the bracket they are in asks for."""
    guide = StyleGuide(paths=[], config_file=False)
    # All else that pycodestyle knows, ruff does too.
    for checks in ('physical_checks', 'logical_checks', 'ast_checks'):
        setattr(guide.options, checks, [
            check for check in getattr(guide.options, checks)
            if check[0] == 'continued_indentation'])
    return guide.check_files([str(path) for path in paths]).total_errors


def test_ruff():
    """Names that don't exist, unused imports, wrong quotes or docstrings would be left."""
    found = ruff(PYTHON_FILES)
    assert not found, found


def test_continuation_lines(capsys):
    """Lines within brackets would be indented in many ways."""
    assert continuation_lines(PYTHON_FILES) == 0, capsys.readouterr().out


@pytest.fixture
def flawed(tmp_path: Path) -> list[Path]:
    """Write a file for each flaw."""
    for name, text in FLAWS.items():
        (tmp_path / f'{name}.py').write_text(text, encoding='utf-8')
    return sorted(tmp_path.iterdir())


def test_each_kind_of_flaw_is_found(flawed, capsys):
    """A file of settings that ruff reads otherwise would let everything pass."""
    continuation_lines(flawed)
    found = ruff(flawed) + capsys.readouterr().out
    missed = [path.stem for path in flawed if not re.search(
        rf'{path.name}:.*\b{path.stem[:4]}\b', found)]
    assert not missed, found


@pytest.mark.long
def test_the_flaws_are_those_of_ament(flawed, monkeypatch, capsys, caplog):
    """The quick tests would hold the sources to another style than ament's."""
    caplog.set_level('WARNING')
    _, errors = flake8_with_errors(argv=[str(path) for path in flawed])
    assert pep257(argv=[str(path) for path in flawed]) == 1
    found = '\n'.join(errors) + capsys.readouterr().out + caplog.text
    missed = [path.stem for path in flawed if path.name not in found]
    assert not missed, found


@pytest.mark.long
def test_flake8(monkeypatch):
    """A rule of ament that ruff lacks would be broken."""
    # What it asks of docstrings is a part of what test_pep257 asks, by the same pydocstyle.
    monkeypatch.setattr(pep257Checker, 'run', lambda _: ())
    code, errors = flake8_with_errors(argv=[str(path) for path in PYTHON_FILES])
    assert code == 0, '\n'.join(errors)


@pytest.mark.long
def test_pep257(caplog):
    """A rule of ament on docstrings that ruff lacks would be broken."""
    caplog.set_level('WARNING')
    assert pep257(argv=[str(path) for path in PYTHON_FILES]) == 0


def has_header(path: Path) -> bool:
    """Return whether ``path`` begins with HEADER, after a line that has to be the first."""
    lines = path.read_text(encoding='utf-8').splitlines()
    if lines and lines[0].startswith(('#!', '#version')):
        del lines[0]
    return lines[:2] == [f'{COMMENT_OF[path.suffix]} {line}' for line in HEADER]


def test_license_header():
    """
    A file would not say whose it is and what may be done with it.

    ament_copyright can't read SPDX tags: it wants the text of the license in each file.
    """
    files = files_in(HEADED_PLACES, tuple(COMMENT_OF))
    assert len(files) > 700
    assert not [str(path.relative_to(ROOT)) for path in files if not has_header(path)]


@pytest.mark.parametrize('text', [
    '', 'number = 3\n', f'# {HEADER[0]}\n', f'# {HEADER[1]}\n# {HEADER[0]}\n',
    f'\n# {HEADER[0]}\n# {HEADER[1]}\n', f'// {HEADER[0]}\n// {HEADER[1]}\n',
    f'# {HEADER[0]}\n# SPDX-License-Identifier: MIT\n',
    f'"""Do it."""\n# {HEADER[0]}\n# {HEADER[1]}\n'])
def test_a_wrong_license_header_is_found(tmp_path, text):
    """A check that takes anything would let files without a license pass."""
    path = tmp_path / 'module.py'
    path.write_text(text, encoding='utf-8')
    assert not has_header(path)
    path.write_text(f'# {HEADER[0]}\n# {HEADER[1]}\n{text}', encoding='utf-8')
    assert has_header(path)


def test_license_file():
    """The license that the headers name would not be there to read."""
    text = (ROOT / 'LICENSE').read_text(encoding='utf-8')
    assert 'Apache License' in text and 'Version 2.0, January 2004' in text


def test_each_declared_linter_runs():
    """A linter of the manifest that no test runs would find errors by the hundred."""
    declared = {
        depend.name for folder in ('.', 'cloth_sim_interfaces')
        for depend in parse_package(ROOT / folder).test_depends
        if depend.name.startswith('ament_')}
    names = {'test_flake8': 'ament_flake8', 'test_pep257': 'ament_pep257'}
    assert declared == {linter for test, linter in names.items() if test in globals()}


def test_every_test_says_what_it_shows():
    """A failing test would not say what is wrong."""
    silent = [
        f'{path.relative_to(ROOT)}: {node.name}'
        for path in PYTHON_FILES if path.name.startswith('test_')
        for node in ast.walk(ast.parse(path.read_text(encoding='utf-8')))
        if isinstance(node, ast.FunctionDef) and node.name.startswith('test_')
        and not ast.get_docstring(node)]
    assert not silent


# The order of package_format3.xsd, which ament_xmllint would fetch from the internet.
MANIFEST_ORDER = (
    'name', 'version', 'description', 'maintainer', 'license', 'url', 'author', 'depends',
    'export')


def assert_in_order(path: Path) -> None:
    """Fail unless the elements of a manifest stand in the order of its schema."""
    tags = [element.tag for element in ElementTree.parse(path).getroot()]
    kinds = ['depends' if tag.endswith(('depend', '_of_group')) else tag for tag in tags]
    assert [MANIFEST_ORDER.index(kind) for kind in kinds] == sorted(
        MANIFEST_ORDER.index(kind) for kind in kinds)


@pytest.mark.parametrize('folder', ['.', 'cloth_sim_interfaces'])
def test_package_manifest(folder):
    """Colcon, rosdep and bloom would not accept the manifest."""
    warnings: list[str] = []
    package = parse_package(ROOT / folder, warnings=warnings)
    package.validate()
    assert not warnings
    assert_in_order(ROOT / folder / 'package.xml')
    # There is no place yet where it is published, and none is made up.
    places = [url.url for url in package.urls] + [each.email for each in package.maintainers]
    assert not [place for place in places if re.search(r'example\.(org|com|net)', place)]


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
