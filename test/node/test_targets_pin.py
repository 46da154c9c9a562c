# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""Pins that are moved by service and by a stream of targets."""

from pathlib import Path

from cloth_sim_interfaces.msg import PinTarget
from cloth_sim_interfaces.srv import MovePin
from cloth_sim_interfaces.srv import SetPin
from cloth_sim_interfaces.srv import StartRecording
from cloth_sim_interfaces.srv import Step
from cloth_sim_ros.sim.snapshot import FLAG_PINNED
from geometry_msgs.msg import Point
import numpy as np
import pytest
from recorded import Recorded
from std_msgs.msg import Header
from std_srvs.srv import Trigger

NAN, INF = float('nan'), float('inf')
TARGET = Point(x=-0.4, y=0.35, z=1.2)
BAD = {
    'a free node': ({'row': 5, 'col': 3}, 'node (5, 3) is free and only a pin can be moved'),
    'a node outside': ({'row': 2**32 - 1}, '0 to 7'),
    'a target NaN': ({'target': Point(x=NAN)}, '3 finite numbers'),
    'an infinite target': ({'target': Point(z=-INF)}, '3 finite numbers'),
    'a negative speed': ({'speed': -0.5}, 'speed of a pin must be from 1e-06'),
    'a speed NaN': ({'speed': NAN}, 'speed of a pin must be from 1e-06'),
    'an infinite speed': ({'speed': INF}, 'speed of a pin must be from 1e-06'),
}


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
    """A NaN point would pin the first node."""
    response = cloth.call(SetPin, 'set_pin', use_point=True, point=Point(y=value))
    assert not response.success
    assert 'finite' in response.message
    assert not cloth['inputs/pin']


def test_moves_a_pin(cloth, simulation):
    """A pin would go elsewhere or at another speed, or the recording would not know."""
    cloth.call(Step, 'step', steps=3)
    simulation.step(3)
    response = cloth.call(MovePin, 'move_pin', row=0, col=0, target=TARGET, speed=0.6)
    path = simulation.move_pin(0, 0, (-0.4, 0.35, 1.2), 0.6)
    assert (response.success, response.row, response.col) == (True, 0, 0)
    assert response.arrival == path.arrival
    told = cloth.wait_for('inputs/pin_target')
    assert (told.row, told.col, told.target, told.speed) == (0, 0, TARGET, 0.6)
    assert (cloth.steps_of(told), told.header.frame_id) == (3, 'world')
    cloth.call(Step, 'step', steps=100)
    simulation.step(100)
    points = cloth.frame(103)
    assert points.tobytes() == simulation.snapshot().records.tobytes()
    assert points['z'][0, 0] == np.float32(1.2)
    assert points['flags'][0, 0] & FLAG_PINNED


def test_takes_the_usual_speed_and_the_nearest_pin(cloth):
    """A request without a speed would be refused, or one by point move a node that is free."""
    response = cloth.call(
        MovePin, 'move_pin', use_point=True, point=Point(x=0.1, y=-0.35, z=1.0),
        target=Point(x=0.45, y=0.35, z=1.5), max_distance=1.0)
    assert (response.success, response.row, response.col) == (True, 0, 9)
    assert response.distance == pytest.approx((0.35**2 + 0.7**2)**0.5)
    assert response.arrival == pytest.approx(0.5)
    assert cloth.wait_for('inputs/pin_target').speed == 1.0


@pytest.mark.parametrize('case', BAD)
def test_refuses_nonsense(cloth, case):
    """A bad target would be accepted, and make the cloth NaN."""
    change, reason = BAD[case]
    response = cloth.call(
        MovePin, 'move_pin', **{'row': 0, 'col': 0, 'target': TARGET, 'speed': 1.0, **change})
    assert not response.success
    assert reason in response.message
    assert not cloth['inputs/pin_target']


def test_refuses_a_point_far_from_every_pin(cloth):
    """A gripper that is nowhere near would drag the pin of another one."""
    response = cloth.call(
        MovePin, 'move_pin', use_point=True, point=Point(x=0.45, y=-0.35, z=1.0), target=TARGET)
    assert not response.success
    assert not cloth['inputs/pin_target']
    assert 'no pin is within 0.1 m of the point (0.45, -0.35, 1)' in response.message
    assert 'the nearest, (0, 9), is 0.7 m away' in response.message


def test_says_that_there_is_no_pin(cloth):
    """A request by point would move a node that nobody holds."""
    for col in (0, 9):
        cloth.call(SetPin, 'set_pin', row=0, col=col, release=True)
    response = cloth.call(MovePin, 'move_pin', use_point=True, target=TARGET)
    assert not response.success
    assert 'pin a node first' in response.message


def test_a_stream_of_targets_is_followed(cloth, simulation):
    """A controller's targets would be lost, or taken from a foreign frame, or bad ones taken."""
    publisher = cloth.client.node.create_publisher(PinTarget, f'{cloth.name}/pins/target', 100)
    cloth.client.spin_until(publisher.get_subscription_count, 'the node listens')
    for change, _ in BAD.values():
        publisher.publish(PinTarget(**{'target': TARGET, 'speed': 1.0, **change}))
    publisher.publish(PinTarget(header=Header(frame_id='tool0'), target=TARGET))
    for step in range(10):
        turn = 0.4 * (step + 1)
        x, z = -0.45 + 0.05 * np.sin(turn), 1.05 - 0.05 * np.cos(turn)
        publisher.publish(PinTarget(
            header=Header(frame_id='world' if step % 2 else ''), target=Point(x=x, y=0.35, z=z),
            speed=4.0))
        cloth.client.spin_until(
            lambda: len(cloth['inputs/pin_target']) == step + 1, 'the target is taken')
        assert cloth.call(Step, 'step', steps=2).success
        simulation.move_pin(0, 0, (x, 0.35, z), 4.0)
        simulation.step(2)
    assert cloth.frame(20).tobytes() == simulation.snapshot().records.tobytes()
    cloth.client.node.destroy_publisher(publisher)


def test_a_recorded_run_can_be_made_again(cloth, simulation):
    """A recording would not have all that moved the pins, or not when."""
    path = Path(cloth.call(StartRecording, 'start_recording').path)
    for step, (col, z) in enumerate([(0, 1.2), (9, 0.9), (0, 1.0), (5, 1.4), (9, 1.3)]):
        if col == 5:
            cloth.call(SetPin, 'set_pin', row=0, col=col)
        assert cloth.call(
            MovePin, 'move_pin', row=0, col=col, target=Point(x=0.1 * col - 0.45, z=z),
            speed=1.0 + 0.3 * step).success
        cloth.call(Step, 'step', steps=7)
    cloth.call(Trigger, 'stop_recording')
    bag = Recorded(path)
    targets, pins = bag.messages('inputs/pin_target'), bag.messages('inputs/pin')
    assert len(targets) == 5
    for step in range(35):
        for pin in pins:
            if cloth.steps_of(pin) == step:
                simulation.pin(pin.row, pin.col)
        for told in targets:
            if cloth.steps_of(told) == step:
                simulation.move_pin(
                    told.row, told.col, (told.target.x, told.target.y, told.target.z),
                    told.speed)
        simulation.step()
    assert cloth.frame(35).tobytes() == simulation.snapshot().records.tobytes()


def test_a_reset_ends_the_moves(cloth, simulation):
    """A pin would go on to the target of the run before."""
    assert cloth.call(MovePin, 'move_pin', target=TARGET).success
    cloth.call(Step, 'step', steps=3)
    cloth.call(Trigger, 'reset')
    cloth.clear()
    cloth.call(Step, 'step', steps=10)
    simulation.step(10)
    assert cloth.frame(10).tobytes() == simulation.snapshot().records.tobytes()
