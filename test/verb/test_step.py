# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""cloth_sim pause, step, resume and reset: one after the other, as they are used."""


def test_drives_a_run(verb, cloth):
    """A run could not be held, stepped, let go and put back from the command line."""
    result = verb('step', '40')
    assert (result.returncode, result.stdout) == (0, '40 steps done, now at 0.2 s\n')
    assert verb('step').stdout == '1 steps done, now at 0.205 s\n'
    assert verb('resume').stdout.startswith('running at 0.205')
    refused = verb('step')
    assert (refused.returncode, refused.stdout) == (1, '')
    assert 'pause it first' in refused.stderr and '`cloth_sim pause`' in refused.stderr
    assert verb('pause').stdout.startswith('paused at ')
    assert verb('reset').stdout == 'reset to the start, paused\n'
    assert cloth.wait_for('inputs/command').command == 'reset'


def test_shows_the_cloth_on_the_way(verb, cloth):
    """What is stepped by hand would be recorded as one leap."""
    cloth.clear()
    result = verb('step', '10', '--every', '4')
    assert result.stdout == '10 steps done, 4 at a time, now at 0.05 s\n'
    cloth.wait_for('stats', lambda stats: stats.steps == 10)
    # The moment before may have been shown again.
    assert {4, 8, 10} <= {stats.steps for stats in cloth['stats']} <= {0, 4, 8, 10}
    assert verb('step', '4', '--every', '4').stdout.startswith('4 steps done, now at ')
    assert verb('step', '0', '--every', '0').returncode == 1


def test_refuses_what_is_no_number_of_steps(verb):
    """A mistyped number would end in a traceback."""
    for steps, code in (('many', 2), ('-1', 2), (str(2**32), 2), ('0', 1)):
        result = verb('step', steps)
        assert result.returncode == code
        assert 'Traceback' not in result.stderr
