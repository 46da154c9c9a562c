# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""Find a Python on paths that hold bad ones."""

import os
from pathlib import Path
import shlex
import subprocess
import sys

import pytest

PARTS = Path(__file__).resolve().parents[3] / 'scripts' / 'setup'

BROKEN = {
    'shim of nothing': 'echo "no such version" >&2; exit 127',
    'too old': f'exec {shlex.quote(sys.executable)} -c "import sys; sys.exit(1)"',
    'silent': 'exit 0',
}


def found_python(path: str) -> str:
    """Run find_python with this PATH and return its choice."""
    done = subprocess.run(
        ['bash', '-euc',
         f'. {shlex.quote(str(PARTS))}/find_python.sh; ros_source=wheels; PATH={path}; '
         'find_python; echo "$python"'],
        env=os.environ, capture_output=True, text=True, check=True)
    return done.stdout.strip()


@pytest.mark.parametrize('script', BROKEN.values(), ids=BROKEN)
def test_a_python_that_does_not_run_is_passed_over(script, tmp_path):
    """A pyenv shim without a version behind it would stop the set-up."""
    bad, good = tmp_path / 'bad', tmp_path / 'good'
    for folder in (bad, good):
        folder.mkdir()
    for name in ('python3', 'python3.10', 'python3.11', 'python3.12', 'python3.13', 'python3.14'):
        shim = bad / name
        shim.write_text(f'#!/bin/sh\n{script}\n')
        shim.chmod(0o755)
    (good / 'python3').symlink_to(sys.executable)
    chosen = found_python(f'{bad}:{good}:/usr/bin:/bin')
    assert chosen
    answer = subprocess.run([chosen, '-c', 'print("runs")'], capture_output=True, text=True)
    assert answer.stdout == 'runs\n'
