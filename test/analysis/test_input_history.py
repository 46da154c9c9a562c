# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0


"""Modes over the time of a recording."""

from types import SimpleNamespace

from cloth_sim_ros.analysis.input_history import ModeHistory
from cloth_sim_ros.analysis.recording import Entry


def history(*entries):
    """Return the history of messages, each a key, a time, a mode and the one before."""
    made = ModeHistory()
    for key, time, mode, *previous in entries:
        fields = {'previous_mode': previous[0]} if previous else {}
        made.read(Entry(key, time, SimpleNamespace(mode=mode, **fields)))
    return made


def test_a_switch_counts_after_the_frame_of_its_moment():
    """A frame would be said to come from a mode that it was not stepped with."""
    modes = history(
        ('inputs/mode', 0.0, 'mass_spring', ''), ('inputs/mode', 2.0, 'adaptive', 'mass_spring'))
    assert [modes.at(time) for time in (0.0, 2.0, 2.02)] == [
        'mass_spring', 'mass_spring', 'adaptive']
    assert modes.modes == ['mass_spring', 'adaptive']
    switch, = modes.switches
    assert (switch.time, switch.previous, switch.mode) == (2.0, 'mass_spring', 'adaptive')


def test_a_switch_told_twice_is_one():
    """Each switch is in ~/state as well as in ~/inputs/mode."""
    modes = history(
        ('state', 0.0, 'adaptive'), ('inputs/mode', 1.0, 'constraint', 'adaptive'),
        ('state', 1.0, 'constraint'), ('state', 3.0, 'constraint'))
    assert len(modes.switches) == 1 and modes.first == 'adaptive'


def test_a_recording_that_began_late_knows_the_mode_before():
    """The time before the first switch would be of no mode."""
    modes = history(('inputs/mode', 5.0, 'constraint', 'adaptive'))
    assert modes.at(4.0) == 'adaptive' and modes.at(6.0) == 'constraint'
    assert [switch.time for switch in modes.switches] == [5.0]


def test_without_a_word_there_is_no_mode():
    """A mode would be made up."""
    assert history().modes == [] and history().at(1.0) == ''
