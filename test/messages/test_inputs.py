# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""What was done to the cloth, as messages."""

from cloth_sim_interfaces.msg import Command
from cloth_sim_ros.messages.body_frames import pose_message
from cloth_sim_ros.messages.inputs import input_message
from cloth_sim_ros.messages.inputs import parameters_message
from cloth_sim_ros.messages.inputs import place_message
from cloth_sim_ros.sim.inputs import ClearPushes
from cloth_sim_ros.sim.inputs import MoveCollider
from cloth_sim_ros.sim.inputs import MoveGrasp
from cloth_sim_ros.sim.inputs import MovePin
from cloth_sim_ros.sim.inputs import Pin
from cloth_sim_ros.sim.inputs import PushNodes
from cloth_sim_ros.sim.inputs import Release
from cloth_sim_ros.sim.inputs import ReplaceState
from cloth_sim_ros.sim.inputs import Reset
from cloth_sim_ros.sim.inputs import SetMode
from cloth_sim_ros.sim.inputs import SetWind
from cloth_sim_ros.sim.inputs import TakeGrasp
from cloth_sim_ros.sim.inputs import Unpin
from cloth_sim_ros.sim.model.pose import Pose
from cloth_sim_ros.sim.model.push import Push
from cloth_sim_ros.sim.model.scene_fields import SCENE_FIELDS
from cloth_sim_ros.sim.scene import Scene
import numpy as np
import pytest
from rclpy.parameter import Parameter
from rclpy.serialization import deserialize_message
from rclpy.serialization import serialize_message
from springs import SPRINGS


def told(given, key):
    """Return the message of ``given`` at 0.5 s as it arrives."""
    topic, message = input_message(given, 0.5, 'world')
    assert topic == key
    message = deserialize_message(serialize_message(message), type(message))
    assert message.header.stamp.nanosec == 500000000 and message.header.frame_id == 'world'
    return message


def test_a_push_is_told_in_full():
    """A run could not be pushed again as it was."""
    push = Push.checked(
        force=(1.0, 2.0, 3.0), start=4.0, duration=5.0, region='sphere',
        center=(6.0, 7.0, 8.0), radius=9.0)
    message = told(PushNodes(push), 'inputs/push')
    assert Push(
        force=(message.force.x, message.force.y, message.force.z),
        start=message.start, duration=message.duration, region=message.region,
        center=(message.center.x, message.center.y, message.center.z),
        radius=message.radius) == push


def test_a_target_is_told_in_full():
    """A pin could not be moved again as it was."""
    message = told(MovePin(3, 4, (1.0, 2.0, 3.0), 0.25), 'inputs/pin_target')
    assert (message.row, message.col, message.speed) == (3, 4, 0.25)
    assert (message.target.x, message.target.y, message.target.z) == (1.0, 2.0, 3.0)


def test_a_grasp_is_told_in_full():
    """A run could not hold the same nodes again, at the same place."""
    position, turn = (1.0, 2.0, 3.0), (0.6, 0.0, 0.0, 0.8)
    message = told(
        TakeGrasp('hand', position, turn, max_force=2.5, nodes=((3, 4), (7, 0))), 'inputs/grasp')
    assert (message.name, message.grasped, message.max_force) == ('hand', True, 2.5)
    assert list(zip(message.rows, message.cols)) == [(3, 4), (7, 0)]
    assert message.pose == pose_message(Pose(position, turn))
    assert not told(Release('hand'), 'inputs/grasp').by_force
    lost = told(Release('hand', by_force=True), 'inputs/grasp')
    assert (lost.name, lost.grasped, lost.by_force) == ('hand', False, True)


@pytest.mark.parametrize(('kind', 'key'), [
    (MoveGrasp, 'inputs/grasp_target'), (MoveCollider, 'inputs/collider_target')])
def test_a_move_of_a_frame_is_told_in_full(kind, key):
    """A collider could not be moved again as it was."""
    target, turn = (1.0, 2.0, 3.0), (0.6, 0.0, 0.0, 0.8)
    for orientation in (None, turn):
        message = told(kind('ball', target, orientation, 0.25, 0.75), key)
        assert (message.name, message.speed, message.angular_speed) == ('ball', 0.25, 0.75)
        assert message.keep_orientation == (orientation is None)
        assert message.pose.position == pose_message(Pose(target)).position
        assert orientation is None or message.pose == pose_message(Pose(target, turn))


def test_a_collider_at_rest_is_told():
    """A recording that begins late would have a moved collider where its scene has it."""
    # A speed of 0 says that it is there.
    place = place_message('ball', Pose((1.0, 2.0, 3.0), (0.6, 0.0, 0.0, 0.8)), 0.5, 'world')
    assert (place.speed, place.pose.position.y) == (0.0, 2.0)


def test_pin_wind_mode_and_command_are_told():
    """The order of inputs would be lost."""
    pin = told(Pin(3, 4), 'inputs/pin')
    assert (pin.row, pin.col, pin.pinned) == (3, 4, True)
    assert not told(Unpin(3, 4), 'inputs/pin').pinned
    wind = told(SetWind((1.0, 2.0, 3.0)), 'inputs/wind').vector
    assert (wind.x, wind.y, wind.z) == (1.0, 2.0, 3.0)
    mode = told(SetMode('adaptive', 'constraint'), 'inputs/mode')
    assert (mode.mode, mode.previous_mode) == ('adaptive', 'constraint')
    assert told(ClearPushes(), 'inputs/command').command == Command.CLEAR_PUSHES
    assert told(Reset(), 'inputs/command').command == Command.RESET


def test_what_changes_nothing_has_no_message():
    """A reader would see a switch of the mode that was none."""
    assert input_message(SetMode('adaptive', 'adaptive'), 0.5, 'world') is None


def test_an_input_without_a_message_is_told_from_one():
    """A recording would lack an input, and nobody would know."""
    nothing = np.zeros((2, 2, 3))
    with pytest.raises(TypeError, match='ReplaceState has no message'):
        input_message(ReplaceState(nothing, nothing), 0.5, 'world')


def test_a_scene_can_be_made_again_from_its_parameters():
    """A run could not be simulated again from its recording."""
    scene = Scene({**SPRINGS, 'rows': 5, 'cols': 7, 'pins': ['0,0'], 'pushes.start': [0.5],
                   'pushes.duration': [0.25], 'pushes.force': [0.0, 0.0, 1.0]})
    event = parameters_message(scene.values, SCENE_FIELDS, 1.5, 'left/cloth_sim')
    assert event.node == '/left/cloth_sim' and event.stamp.sec == 1
    assert not event.changed_parameters
    again = {
        parameter.name: Parameter.from_parameter_msg(parameter).value
        for parameter in deserialize_message(serialize_message(event), type(event)).new_parameters}
    values = {
        name: list(value) if not isinstance(value, (str, int, float)) else value
        for name, value in again.items()}
    assert Scene(values).values == scene.values


def test_a_change_is_told_as_a_change():
    """A reader would take a change for the whole set of parameters."""
    event = parameters_message(
        {'mode': 'constraint'}, SCENE_FIELDS, 0.0, 'cloth_sim', is_change=True)
    assert not event.new_parameters
    assert [parameter.name for parameter in event.changed_parameters] == ['mode']
