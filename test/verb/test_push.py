# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""cloth_sim push."""

from geometry_msgs.msg import Point
from geometry_msgs.msg import Vector3


def test_pushes_all(verb, cloth):
    """The command would push with another force, or not at all."""
    result = verb('push', '--force', '0', '-0.5', '2.5', '--duration', '0.2')
    assert result.returncode == 0, result.stderr
    assert result.stdout == 'pushing 78 nodes for 0.2 s, impulse 0 -0.1 0.5 N s\n'
    told = cloth.wait_for('inputs/push')
    assert (told.force, told.region) == (Vector3(y=-0.5, z=2.5), 'all')


def test_pushes_a_place(verb, cloth):
    """The command would push at another place."""
    result = verb(
        'push', '--force', '1', '0', '0', '--center', '0.1', '0', '1', '--radius', '0.25')
    assert result.returncode == 0, result.stderr
    told = cloth.wait_for('inputs/push')
    assert (told.region, told.center, told.radius) == ('sphere', Point(x=0.1, z=1.0), 0.25)


def test_clears(verb, cloth):
    """A push could not be ended from the command line."""
    assert verb('push', '--force', '1', '0', '0', '--duration', '9').returncode == 0
    result = verb('push', '--clear')
    assert (result.returncode, result.stdout) == (0, '1 pushes cleared\n')


def test_tells_why_not(verb, cloth):
    """A script would go on as if it had pushed."""
    result = verb('push', '--force', 'nan', '0', '0')
    assert (result.returncode, result.stdout) == (1, '')
    assert 'must be 3 finite numbers' in result.stderr
    assert not cloth['inputs/push']


def test_needs_a_force(verb):
    """A push without a force would push with some force."""
    assert verb('push').returncode == 2
