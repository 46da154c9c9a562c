# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""Where the pins are and what they feel, against a simulation on the same device."""

from pathlib import Path

from cloth_sim_interfaces.srv import MovePin
from cloth_sim_interfaces.srv import SetPin
from cloth_sim_interfaces.srv import StartRecording
from cloth_sim_interfaces.srv import Step
from cloth_under_test import PAUSED
from geometry_msgs.msg import Point
from geometry_msgs.msg import WrenchStamped
from node_process import NodeProcess
from recorded import Recorded
from std_srvs.srv import Trigger
from tf2_msgs.msg import TFMessage

KEY = 'pins/wrenches'
PIN = 'node_tests_cloth_sim_pin_{}_{}'


def frames_of(messages):
    """Return parent and place of each child frame."""
    frames = {}
    for message in messages:
        for frame in message.transforms:
            place, turn = frame.transform.translation, frame.transform.rotation
            assert (turn.x, turn.y, turn.z, turn.w) == (0.0, 0.0, 0.0, 1.0)
            frames[frame.child_frame_id] = (frame.header.frame_id, (place.x, place.y, place.z))
    return frames


def forces_of(messages):
    """Return the force of each message by its frame."""
    vectors = {message.header.frame_id: message.wrench.force for message in messages}
    return {frame: (force.x, force.y, force.z) for frame, force in vectors.items()}


def wait_for_wrenches(cloth, *, steps, count):
    """Return the wrenches after ``steps`` steps, when ``count`` have come."""
    def of_then():
        return [message for message in cloth[KEY] if cloth.steps_of(message) == steps]

    cloth.client.spin_until(lambda: len(of_then()) >= count, f'{count} wrenches')
    return of_then()


def expected_forces(simulation):
    """Return the force that each holder of the simulation's cloth feels, by its frame."""
    held = simulation.snapshot(pin_forces=True).pin_forces
    return {
        PIN.format(row, col): tuple(-part for part in force)
        for (row, col), force in zip(held.nodes.tolist(), held.forces.tolist())}


def test_each_holder_feels_its_pin(cloth, simulation):
    """A gripper would read another force than it holds with, or one of another time."""
    assert cloth.call(SetPin, 'set_pin', row=3, col=4).success
    assert cloth.call(Step, 'step', steps=20).success
    simulation.pin(3, 4)
    simulation.step(20)
    told = forces_of(wait_for_wrenches(cloth, steps=20, count=3))
    assert set(told) == {PIN.format(0, 0), PIN.format(0, 9), PIN.format(3, 4)}
    assert told == expected_forces(simulation)


def test_every_wrench_has_its_frame(cloth, simulation):
    """A viewer could not draw a wrench, for want of a transform, or would draw it elsewhere."""
    assert cloth.call(
        MovePin, 'move_pin', row=0, col=9, target=Point(x=0.5, y=0.3, z=1.2), speed=1.0).success
    # Other steps than in the test before, of which a wrench can still be under way.
    assert cloth.call(Step, 'step', steps=24).success
    told = cloth.wait_for('tf', lambda message: cloth.steps_of(message.transforms[0]) == 24)
    assert {cloth.steps_of(frame) for frame in told.transforms} == {24}
    simulation.move_pin(0, 9, (0.5, 0.3, 1.2), 1.0)
    simulation.step(24)
    positions = simulation.snapshot().positions
    assert frames_of([told]) == {
        PIN.format(row, col): ('world', tuple(positions[row, col].tolist()))
        for row, col in ((0, 0), (0, 9))}
    wrenches = wait_for_wrenches(cloth, steps=24, count=2)
    assert {message.header.frame_id for message in wrenches} == set(frames_of([told]))


def test_a_recording_has_them(cloth):
    """What a robot would have felt could not be looked up afterwards."""
    path = Path(cloth.call(StartRecording, 'start_recording', name='').path)
    assert cloth.call(Step, 'step', steps=8).success
    assert cloth.call(Trigger, 'stop_recording').success
    recorded = Recorded(path).messages(KEY)
    assert [cloth.steps_of(message) for message in recorded] == [0, 0, 8, 8]
    published = wait_for_wrenches(cloth, steps=8, count=2)
    assert forces_of(recorded[2:]) == forces_of(published)
    places = [message for topic, _, message in Recorded(path).entries if topic == '/tf']
    assert [cloth.steps_of(message.transforms[0]) for message in places] == [0, 8]
    assert set(frames_of(places[1:])) == set(forces_of(recorded[2:]))


def test_the_parameter_turns_them_off_and_on(cloth):
    """A topic nobody wants would still cost time, or could not be had back."""
    assert cloth.set_parameters(publish__wrenches=False, publish__tf=False).successful
    assert cloth.call(Step, 'step', steps=2).success
    cloth.frame(2)
    # A paused node shows each second where it is: both come then from here on, for step 2 as well.
    cloth.client.spin_for(0.2)
    assert all(cloth.steps_of(message) != 2 for message in cloth[KEY])
    assert all(cloth.steps_of(message.transforms[0]) != 2 for message in cloth['tf'])
    assert cloth.set_parameters(publish__wrenches=True, publish__tf=True).successful
    assert cloth.call(Step, 'step', steps=2).success
    cloth.wait_for(KEY, lambda message: cloth.steps_of(message) == 4)
    cloth.wait_for('tf', lambda message: cloth.steps_of(message.transforms[0]) == 4)


def test_too_many_pins_are_told_and_not_sent(client, tmp_path):
    """A cloth that is pinned all over would bring its node to a stand, or be silent unasked."""
    scene = {**PAUSED, 'rows': 33, 'cols': 33, 'pins': ['all']}
    with NodeProcess(tmp_path, scene, '-r', '__ns:=/many_pins') as node:
        watch = client.watch(WrenchStamped, '/many_pins/cloth_sim/pins/wrenches')
        frames = client.watch(TFMessage, '/tf')
        client.spin_until(lambda: 'so neither is published' in node.output, 'the warning')
        assert not watch.messages
        assert not any(
            frame.startswith('many_pins') for frame in frames_of(frames.messages))
    assert node.output.count('so neither is published') == 1
