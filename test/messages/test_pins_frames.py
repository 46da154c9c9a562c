# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0


"""The frames of the pins, decoded."""

import json

from ament_index_python.packages import get_package_share_path
from cloth_sim_ros.messages.frame_names import pin_frame
from cloth_sim_ros.messages.pins import MOST_PINS
from cloth_sim_ros.messages.pins import PinFrames
from cloth_sim_ros.sim.snapshot import FLAG_AT_LIMIT
from cloth_sim_ros.sim.snapshot import FLAG_PINNED
from made_snapshot import make_snapshot
import pytest
from rclpy.serialization import deserialize_message
from tf2_msgs.msg import TFMessage

# Hash of TFMessage in ROS 2 Jazzy, as `ros2 topic info --verbose /tf` shows it.
JAZZY_HASH = 'RIHS01_e369d0f05a23ae52508854b66f6aa0437f3449d652e8cbf22d5abe85d020f087'


def snapshot_with(pins, time=1.25, rows=3, cols=12):
    """Return a snapshot whose nodes ``pins`` are pinned."""
    snapshot = make_snapshot(rows, cols, time=time)
    snapshot.records['flags'] = FLAG_AT_LIMIT
    for row, col in pins:
        snapshot.records['flags'][row, col] |= FLAG_PINNED
    return snapshot


def decode(messages, snapshot):
    """Return the transforms of ``snapshot``."""
    return deserialize_message(messages.serialise(snapshot), TFMessage).transforms


@pytest.mark.parametrize('node, frame', [
    ('/cloth_sim', 'cloth_sim_pin_0_31'), ('cloth_sim', 'cloth_sim_pin_0_31'),
    ('/left/arm/cloth', 'left_arm_cloth_pin_0_31')])
def test_names_have_no_slashes(node, frame):
    """Tools of tf2 would refuse the frame, or two nodes have the same one."""
    assert pin_frame(node, 0, 31) == frame


def test_each_pin_has_its_place():
    """A frame would be at another pin, or where its pin was before."""
    messages = PinFrames('/a/cloth', 'map')
    for pins, time in (([(0, 0), (1, 11), (2, 3)], 0.5), ([(0, 0), (1, 11), (2, 3)], 1.25),
                       ([(1, 9)], 2.0), ([(0, 10), (0, 11), (1, 9)], 2.5)):
        snapshot = snapshot_with(pins, time)
        frames = decode(messages, snapshot)
        assert [frame.child_frame_id for frame in frames] == [
            f'a_cloth_pin_{row}_{col}' for row, col in pins]
        for frame, (row, col) in zip(frames, pins):
            assert frame.header.frame_id == 'map'
            assert frame.header.stamp.sec + 1e-9 * frame.header.stamp.nanosec == time
            place, turn = frame.transform.translation, frame.transform.rotation
            assert [place.x, place.y, place.z] == snapshot.positions[row, col].tolist()
            assert (turn.x, turn.y, turn.z, turn.w) == (0.0, 0.0, 0.0, 1.0)


def test_nodes_of_a_grasp_have_no_frame_of_a_pin():
    """A viewer would show grippers at nodes that another one holds."""
    snapshot = snapshot_with([(0, 0), (1, 1)])
    held = snapshot.flags * 0 == 1
    held[1, 1] = True
    frame, = deserialize_message(
        PinFrames('cloth_sim', 'world').serialise(snapshot, held), TFMessage).transforms
    assert frame.child_frame_id == 'cloth_sim_pin_0_0'


def test_as_many_pins_as_there_may_be():
    """The last frames of a cloth with many pins would hold garbage."""
    pins = [(row, col) for row in range(8) for col in range(128)]
    assert len(pins) == MOST_PINS
    snapshot = snapshot_with(pins, rows=9, cols=128)
    frames = decode(PinFrames('cloth_sim', 'world'), snapshot)
    assert [frame.child_frame_id for frame in frames] == [
        pin_frame('cloth_sim', *pin) for pin in pins]
    assert [frame.transform.translation.z for frame in frames] == [
        snapshot.positions[pin][2] for pin in pins]


def test_a_cloth_without_pins_has_no_frames():
    """A message would not be one."""
    assert decode(PinFrames('cloth_sim', 'world'), snapshot_with([])) == []


def test_listeners_of_tf2_take_the_type():
    """A real tf2 listener would not match: its type has another hash."""
    share = get_package_share_path('tf2_msgs')
    described = json.loads((share / 'msg' / 'TFMessage.json').read_text(encoding='utf-8'))
    hashes = {entry['type_name']: entry['hash_string'] for entry in described['type_hashes']}
    assert hashes['tf2_msgs/msg/TFMessage'] == JAZZY_HASH
