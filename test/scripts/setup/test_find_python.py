# Copyright 2026 the cloth_sim_ros authors
#
# Licensed under the Apache License, Version 2.0 (the "License");
# you may not use this file except in compliance with the License.
# You may obtain a copy of the License at
#
#     http://www.apache.org/licenses/LICENSE-2.0
#
# Unless required by applicable law or agreed to in writing, software
# distributed under the License is distributed on an "AS IS" BASIS,
# WITHOUT WARRANTIES OR CONDITIONS OF ANY KIND, either express or implied.
# See the License for the specific language governing permissions and
# limitations under the License.

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
