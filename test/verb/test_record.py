# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""cloth_sim record."""

from pathlib import Path

from recorded import Recorded


def test_records(verb, verb_node):
    """A recording could not be made from the command line, or its path would not be printed."""
    started = verb('record', 'start', 'by_hand')
    assert started.returncode == 0, started.stderr
    path = Path(started.stdout.strip())
    assert path == verb_node.folder / 'bags' / 'by_hand'
    again = verb('record', 'start')
    assert again.returncode == 1
    assert '`cloth_sim record stop`' in again.stderr
    stopped = verb('record', 'stop')
    assert (stopped.returncode, stopped.stdout) == (0, f'closed {path}\n')
    assert Recorded(path).messages('points')
    assert verb('record', 'stop').returncode == 1
