# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""How far a step is, is said in plain words and not by the last line of its command."""

import sys

from setup_parts import PARTS
from setup_parts import run_bash

FOUND = """\
Collecting setuptools==79.0.1 (from -r /dev/fd/63 (line 1))
  Downloading setuptools-79.0.1-py3-none-any.whl (1.3 MB)
Installing collected packages: setuptools
Successfully installed setuptools-79.0.1
Requirement already satisfied: PyYAML==6.0.3 in ./site-packages (from -r run.txt (line 3))
Collecting numpy==2.4.6 (from -r run.txt (line 9))
  Downloading numpy-2.4.6-cp311-cp311-manylinux_2_28_x86_64.whl (16.6 MB)
Requirement already satisfied: PyYAML==6.0.3 in ./site-packages (from mcap)
Collecting mcap==1.6.0 (from -r run.txt (line 12))
"""


def words(function, text, folder, **variables):
    """Return what a function says about a log."""
    (folder / 'log').write_text(text)
    code, output = run_bash(
        'counts', f'{function} log', folder, venv=str(folder), **variables)
    assert code == 0, output
    return output


def test_packages_are_counted_while_pip_looks_for_them(tmp_path):
    """For minutes a user would read names of files, and not how many are still to come."""
    said = words('pip_words', FOUND, tmp_path, packages_total='141', packages_before='2')
    assert said == '3 of 141 packages found'


def test_packages_are_counted_while_pip_installs_them(tmp_path):
    """The longest part, of which pip says nothing, would look like a hang."""
    site = tmp_path / 'lib' / 'python3.12' / 'site-packages'
    for name in ('pip', 'setuptools', 'PyYAML', 'numpy', 'mcap'):
        (site / f'{name}-1.dist-info').mkdir(parents=True)
        if name != 'mcap':  # which pip is at work on
            (site / f'{name}-1.dist-info' / 'INSTALLER').write_text('pip\n')
    said = words(
        'pip_words', FOUND + 'Installing collected packages: numpy, mcap, lz4\n', tmp_path,
        packages_total='141', packages_before='3')
    assert said == '1 of 3 packages installed'


def test_system_packages_are_counted(tmp_path):
    """A user would read apt's messages, or nothing."""
    begun = '0 upgraded, 12 newly installed, 0 to remove and 3 not upgraded.\n'
    assert words('apt_words', 'Reading package lists...\n', tmp_path) == ''
    assert words(
        'apt_words', begun + 'Setting up libegl1 (1.7.0)\nSetting up cmake (3.28)\n',
        tmp_path) == '2 of 12 packages installed'


def test_the_share_that_is_built_is_said(tmp_path):
    """A user would read compiler commands."""
    assert words('cmake_words', '-- Configuring\n', tmp_path) == ''
    said = words('cmake_words', '[  3%] Building\n[ 41%] Linking\nnote\n', tmp_path)
    assert said == '41 % built'


def test_the_share_is_that_of_all_packages(tmp_path):
    """A user would read of the package that printed last, and see the share fall."""
    for name, text in (('a', '[ 90%] Linking\n'), ('b', '[ 30%] Building\n'), ('c', '')):
        (tmp_path / name).write_text(text)
    code, output = run_bash('counts', 'cmake_words a b c', tmp_path, venv=str(tmp_path))
    assert (code, output) == (0, '40 % built')


def test_only_requirements_for_this_python_are_counted(tmp_path):
    """The count would never reach its end."""
    (tmp_path / 'lock.txt').write_text(
        '# made by scripts/lock.sh\nnumpy==2.4.6 ; python_full_version >= "3.10" \\\n'
        '    --hash=sha256:00\ntomli==2.5.0 ; python_full_version < "3.10" \\\n'
        '    --hash=sha256:00\nmcap==1.6.0 \\\n    --hash=sha256:00\n')
    code, output = run_bash(
        'counts', 'requirements_here lock.txt', tmp_path, venv=str(PARTS.parents[1] / '.venv'))
    assert code == 0, output
    assert output == '2\n', sys.version
