# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""Run scripts/setup.sh again in a checkout that is set up."""

import os
from pathlib import Path
import subprocess

ROOT = Path(__file__).resolve().parents[2]
VENV = ROOT / '.venv'


def setup(*arguments: str, **environment: str) -> subprocess.CompletedProcess:
    """Run the set-up of this checkout with a changed environment."""
    return subprocess.run(
        [ROOT / 'scripts' / 'setup.sh', *arguments], env={**os.environ, **environment},
        stdin=subprocess.DEVNULL, capture_output=True, text=True)


def state_of(folder: Path) -> dict[str, tuple[int, int]]:
    """Return size and time of change of every file of the set-up."""
    return {
        str(path): (path.lstat().st_size, path.lstat().st_mtime_ns)
        for path in folder.rglob('*') if '__pycache__' not in path.parts}


def path_without(folder: Path, *commands: str) -> str:
    """Make a PATH that lacks these commands."""
    folder.mkdir()
    for place in ('/usr/bin', '/bin', '/usr/sbin', '/sbin'):
        for program in Path(place).iterdir():
            link = folder / program.name
            if program.name not in commands and not link.is_symlink():
                link.symlink_to(program)
    return str(folder)


def test_second_run_needs_no_network_and_changes_nothing():
    """Starting the demo again would wait for downloads, or fail where there is no network."""
    assert setup('--tests').returncode == 0
    before = state_of(VENV)
    nowhere = 'http://127.0.0.1:9'
    done = setup(
        '--tests', PIP_INDEX_URL=nowhere, http_proxy=nowhere, https_proxy=nowhere,
        HTTP_PROXY=nowhere, HTTPS_PROXY=nowhere)
    assert done.returncode == 0, done.stderr
    # Before it, a notice where the shader cache is switched off.
    assert done.stdout.splitlines()[-1].startswith('cloth_sim_ros is set up')
    assert state_of(VENV) == before


def test_unknown_argument_is_refused():
    """A mistyped --tests would leave the tests without what they need."""
    done = setup('--test')
    assert done.returncode != 0
    assert '--test: give --view, --cpp, --tests, --long or nothing' in done.stderr


def test_what_cannot_be_installed_is_named(tmp_path):
    """A user who may not install packages would not learn which ones to ask for."""
    before = state_of(VENV)
    done = setup(PATH=path_without(tmp_path / 'bin', 'cmake', 'apt-get', 'sudo'))
    assert done.returncode != 0
    assert 'missing here, by their Debian names: cmake:' in done.stderr
    assert state_of(VENV) == before


def test_a_missing_package_is_installed_only_by_root(tmp_path):
    """A user without rights would get a failing apt-get instead of the command to request."""
    path = path_without(tmp_path / 'bin', 'cmake', 'sudo')
    done = subprocess.run(
        ['bash', '-c', 'id() { echo 1000; }; export -f id; exec scripts/setup.sh'],
        cwd=ROOT, env={**os.environ, 'PATH': path}, stdin=subprocess.DEVNULL,
        capture_output=True, text=True)
    assert done.returncode != 0
    assert 'apt-get install cmake\n' in done.stderr
