# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""cloth_sim pin."""

import pytest


def test_pins_and_releases(verb, cloth):
    """A pin could not be set or taken away from the command line."""
    result = verb('pin', '5', '3')
    assert (result.returncode, result.stdout) == (0, 'node (5, 3) is pinned\n')
    result = verb('pin', '5', '3', '--release')
    assert (result.returncode, result.stdout) == (0, 'node (5, 3) is free\n')
    told = cloth.client.spin_until(lambda: cloth['inputs/pin'][1:], 'both are published')
    assert not told[0].pinned


def test_takes_the_nearest(verb):
    """A pin by point would hold another node."""
    result = verb('pin', '--near', '-0.45', '0.35', '1')
    assert (result.returncode, result.stdout) == (
        0, 'node (0, 0) is pinned, 0.000 m from the point\n')


def test_takes_no_node_far_away(verb, cloth):
    """A mistyped point would pin a node, or one that is meant could not be had."""
    far = ('--near', '-0.45', '0.35', '1.5')
    result = verb('pin', *far)
    assert (result.returncode, result.stdout) == (1, '')
    assert 'the nearest, (0, 0), is 0.5 m away' in result.stderr
    assert not cloth['inputs/pin']
    result = verb('pin', *far, '--max-distance', '0.6')
    assert (result.returncode, result.stdout) == (
        0, 'node (0, 0) is pinned, 0.500 m from the point\n')


def test_moves(verb, cloth):
    """A pin could not be moved from the command line, or at another speed than asked for."""
    result = verb('pin', '0', '9', '--to', '0.45', '0.35', '1.5', '--speed', '0.25')
    assert (result.returncode, result.stdout) == (
        0, 'node (0, 9) moves to (0.45, 0.35, 1.5) and arrives at 2 s\n')
    result = verb('pin', '--near', '-0.45', '0.3', '1', '--to', '-0.45', '0.35', '1.5')
    assert (result.returncode, result.stdout) == (
        0, 'node (0, 0), 0.050 m from the point, moves to (-0.45, 0.35, 1.5) and arrives at '
           '0.5 s\n')
    told = cloth.client.spin_until(lambda: cloth['inputs/pin_target'][1:], 'both are published')
    assert told[0].speed == 1.0


@pytest.mark.parametrize('arguments', [
    ('5',), (), ('1', '2', '--near', '0', '0', '0'), ('-1', '0'), ('0', str(2**32)), ('8', '0'),
    ('0', '0', '--max-distance', '1'), ('--near', '0', '0', '1', '--max-distance', '0'),
    ('0', '0', '--speed', '1'), ('0', '0', '--to', '0', '0', '1', '--speed', '0'),
    ('5', '3', '--to', '0', '0', '1')])
def test_tells_why_not(verb, cloth, arguments):
    """A mistyped node would be pinned as some other one, or end in a traceback."""
    result = verb('pin', *arguments)
    assert (result.returncode, result.stdout) == (1, '')
    assert len(result.stderr.splitlines()) == 1
    assert not cloth['inputs/pin']
