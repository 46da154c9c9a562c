# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""The way from one frame to another, against products of 4 x 4 matrices."""

from cloth_sim_ros.node.frame_history import FrameHistory
from cloth_sim_ros.node.frame_history import Sample
from cloth_sim_ros.node.frame_tree import FrameTree
from cloth_sim_ros.node.frame_tree import MOST_FRAMES
from cloth_sim_ros.node.frame_tree import seconds
from cloth_sim_ros.sim.errors import ClothSimError
from cloth_sim_ros.sim.pose import Pose
import numpy as np
import pytest
from scipy.spatial.transform import Rotation

SECOND = 1_000_000_000
HERE = Pose((0.0, 0.0, 0.0))


def empty_tree(own=None):
    """Return a tree whose frames all have to be told, but those of ``own``."""
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


def test_without_a_stamp_it_is_the_latest_time_that_all_have():
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


def test_a_stamp_outside_what_is_known_is_refused_with_the_times():
    """A frame would be guessed, or a user not know by how much a clock is off."""
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
        "its frame 'tool0' is not known: publish it, or give the message in 'world', the frame "
        'of the cloth')
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
