# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""The example recording is what bags/README.md says of it."""

from pathlib import Path
import re
import shlex
import subprocess
import sys

from cloth_sim_ros.analysis.recording import Recording
import pytest

ROOT = Path(__file__).resolve().parents[2]
EXAMPLE = ROOT / 'bags' / 'example'
README = (ROOT / 'bags' / 'README.md').read_text(encoding='utf-8')
# A command or a program, and what it prints.
COMMANDS = re.findall(r'\n {4}(cloth_sim [^\n]*)\n\n```\n(.*?)```', README, re.DOTALL)
PROGRAMS = re.findall(r'```python\n(.*?)```\n\nprints\n\n```\n(.*?)```', README, re.DOTALL)


def printed(*arguments):
    """Return what Python prints in the folder that the commands are for."""
    done = subprocess.run(
        [sys.executable, *arguments], cwd=ROOT, capture_output=True, text=True)
    assert done.returncode == 0, done.stderr
    return done.stdout


def test_it_is_small():
    """Every clone of the project would carry it."""
    assert sum(file.stat().st_size for file in EXAMPLE.iterdir()) < 1_000_000


def test_it_holds_the_whole_run():
    """It could not be run again: something was done before its first frame, or is missing."""
    entries = list(Recording(EXAMPLE).entries(
        'points', 'inputs/push', 'inputs/mode', 'inputs/pin', 'inputs/parameters'))
    times = [entry.time for entry in entries if entry.key == 'points']
    assert times == pytest.approx([0.05 * number for number in range(len(times))])
    done = {
        key: [entry.message for entry in entries if entry.key == f'inputs/{key}']
        for key in ('push', 'mode', 'pin', 'parameters')}
    assert len(done['push']) == len(done['parameters']) == 1
    assert [message.mode for message in done['mode']] == ['mass_spring', 'constraint']
    assert [(message.row, message.col, message.pinned) for message in done['pin']] == [
        (0, 0, False)]


def test_it_tells_nothing_of_the_machine_it_was_made_on():
    """Somebody's folders would be published."""
    states = [entry.message for entry in Recording(EXAMPLE).entries('state')]
    assert all(re.match(r'(/tmp/\w+/example)?$', state.recording_path) for state in states)


def test_commands_print_what_is_shown():
    """A user would see something else than what is explained."""
    for command, output in COMMANDS:
        assert printed('-m', 'cloth_sim_ros.verb', *shlex.split(command)[1:]) == output


def test_programs_print_what_is_shown():
    """A user would copy a program that does not work."""
    assert PROGRAMS
    for program, output in PROGRAMS:
        assert printed('-c', program) == output
