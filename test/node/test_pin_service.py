# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""Holding nodes and letting them go."""

from cloth_sim_interfaces.srv import SetPin
from cloth_sim_interfaces.srv import Step
from cloth_sim_ros.sim.snapshot import FLAG_PINNED
from geometry_msgs.msg import Point
import pytest


def test_pins_and_releases_a_node(cloth):
    """A pin would not hold, a released one would, or the recording would not know."""
    response = cloth.call(SetPin, 'set_pin', row=5, col=3)
    assert (response.success, response.row, response.col) == (True, 5, 3)
    told = cloth.wait_for('inputs/pin')
    assert (told.row, told.col, told.pinned) == (5, 3, True)
    cloth.call(Step, 'step', steps=2)
    assert cloth.frame(2)['flags'][5, 3] & FLAG_PINNED
    cloth.clear()
    assert cloth.call(SetPin, 'set_pin', row=5, col=3, release=True).success
    assert not cloth.wait_for('inputs/pin').pinned
    cloth.call(Step, 'step', steps=2)
    assert not cloth.frame(4)['flags'][5, 3] & FLAG_PINNED


def test_finds_the_nearest_node(cloth, simulation):
    """A pin by point would hold another node than the one meant."""
    expected = simulation.nearest_node((0.21, -0.12, 1.05))
    response = cloth.call(
        SetPin, 'set_pin', use_point=True, point=Point(x=0.21, y=-0.12, z=1.05))
    assert (response.success, response.row, response.col) == (True, expected.row, expected.col)
    assert response.distance == pytest.approx(expected.distance)
    assert response.message == f'node (5, 7) is pinned, {expected.distance:.3f} m from the point'


def test_refuses_a_point_far_from_the_cloth(cloth):
    """A request with the wrong point would pin or release a node at the other end of the room."""
    response = cloth.call(SetPin, 'set_pin', use_point=True, point=Point(x=0.45, y=0.35, z=100.0))
    assert not response.success
    assert not cloth['inputs/pin']
    assert 'no node is within 0.1 m of the point (0.45, 0.35, 100)' in response.message
    assert 'the nearest, (0, 9), is 99 m away' in response.message
    assert 'max_distance' in response.message


@pytest.mark.parametrize('max_distance, success', [
    (0.2, False), (0.4, True), (float('inf'), True), (-0.1, False), (float('nan'), False)])
def test_the_caller_says_how_far_a_node_may_be(cloth, max_distance, success):
    """Somebody who points from afar could not, or a distance that is none would be taken."""
    response = cloth.call(
        SetPin, 'set_pin', use_point=True, point=Point(x=0.45, y=0.35, z=1.3),
        max_distance=max_distance)
    assert response.success == success
    assert 'max_distance' in response.message or (response.row, response.col) == (0, 9)


@pytest.mark.parametrize('row, col', [(8, 0), (0, 10), (2**32 - 1, 2**32 - 1)])
def test_refuses_a_node_outside(cloth, row, col):
    """A pin outside the cloth would hold some other node, or end the node."""
    response = cloth.call(SetPin, 'set_pin', row=row, col=col)
    assert not response.success
    assert f'({row}, {col})' in response.message
    assert '0 to 7' in response.message and '0 to 9' in response.message
    assert not cloth['inputs/pin']


@pytest.mark.parametrize('value', [float('nan'), float('inf')])
def test_refuses_a_point_that_is_none(cloth, value):
    """A point that is no number would pin the first node."""
    response = cloth.call(SetPin, 'set_pin', use_point=True, point=Point(y=value))
    assert not response.success
    assert 'finite' in response.message
    assert not cloth['inputs/pin']
