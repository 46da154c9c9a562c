# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""The frames of tf: heard, kept for seconds, and where one is, seen from another, at a time."""

import math

from builtin_interfaces.msg import Time
from cloth_sim_ros.node.frame_tree import checked_pose
from cloth_sim_ros.node.frame_tree import FrameHistory
from cloth_sim_ros.node.frame_tree import FrameTree
from cloth_sim_ros.node.frame_tree import KEPT
from cloth_sim_ros.node.frame_tree import MOST_FRAMES
from cloth_sim_ros.node.frame_tree import MOST_SAMPLES
from cloth_sim_ros.node.frame_tree import read_transforms
from cloth_sim_ros.node.frame_tree import Sample
from cloth_sim_ros.node.frame_tree import seconds
from cloth_sim_ros.sim.errors import ClothSimError
from cloth_sim_ros.sim.model.pose import Pose
from geometry_msgs.msg import Quaternion
from geometry_msgs.msg import Transform
from geometry_msgs.msg import TransformStamped
from geometry_msgs.msg import Vector3
import numpy as np
import pytest
from rclpy.serialization import serialize_message
from scipy.spatial.transform import Rotation
from scipy.spatial.transform import Slerp
from std_msgs.msg import Header
from tf2_msgs.msg import TFMessage

NAMES = ('', 'a', 'ab', 'abc', 'abcd', 'tool0_link', 'Größe', '/old')


def message_of(names, generator):
    """Return a TFMessage with a transform between any two of ``names``."""
    return TFMessage(transforms=[
        TransformStamped(
            header=Header(stamp=Time(
                sec=int(generator.integers(-5, 2**31 - 1)),
                nanosec=int(generator.integers(10**9))), frame_id=parent),
            child_frame_id=frame, transform=Transform(
                translation=Vector3(**dict(zip('xyz', generator.normal(size=3).tolist()))),
                rotation=Quaternion(**dict(zip('xyzw', generator.normal(size=4).tolist())))))
        for parent in names for frame in names])


@pytest.mark.parametrize('names', [NAMES, NAMES[3:5], ()])
def test_it_is_read_as_rclpy_reads_it(names):
    """A frame would get the place, the parent or the time of another one."""
    message = message_of(names, np.random.default_rng(2))
    read = list(read_transforms(bytes(serialize_message(message))))
    assert len(read) == len(message.transforms)
    for (frame, time, parent, place), told in zip(read, message.transforms):
        stamp, at, turn = told.header.stamp, told.transform.translation, told.transform.rotation
        assert frame == told.child_frame_id.removeprefix('/')
        assert parent == told.header.frame_id.removeprefix('/')
        assert time == stamp.sec * 10**9 + stamp.nanosec
        assert place == (at.x, at.y, at.z, turn.x, turn.y, turn.z, turn.w)


def test_bytes_that_are_no_transforms_are_refused():
    """A broken message would be half taken without a word, or end the node."""
    whole = bytes(serialize_message(message_of(NAMES[:3], np.random.default_rng(2))))
    for broken in (b'\x00\x01\x00\x00', b'\x00\x01\x00\x00\xff\xff\xff\x7f', whole[:-1]):
        with pytest.raises(ClothSimError, match='it is no TFMessage'):
            list(read_transforms(broken))
    name = whole.index(b'ab\x00')
    with pytest.raises(ClothSimError, match='it is no TFMessage'):
        list(read_transforms(whole[:name] + b'\xff\xfe' + whole[name + 2:]))


@pytest.mark.parametrize('place, reason', [
    ((math.nan, 0.0, 0.0, 0.0, 0.0, 0.0, 1.0), 'finite numbers, got [nan, 0.0'),
    ((0.0, 0.0, 0.0, 0.0, 0.0, math.inf, 1.0), 'finite numbers'),
    ((0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0), 'of length 1, got [0.0, 0.0, 0.0, 0.0]'),
    ((0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 1.02), 'of length 1, got [0.0, 0.0, 0.0, 1.02]')])
def test_a_transform_that_makes_no_sense_is_refused(place, reason):
    """A robot that is not ready yet would send the cloth to no place."""
    with pytest.raises(ClothSimError) as refused:
        checked_pose('tool0', place)
    assert "the frame 'tool0' must" in str(refused.value) and reason in str(refused.value)


def test_a_rotation_is_made_a_unit():
    """Each link of a chain would stretch what comes after it."""
    pose = checked_pose('tool0', (1.0, 2.0, 3.0, 0.0, 0.6003, 0.0, 0.8004))
    assert pose.position == (1.0, 2.0, 3.0)
    assert pose.orientation == pytest.approx((0.0, 0.6, 0.0, 0.8), abs=1e-15)


# What is kept of one frame, and where it was between.

SECOND = 1_000_000_000


def history_of(*times, parent='base'):
    """Return a history with a sample at each of ``times`` [ns]; x tells which came when."""
    history = FrameHistory()
    for number, time in enumerate(times):
        history.add(Sample(time, parent, Pose((float(number), 0.0, 0.0))))
    return history


def test_interpolation_between_samples():
    """Positions are interpolated linearly, rotations along the shortest arc."""
    generator = np.random.default_rng(5)
    for _ in range(200):
        places = generator.normal(size=(2, 3))
        turns = Rotation.random(2, random_state=generator)
        # Either of the two quaternions of a rotation can come.
        signs = generator.choice([-1.0, 1.0], size=(2, 1))
        history = FrameHistory()
        for time, place, turn in zip((3, 7), places, signs * turns.as_quat()):
            history.add(Sample(time * SECOND, 'base', Pose(tuple(place), tuple(turn))))
        share = generator.uniform()
        found = history.at(int((3.0 + 4.0 * share) * SECOND)).pose
        np.testing.assert_allclose(
            found.position, places[0] + share * (places[1] - places[0]), atol=1e-8)
        expected = Slerp([0.0, 1.0], turns)(share)
        assert (expected * Rotation.from_quat(found.orientation).inv()).magnitude() < 1e-7


def test_at_a_sample_it_has_the_bits_of_the_sample():
    """A recorded stamp would be looked up with rounding errors."""
    pose = Pose((0.1, 0.2, 0.3), (0.0, 0.6, 0.0, 0.8))
    history = history_of(1, 3)
    history.add(Sample(2, 'base', pose))
    assert history.at(2).pose is pose


def test_no_extrapolation_beyond_the_samples():
    """A pose would be extrapolated to times before the first or after the last sample."""
    history = history_of(5, 9)
    assert history.at(4) is None and history.at(10) is None
    assert history.at(5).pose.position[0] == 0.0 and history.at(9).pose.position[0] == 1.0
    assert (history.oldest.time, history.latest.time) == (5, 9)
    alone = history_of(5)
    assert alone.at(4) is None and alone.at(6) is None and alone.at(5) is not None


def test_samples_out_of_order_and_duplicate_stamps():
    """A late message would be lost, or a frame jump between two publishers; the first wins."""
    history = history_of(10, 30, 20, 20)
    assert [history.at(time).pose.position[0] for time in (10, 15, 20, 25, 30)] == [
        0.0, 1.0, 2.0, 1.5, 1.0]


def test_ten_seconds_are_kept():
    """Memory would fill up, or a message that is a few seconds late be refused."""
    history = history_of(0, 4 * SECOND, 10 * SECOND)
    assert history.oldest.time == 0
    history.add(Sample(10 * SECOND + 1, 'base', Pose((0.0, 0.0, 0.0))))
    assert history.oldest.time == 4 * SECOND
    assert history_of(*range(MOST_SAMPLES + 5)).oldest.time == 5


def test_a_publisher_that_was_reset_starts_anew():
    """The old times would hide the new ones until those come up to them."""
    history = history_of(100 * SECOND, 101 * SECOND)
    history.add(Sample(101 * SECOND - KEPT - 1, 'base', Pose((9.0, 0.0, 0.0))))
    assert history.latest.pose.position[0] == 9.0 and history.oldest is history.latest


def test_between_two_parents_it_is_still_at_the_first():
    """A frame would be put on the way between places of two frames."""
    history = history_of(10)
    history.add(Sample(20, 'hand', Pose((5.0, 0.0, 0.0))))
    found = history.at(19)
    assert (found.parent, found.pose.position[0]) == ('base', 0.0)
    assert history.at(20).parent == 'hand'


def test_the_present_replaces_what_was_said_of_it():
    """A grasp of the same name, made anew while paused, would be where the old one was."""
    history = history_of(10, 20, 30)
    history.drop_from(20)
    assert history.latest.time == 10
    history.add(Sample(20, 'base', Pose((7.0, 0.0, 0.0))))
    assert history.latest.pose.position[0] == 7.0


# The way from one frame to another, against products of 4 x 4 matrices.

HERE = Pose((0.0, 0.0, 0.0))


def empty_tree(own=None):
    """Return a tree that has no frames but those of ``own``."""
    return FrameTree((own or {}).get, 'publish it')


def tree_of(*links, time=SECOND):
    """Return a tree of moving frames, given as (frame, parent) with any pose."""
    tree = empty_tree()
    for frame, parent in links:
        tree.add(frame, Sample(time, parent, HERE), is_fixed=False)
    return tree


def reason(tree, frame, time=None):
    """Return why the tree does not know ``frame`` in the frame world."""
    with pytest.raises(ClothSimError) as refused:
        tree.pose(frame, 'world', time)
    text = str(refused.value)
    assert len(text.splitlines()) == 1
    return text


def random_pose(generator):
    """Return a pose and its 4 x 4 matrix."""
    turn = Rotation.random(random_state=generator)
    place = generator.normal(size=3)
    matrix = np.eye(4)
    matrix[:3, :3], matrix[:3, 3] = turn.as_matrix(), place
    return Pose(tuple(place.tolist()), tuple(turn.as_quat().tolist())), matrix


@pytest.mark.parametrize('is_fixed', [True, False])
def test_the_way_between_any_two_frames(is_fixed):
    """An input of a camera on one arm would be taken to another place for the cloth on another."""
    generator = np.random.default_rng(11)
    parents = {'a': 'world', 'b': 'a', 'c': 'b', 'd': 'a', 'e': 'd', 'world': 'earth'}
    tree, in_earth = empty_tree(), {'earth': np.eye(4)}
    poses = {frame: random_pose(generator) for frame in parents}
    for frame, parent in parents.items():
        tree.add(frame, Sample(SECOND, parent, poses[frame][0]), is_fixed=is_fixed)
    for frame in ('world', 'a', 'b', 'c', 'd', 'e'):
        in_earth[frame] = in_earth[parents[frame]] @ poses[frame][1]
    for frame in in_earth:
        for to in in_earth:
            for time in (None, SECOND):
                found = tree.pose(frame, to, time)
                expected = np.linalg.inv(in_earth[to]) @ in_earth[frame]
                np.testing.assert_allclose(found.position, expected[:3, 3], atol=1e-12)
                np.testing.assert_allclose(found.axes.T, expected[:3, :3], atol=1e-12)


def test_no_stamp_uses_the_latest_common_time():
    """Frames of different times would be chained: a hand at one time on an arm at another."""
    tree = empty_tree()
    for time in range(1, 6):
        tree.add('arm', Sample(
            time * SECOND, 'world', Pose((float(time), 0.0, 0.0))), is_fixed=False)
    for time in (1, 3):
        tree.add('hand', Sample(
            time * SECOND, 'arm', Pose((0.0, float(time), 0.0))), is_fixed=False)
    tree.add('tip', Sample(77, 'hand', Pose((0.0, 0.0, 0.5))), is_fixed=True)
    assert tree.pose('tip', 'world', None).position == (3.0, 3.0, 0.5)
    assert tree.pose('arm', 'world', None).position == (5.0, 0.0, 0.0)
    assert tree.pose('tip', 'world', 2 * SECOND).position == (2.0, 2.0, 0.5)


def test_stamp_out_of_range_error_gives_the_range():
    """A pose would be extrapolated, or the error not show how far the clocks differ."""
    tree = tree_of(('tool0', 'arm'), time=2 * SECOND)
    for time in (SECOND, 5 * SECOND // 2):
        tree.add('arm', Sample(time, 'world', HERE), is_fixed=False)
    assert reason(tree, 'tool0', 2 * SECOND + 1) == (
        "the stamp of its frame 'tool0' is 2.000000001 s but 'tool0' is known from 2 to 2 s: give "
        'a stamp in between, or 0 for the latest')
    assert "is 3 s but 'arm' is known from 1 to 2.5 s" in reason(tree, 'arm', 3 * SECOND)
    assert "is 0.5 s but 'arm' is known from 1 to 2.5 s" in reason(tree, 'arm', SECOND // 2)
    assert 'is -1 s but' in reason(tree, 'arm', -SECOND)


def test_clocks_without_a_common_time_are_told():
    """A user with wall time here and simulated time there would look for a frame that is there."""
    tree = tree_of(('arm', 'world'), time=1_700_000_000 * SECOND)
    tree.add('hand', Sample(SECOND, 'arm', HERE), is_fixed=False)
    assert reason(tree, 'hand') == (
        "its frame 'hand' and 'world' have no time in common, as what is between them is known up "
        "to 1 s and 'arm' from 1700000000 to 1700000000 s: have their publishers use the same "
        'clock')


def test_an_unknown_frame_is_refused_by_its_name():
    """A user would not know which frame is missing, or what to do."""
    tree = tree_of(('arm', 'world'))
    assert reason(tree, 'tool0') == (
        "its frame 'tool0' is not known: publish it, or give another one, such as 'world', the "
        'frame of the cloth')
    # Not even the frame of the cloth is known to tf.
    assert reason(empty_tree(), 'tool0', SECOND).startswith("its frame 'tool0' is not known")


@pytest.mark.parametrize('links, frame, ends', [
    ([('tool0', 'base'), ('arm', 'world')], 'tool0', "'base' and 'world'"),
    ([('tool0', 'base'), ('arm', 'world')], 'base', "'base' and 'world'"),
    ([('tool0', 'base'), ('world', 'map')], 'tool0', "'base' and 'map'"),
    ([('tool0', 'base')], 'tool0', "'base' and 'world'")])
def test_frames_that_are_not_connected_are_refused(links, frame, ends):
    """An input would be taken as if two robots stood in one place."""
    text = reason(tree_of(*links), frame)
    assert text == (
        f"its frame '{frame}' is not connected to 'world', the frame of the cloth: publish a "
        f'transform between {ends}, or start the node with a frame_id that is connected')


@pytest.mark.parametrize('time', [None, SECOND])
def test_frames_in_a_circle_end_with_a_reason(time):
    """The node would hang."""
    tree = tree_of(('a', 'b'), ('b', 'c'), ('c', 'a'), ('d', 'a'), ('world', 'w'), ('w', 'world'))
    assert reason(tree, 'a', time) == (
        "3 frames on /tf hang on each other in a circle, 'a', 'b', 'c': let each frame have one "
        'parent, and one of them none')
    assert 'in a circle' in reason(tree, 'd', time)
    with pytest.raises(ClothSimError, match='in a circle'):
        tree.pose('x', 'world', time)
    # Where the way does not lead through the circle, it does no harm.
    assert tree.pose('d', 'a', time) == HERE


def test_a_frame_can_become_fixed_and_move_again():
    """Of two transforms of a frame, the older one would count for ever."""
    tree = tree_of(('arm', 'world'))
    tree.add('arm', Sample(0, 'world', Pose((1.0, 0.0, 0.0))), is_fixed=True)
    assert tree.pose('arm', 'world', 9 * SECOND).position == (1.0, 0.0, 0.0)
    tree.add('arm', Sample(SECOND, 'world', Pose((2.0, 0.0, 0.0))), is_fixed=False)
    assert tree.pose('arm', 'world', None).position == (2.0, 0.0, 0.0)


def test_a_reset_forgets_what_moved_and_keeps_what_is_fixed():
    """Old times would be mixed with new ones, or static transforms, told once, be lost."""
    tree = tree_of(('arm', 'world'))
    tree.add('camera', Sample(0, 'world', HERE), is_fixed=True)
    tree.forget_moving()
    assert tree.pose('camera', 'world', 5 * SECOND) == HERE
    assert 'is not known' in reason(tree, 'arm')


def test_frames_of_its_own_need_not_be_told():
    """A push in the frame of a grasp would be refused."""
    history = FrameHistory()
    history.add(Sample(SECOND, 'world', Pose((1.0, 2.0, 3.0))))
    tree = empty_tree({'hand': history})
    tree.add('camera', Sample(0, 'hand', Pose((0.0, 0.0, 1.0))), is_fixed=True)
    assert tree.pose('camera', 'world', None).position == (1.0, 2.0, 4.0)
    assert 'known from 1 to 1 s' in reason(tree, 'camera', 2 * SECOND)


@pytest.mark.parametrize('frame, parent', [('a', 'a'), ('', 'a'), ('a', '')])
def test_a_frame_needs_another_one_as_parent(frame, parent):
    """A slip of a publisher would make every look-up go in circles."""
    tree = empty_tree()
    with pytest.raises(ClothSimError, match='give two different names'):
        tree.add(frame, Sample(0, parent, HERE), is_fixed=False)


def test_frames_without_end_take_no_memory_without_end():
    """A publisher that names each frame anew would fill the memory of the node."""
    tree = empty_tree()
    for number in range(MOST_FRAMES):
        tree.add(str(number), Sample(0, 'world', HERE), is_fixed=number % 2 == 0)
    with pytest.raises(ClothSimError, match=f'one more than {MOST_FRAMES}'):
        tree.add('late', Sample(0, 'world', HERE), is_fixed=False)
    tree.add('7', Sample(1, 'world', Pose((1.0, 0.0, 0.0))), is_fixed=False)
    assert tree.pose('7', 'world', None).position[0] == 1.0


def test_times_are_written_with_all_their_digits():
    """A difference of a microsecond in wall time would not be seen in the refusal."""
    assert [seconds(time) for time in (0, 1, -5 * SECOND // 2, 1_700_000_000 * SECOND + 1000)] == [
        '0', '0.000000001', '-2.5', '1700000000.000001']
