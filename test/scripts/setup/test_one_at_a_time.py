# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""A set-up that waits for another one says for which."""

import os
from pathlib import Path
import re
import signal
import subprocess

import pytest
from session_processes import kill_all_of
from session_processes import processes_of
from setup_parts import start_bash

PARTS = 'progress one_at_a_time'
HOLD = 'one_at_a_time\necho has it\nlong_step "Working" no_words sleep 300'


@pytest.fixture
def holder(tmp_path):
    """Start a set-up that has the lock and works."""
    process = start_bash(PARTS, HOLD, tmp_path, root=str(tmp_path))
    assert process.stdout.readline() == 'has it\n'
    assert process.stdout.readline() == 'Working ...\n'
    yield process
    kill_all_of(process.pid)
    process.communicate(timeout=300.0)


def test_the_other_set_up_is_named(tmp_path, holder):
    """A user would wait without learning for what, or how long already."""
    waiting = start_bash(PARTS, 'one_at_a_time\necho goes on', tmp_path, root=str(tmp_path))
    said = waiting.stdout.readline()
    assert re.fullmatch(
        r'Waiting for another set-up of this checkout to end: '
        rf'process {holder.pid}, started at \d\d:\d\d:\d\d\.\n', said)
    os.kill(holder.pid, signal.SIGTERM)
    assert waiting.communicate(timeout=300.0)[0] == 'goes on\n'


def test_what_a_killed_set_up_left_behind_is_named(tmp_path, holder):
    """After SIGKILL a pip that nobody sees would make every later set-up wait for ever."""
    child = child_of(holder.pid, ['sleep', '300'])
    holder.kill()
    holder.wait()
    waiting = start_bash(PARTS, 'one_at_a_time\necho goes on', tmp_path, root=str(tmp_path))
    said = waiting.stdout.readline()
    assert f'left behind when it was killed: process {child} (sleep 300), started at ' in said
    command = said.partition('To end it: ')[2]
    assert command.startswith('kill -- -')
    subprocess.run(command, shell=True, check=True)
    assert waiting.communicate(timeout=300.0)[0] == 'goes on\n'


def child_of(session, command):
    """Return the one process of a session with this command."""
    while running := processes_of(session):
        for pid in running:
            try:
                words = Path(f'/proc/{pid}/cmdline').read_text().split('\0')[:-1]
            except FileNotFoundError:
                continue  # a short-lived one that has ended meanwhile
            if words == command:
                return pid
    raise AssertionError(f'{command} does not run')


def test_a_short_part_that_was_left_behind_is_named(tmp_path):
    """It would be taken for a set-up, or be ended with the shell of the one who called it."""
    holder = start_bash(PARTS, 'one_at_a_time\nsleep 300\n:', tmp_path, root=str(tmp_path))
    child = child_of(holder.pid, ['sleep', '300'])
    holder.kill()
    # Until then it still has the lock.
    holder.wait(300.0)
    waiting = start_bash(PARTS, 'one_at_a_time\necho goes on', tmp_path, root=str(tmp_path))
    said = waiting.stdout.readline()
    assert f'process {child} (sleep 300), started at ' in said
    assert said.endswith(f'To end it: kill {child}\n')
    os.kill(child, signal.SIGKILL)
    assert waiting.communicate(timeout=300.0)[0] == 'goes on\n'
    holder.communicate(timeout=300.0)
