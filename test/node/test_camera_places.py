# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""The cameras of a node: their topics, their frames, and what a recording has of them."""

from pathlib import Path

from cloth_sim_interfaces.srv import StartRecording
from cloth_sim_interfaces.srv import Step
from cloth_sim_ros.camera.camera import Camera
from cloth_sim_ros.messages.topics import camera_topics
from cloth_sim_ros.sim.model.pose import Pose
from cloth_sim_ros.sim.scene import Scene
from cloth_sim_ros.sim.simulation import Simulation
from cloth_under_test import ClothUnderTest
from cloth_under_test import HANDLED
from node_process import NodeProcess
import numpy as np
import pytest
from recorded import Recorded
from std_srvs.srv import Trigger
from transform_teller import Teller
from transform_teller import transform

SEEN = {
    **HANDLED, 'start_paused': True, 'recording.cameras': True,
    'cameras.names': ['front', 'hand'], 'cameras.front.position': [1.0, -1.2, 1.4],
    'cameras.front.target': [0.0, 0.0, 0.8], 'cameras.front.width': 80,
    'cameras.front.height': 60, 'cameras.front.rate': 100.0,
    'cameras.hand.frame': 'wrist', 'cameras.hand.width': 40, 'cameras.hand.height': 30,
    'cameras.hand.rate': 100.0}
NAME = '/seen/cloth_sim'
TOPICS = camera_topics(['front', 'hand'])
DOWN = Pose((0.0, 0.0, 2.0), (1.0, 0.0, 0.0, 0.0))


@pytest.fixture(scope='module')
def node(tmp_path_factory):
    """Start a node with two cameras, one of them attached to a frame of tf."""
    with NodeProcess(tmp_path_factory.mktemp('seen'), SEEN, '-r', '__ns:=/seen') as node:
        yield node


@pytest.fixture(scope='module')
def cloth(node, client):
    """Listen to the node, but not to its cameras."""
    return ClothUnderTest(client, SEEN, NAME)


@pytest.fixture(scope='module')
def watches(cloth):
    """Listen to its cameras."""
    return {
        key: cloth.client.watch(topic.message, topic.full_name(NAME), depth=10)
        for key, topic in TOPICS.items()}


def stamp_of(message):
    """Return the stamp of a message [ns]."""
    return message.header.stamp.sec * 1_000_000_000 + message.header.stamp.nanosec


def newest(cloth, watches, *keys):
    """Make steps until there is one stamp for all ``keys``; return their messages of it."""
    def find():
        assert cloth.call(Step, 'step', steps=4).success
        cloth.client.spin_until_quiet()
        by_key = [{stamp_of(each): each for each in watches[key].messages} for key in keys]
        common = set.intersection(*map(set, by_key))
        return [each[max(common)] for each in by_key] if common else None

    return cloth.client.spin_until(find, f'messages of {keys}')


def test_all_topics_are_of_the_moment_of_the_points(cloth, watches):
    """A depth picture would show another moment than the nodes beside it."""
    keys = [key for key in TOPICS if key.startswith('cameras/front')]
    made = newest(cloth, watches, *keys)
    assert len({stamp_of(message) for message in made}) == 1
    assert stamp_of(made[0]) in {stamp_of(each) for each in cloth['points']}
    assert {message.header.frame_id for message in made} == {'seen_cloth_sim_camera_front_optical'}
    frames = {
        (each.child_frame_id, stamp_of(each)): each.header.frame_id
        for message in cloth['tf'] for each in message.transforms}
    assert frames[('seen_cloth_sim_camera_front_optical', stamp_of(made[0]))] == 'world'
    assert frames[('seen_cloth_sim_camera_hand_optical', stamp_of(made[0]))] == 'wrist'


def test_the_picture_is_that_of_python(cloth, watches):
    """The node would show something else than the same camera in a program."""
    depth, labels, image = newest(
        cloth, watches, *(f'cameras/front/{part}' for part in ('depth', 'labels', 'image')))
    with Simulation(Scene({key: value for key, value in SEEN.items() if key not in (
            'start_paused', 'recording.cameras')})) as twin, Camera(twin.scene.cameras[0]) as eye:
        twin.step(round(stamp_of(depth) * 1e-9 / SEEN['dt']))
        picture = eye.capture(twin)
    for message, pixels in (
            (depth, picture.depth), (labels, picture.labels), (image, picture.color)):
        np.testing.assert_array_equal(
            np.frombuffer(message.data, pixels.dtype).reshape(pixels.shape), pixels)


def test_an_attached_camera_sees_from_its_frame(node, cloth, watches):
    """A camera in a hand would stay behind, or wait for its frame in silence."""
    cloth.client.spin_until(
        lambda: cloth.call(Step, 'step', steps=40).success
        and 'camera hand takes no pictures' in node.output, 'the warning')
    assert node.output.count('camera hand takes no pictures') == 1
    assert not watches['cameras/hand/depth'].messages
    teller = Teller(cloth)
    teller.tell(transform('wrist', 'world', DOWN), is_fixed=True)
    depth, info = newest(cloth, watches, 'cameras/hand/depth', 'cameras/hand/camera_info')
    teller.close()
    pixels = np.frombuffer(depth.data, np.float32).reshape(info.height, info.width)
    assert pixels.shape == (30, 40)
    # The cloth hangs between its start at 1 m and the floor at 0.2 m.
    assert 0.9 < pixels[15, 20] < 1.8


def test_a_recording_has_the_pictures_but_not_the_points(node, cloth, watches):
    """A data set could not be made from a run, or would be twice as large as it needs to be."""
    path = Path(cloth.call(StartRecording, 'start_recording', name='pictures').path)
    assert cloth.call(Step, 'step', steps=8).success
    assert cloth.call(Trigger, 'stop_recording').success
    recorded = Recorded(path)
    names = {key for key in TOPICS if recorded.messages(key)}
    assert {'cameras/front/image', 'cameras/front/depth', 'cameras/front/labels',
            'cameras/front/camera_info'} <= names
    assert not any(name.endswith('points') for name in names)
    depth = recorded.messages('cameras/front/depth')[-1]
    assert np.isfinite(np.frombuffer(depth.data, np.float32)).any()
