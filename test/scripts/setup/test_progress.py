# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""A long step shows that it is alive, fails with what it printed, and ends with the set-up."""

import os
import re
import signal

import pytest
from session_processes import processes_of
from setup_parts import run_bash
from setup_parts import start_bash


@pytest.mark.parametrize('number', [
    signal.SIGINT, *(pytest.param(number, marks=pytest.mark.long)
                     for number in (signal.SIGTERM, signal.SIGHUP))])
def test_a_killed_set_up_takes_its_command_along(tmp_path, number):
    """A set-up that was killed would leave pip writing into the environment."""
    process = start_bash(
        'progress', 'work() { echo working > begun; sleep 300 & sleep 300; }\n'
        'long_step "Working" no_words work', tmp_path)
    while not (tmp_path / 'begun').exists():
        assert process.poll() is None
    os.kill(process.pid, number)
    output = process.communicate(timeout=300.0)[0]
    assert process.returncode == 128 + number
    assert f'stopped by {number.name}: run it again to go on' in output
    assert processes_of(process.pid) == []


def test_a_set_up_killed_as_a_step_begins(tmp_path):
    """The set-up would not know yet what to end."""
    process = start_bash(
        'progress', 'work() { kill -INT $$; sleep 300; }\n'
        # Bash starts the command well before it notes which process that is.
        "set -T; trap 'case $BASH_COMMAND in step=?!) sleep 1; esac' DEBUG\n"
        'long_step "Working" no_words work', tmp_path)
    process.communicate(timeout=300.0)
    assert process.returncode == 128 + signal.SIGINT
    assert processes_of(process.pid) == []


def test_a_failing_command_is_shown(tmp_path):
    """The user would learn that a step failed, but not why."""
    code, output = run_bash(
        'progress', 'work() { echo no such package; return 3; }\n'
        'long_step "Working" no_words work; echo went on', tmp_path, TMPDIR=str(tmp_path))
    assert code == 1
    assert 'no such package' in output
    assert 'Working failed; all of its output is in' in output
    assert 'went on' not in output


def test_a_step_may_go_on_after_a_failing_part(tmp_path):
    """`apt-get update` of one dead mirror would stop the installation that does not need it."""
    code, output = run_bash(
        'progress', 'work() { false; true; }\nlong_step "Working" no_words work', tmp_path)
    assert code == 0, output
    assert re.fullmatch(r'Working \.\.\.\nWorking: done in \d+ s\.\n', output)
