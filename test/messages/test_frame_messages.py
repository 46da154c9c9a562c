# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""What is taken of a simulation for a frame, and the messages that are made of it."""

from collections.abc import Iterator

from cloth_sim_interfaces.msg import ClothStats
from cloth_sim_ros.messages.frame_messages import FrameContent
from cloth_sim_ros.messages.frame_messages import FrameMessages
from cloth_sim_ros.messages.frame_messages import FrameTaker
from cloth_sim_ros.messages.frame_messages import Pace
from cloth_sim_ros.messages.frame_messages import PARAMETERS
from cloth_sim_ros.messages.topics import TOPICS
from cloth_sim_ros.sim.scene import Scene
from cloth_sim_ros.sim.simulation import Simulation
from given_inputs import handle
from given_inputs import HANDLED
import pytest
from rclpy.serialization import deserialize_message

_ALL = dict.fromkeys(PARAMETERS.values(), True)


@pytest.fixture
def cloth() -> Iterator[Simulation]:
    """Give a cloth with pins, a grasp and a collider, which records no forces by itself."""
    with Simulation(Scene(HANDLED), records_forces=False) as simulation:
        handle(simulation)
        yield simulation


def take(taker: FrameTaker, *keys: str) -> FrameContent:
    """Return the frame of readers of ``keys``."""
    return taker.take(lambda key: key in keys, Pace)


def made(cloth: Simulation, frame: FrameContent) -> list[tuple[str, bytes]]:
    """Return the messages of a frame."""
    return list(FrameMessages(cloth.scene, 'cloth_sim', 'world').of(frame))


def test_each_topic_is_made_for_its_readers_alone(cloth):
    """A large cloth would be read and serialised for nobody."""
    taker = FrameTaker(cloth, _ALL)
    for key in PARAMETERS:
        take(taker, key)
        cloth.step()
        frame = take(taker, key)
        assert frame.keys == {key}
        assert {found for found, _ in made(cloth, frame)} == {key}
        assert (frame.snapshot is None) == (key == 'clock')
        assert (frame.forces is None) == ('wrenches' not in key)


def test_a_topic_that_is_off_is_not_made(cloth):
    """A parameter would do nothing while somebody listens."""
    for key, parameter in PARAMETERS.items():
        frame = take(FrameTaker(cloth, {**_ALL, parameter: False}), *PARAMETERS)
        assert key not in frame.keys
        assert key not in {found for found, _ in made(cloth, frame)}


def test_what_is_not_there_is_not_made():
    """A cloth without pins, grasps and colliders would have frames of them."""
    with Simulation(Scene({'rows': 4, 'cols': 5, 'pins': []})) as cloth:
        frame = take(FrameTaker(cloth, _ALL), *PARAMETERS)
        assert frame.keys == {'clock', 'points', 'markers', 'stats'}


def test_forces_are_recorded_while_they_are_read(cloth):
    """Steps would take longer for nobody, or forces of a frame be those of its last step."""
    taker = FrameTaker(cloth, _ALL)
    take(taker, 'points')
    cloth.step()
    assert not cloth.knows_forces
    # The first frame can't know what was before somebody asked.
    assert take(taker, 'pins/wrenches').forces is None
    cloth.step(5)
    assert take(taker, 'pins/wrenches').forces.seconds == pytest.approx(5 * cloth.dt)
    take(taker, 'points')
    cloth.step()
    assert not cloth.knows_forces
    take(taker, 'grasps/wrenches')
    taker.close()
    cloth.step()
    assert not cloth.knows_forces


def test_a_look_into_a_frame_takes_no_forces_from_it(cloth):
    """Means would be those of the steps since a still picture, or since a recording had none."""
    taker = FrameTaker(cloth, _ALL)
    take(taker, 'pins/wrenches')
    cloth.step(3)
    seen = taker.take(lambda key: key == 'pins/wrenches', Pace, ends_frame=False)
    assert seen.keys == {'pins/wrenches'} and seen.forces is None
    assert made(cloth, seen) == []
    # Only the recording has readers of forces.
    taker.take(lambda key: key == 'points', Pace, ends_frame=False)
    cloth.step(2)
    forces = take(taker, 'pins/wrenches').forces
    assert forces.seconds == pytest.approx(5 * cloth.dt)
    # At the end of a frame, those of the frame are shown once more.
    assert taker.take(lambda key: key == 'pins/wrenches', Pace, ends_frame=False).forces is forces


def test_no_later_step_changes_a_frame(cloth):
    """A frame that waits to be sent would show a later moment."""
    taker = FrameTaker(cloth, _ALL)
    take(taker, *PARAMETERS)
    cloth.step(2)
    frame = take(taker, *PARAMETERS)
    # Serialised, strings are padded with what happens to be in memory.
    before = [deserialize_message(data, TOPICS[key].message) for key, data in made(cloth, frame)]
    cloth.release_grasp('hand')
    cloth.clear_pushes()
    cloth.pin(3, 3)
    cloth.move_collider('ball', (0.0, 0.0, 0.7))
    cloth.step(5)
    cloth.reset()
    now = [deserialize_message(data, TOPICS[key].message) for key, data in made(cloth, frame)]
    assert now == before


def test_frames_come_before_what_is_given_in_them(cloth):
    """A viewer would drop an arrow whose frame it does not know yet."""
    taker = FrameTaker(cloth, _ALL)
    take(taker, *PARAMETERS)
    cloth.step()
    keys = [key for key, _ in made(cloth, take(taker, *PARAMETERS))]
    assert keys[0] == 'clock'
    last = len(keys) - 1 - keys[::-1].index('tf')
    assert keys.index('pins/wrenches') > keys.index('tf')
    assert min(keys.index('grasps/wrenches'), keys.index('colliders/wrenches')) > last


def test_the_pace_is_asked_when_the_device_is_done(cloth):
    """The wall time of a frame would lack what the device still works on."""
    asked = []

    def pace() -> Pace:
        asked.append(cloth.steps)
        return Pace(worked=0.5, steps=4, achieved=0.25, wanted=1.0, too_slow=True)

    taker = FrameTaker(cloth, _ALL)
    frame = taker.take(lambda key: key == 'stats', pace)
    assert asked == [cloth.steps]
    (_, data), = made(cloth, frame)
    stats = deserialize_message(data, ClothStats)
    assert (stats.step_wall_time, stats.real_time_factor) == (0.125, 0.25)
    # A moment that is shown again has no steps.
    assert Pace(worked=0.5).step_wall_time == 0.5
