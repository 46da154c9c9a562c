# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""cloth_sim grasp and cloth_sim release."""

import pytest

CORNER = ('-0.45', '-0.35', '1')


def test_grasps_moves_and_releases(verb, cloth):
    """A cloth could not be picked up and let go from the command line."""
    result = verb(
        'grasp', 'hand', '--at', *CORNER, '--radius', '0.12', '--layers', 'top',
        '--max-force', '5')
    assert (result.returncode, result.stdout) == (0, 'grasp hand holds 3 nodes\n')
    assert cloth.wait_for('inputs/grasp').max_force == 5.0
    result = verb('grasp', 'hand', '--to', '-0.45', '-0.35', '1.5', '--speed', '0.25')
    assert (result.returncode, result.stdout) == (
        0, 'grasp hand moves to (-0.45, -0.35, 1.5) and arrives at 2 s\n')
    assert cloth.wait_for('inputs/grasp_target').keep_orientation
    result = verb('release', 'hand')
    assert (result.returncode, result.stdout) == (0, '3 nodes of grasp hand are free\n')


def test_takes_the_nearest_and_releases_all(verb):
    """One who gives no radius would grasp nothing, or could not let go of several at once."""
    assert verb('grasp', 'a', '--at', *CORNER).stdout == 'grasp a holds 1 nodes\n'
    other = ('0.45', '-0.35', '1')
    assert verb('grasp', 'b', '--at', *other, '--count', '1').returncode == 0
    assert verb('release').stdout == '2 nodes of 2 grasps are free\n'


@pytest.mark.parametrize('arguments', [
    ('grasp', 'hand', '--at', '0', '0', '9'), ('grasp', 'Hand!', '--at', *CORNER),
    ('grasp', 'hand', '--at', *CORNER, '--radius', '-1'),
    ('grasp', 'hand', '--at', *CORNER, '--radius', '0'),
    ('grasp', 'hand', '--at', *CORNER, '--count', '0'),
    ('grasp', 'hand', '--at', *CORNER, '--count', str(2**32)),
    ('grasp', 'hand', '--at', *CORNER, '--speed', '1'),
    ('grasp', 'hand', '--to', *CORNER), ('grasp', 'hand', '--to', *CORNER, '--speed', '0'),
    ('grasp', 'hand', '--to', *CORNER, '--radius', '1'),
    ('grasp', 'hand', '--to', *CORNER, '--layers', 'top'), ('release', 'hand')])
def test_tells_why_not(verb, cloth, arguments):
    """A mistyped request would grasp or move something else, or end in a traceback."""
    result = verb(*arguments)
    assert (result.returncode, result.stdout) == (1, '')
    assert len(result.stderr.splitlines()) == 1
    assert not cloth['inputs/grasp'] and not cloth['inputs/grasp_target']
