# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""What is kept of one frame, and where it was between."""

from cloth_sim_ros.node.frame_history import FrameHistory
from cloth_sim_ros.node.frame_history import KEPT
from cloth_sim_ros.node.frame_history import MOST_SAMPLES
from cloth_sim_ros.node.frame_history import Sample
from cloth_sim_ros.sim.pose import Pose
import numpy as np
from scipy.spatial.transform import Rotation
from scipy.spatial.transform import Slerp

SECOND = 1_000_000_000


def history_of(*times, parent='base'):
    """Return a history with a sample at each of ``times`` [ns]; x tells which came when."""
    history = FrameHistory()
    for number, time in enumerate(times):
        history.add(Sample(time, parent, Pose((float(number), 0.0, 0.0))))
    return history


def test_between_samples_it_is_on_the_straight_line_and_the_shortest_turn():
    """An input would be taken from where its frame never was."""
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


def test_nothing_is_known_before_the_first_and_after_the_last():
    """A frame would be guessed to be where it was long ago, or is yet to come."""
    history = history_of(5, 9)
    assert history.at(4) is None and history.at(10) is None
    assert history.at(5).pose.position[0] == 0.0 and history.at(9).pose.position[0] == 1.0
    assert (history.oldest.time, history.latest.time) == (5, 9)
    alone = history_of(5)
    assert alone.at(4) is None and alone.at(6) is None and alone.at(5) is not None


def test_samples_need_not_come_in_order_and_the_first_of_a_time_counts():
    """A late message would be lost, or two publishers make a frame jump to and fro."""
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
