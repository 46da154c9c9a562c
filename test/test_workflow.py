# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""The workflow that tests each change runs what is there, on the systems that README names."""

from pathlib import Path
import re
import subprocess

import yaml

ROOT = Path(__file__).resolve().parents[1]
JOB = yaml.safe_load(
    (ROOT / '.github' / 'workflows' / 'tests.yml').read_text(encoding='utf-8'))['jobs']['tests']
COMMANDS = [step['run'] for step in JOB['steps'] if 'run' in step]


def test_it_runs_scripts_that_are_there():
    """A change would be tested by a script that was renamed."""
    scripts = {name for command in COMMANDS for name in re.findall(r'scripts/\w+\.sh', command)}
    assert scripts == {'scripts/test.sh', 'scripts/env.sh', 'scripts/demo.sh'}
    assert all((ROOT / script).is_file() for script in scripts)


def test_its_commands_are_bash():
    """A slip in a command would show on the server only."""
    for command in COMMANDS:
        without_expressions = re.sub(r'\$\{\{.*?\}\}', 'value', command)
        done = subprocess.run(
            ['bash', '-n'], input=without_expressions, capture_output=True, text=True)
        assert done.returncode == 0, done.stderr


def test_it_has_every_system_that_readme_promises():
    """A user would be promised a system that nobody tests."""
    readme = ' '.join((ROOT / 'README.md').read_text(encoding='utf-8').split())
    assert 'Debian 12 or Ubuntu 24.04' in readme
    assert set(JOB['strategy']['matrix']['image']) == {'ros:jazzy', 'ubuntu:24.04', 'debian:12'}
