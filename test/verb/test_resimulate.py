# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""Recorded runs of a real node, made again."""

from pathlib import Path
import random
import time

from cloth_sim_interfaces.msg import PinTarget
from cloth_sim_interfaces.msg import Push
from cloth_sim_interfaces.srv import ApplyPush
from cloth_sim_interfaces.srv import MovePin
from cloth_sim_interfaces.srv import SetMode
from cloth_sim_interfaces.srv import SetPin
from cloth_sim_interfaces.srv import StartRecording
from cloth_sim_interfaces.srv import Step
from cloth_sim_ros.sim.model.scene_fields import MODES
from cloth_sim_ros.verb.main import main
from geometry_msgs.msg import Point
from geometry_msgs.msg import Vector3
from made_again import assert_same
from made_again import made_again
import pytest
from std_srvs.srv import SetBool
from std_srvs.srv import Trigger

CORNERS = ((0, 0), (0, 9))


@pytest.fixture
def recorded(cloth):
    """Return a function that ends the recording of all that is done after this, and its folder."""
    path = Path(cloth.call(StartRecording, 'start_recording').path)

    def end() -> Path:
        assert cloth.call(Trigger, 'stop_recording').success
        return path

    return end


def step(cloth, steps):
    """Make steps."""
    assert cloth.call(Step, 'step', steps=steps).success


def inputs_of(cloth, chance):
    """Return one of each thing that can be done to the cloth."""
    row, col = chance.randrange(8), chance.randrange(10)
    force = Vector3(x=chance.uniform(-1, 1), y=chance.uniform(-1, 1), z=chance.uniform(-1, 2))
    corner = chance.choice(CORNERS)
    # Inwards, or the cloth would be torn, and the run stop.
    side = 0.45 if corner[1] else -0.45
    target = Point(x=side * chance.uniform(0.6, 1.0), y=0.35, z=chance.uniform(0.98, 1.02))
    return {
        'push': lambda: cloth.call(
            ApplyPush, 'apply_push', force=force, duration=chance.uniform(0.001, 0.2)),
        'sphere': lambda: cloth.call(
            ApplyPush, 'apply_push', force=force, region=Push.SPHERE, radius=0.4,
            center=Point(x=chance.uniform(-0.5, 0.5), z=0.9), duration=0.07),
        'pin': lambda: cloth.call(SetPin, 'set_pin', row=row, col=col),
        'release': lambda: cloth.call(SetPin, 'set_pin', row=row, col=col, release=True),
        'corner': lambda: cloth.call(SetPin, 'set_pin', row=corner[0], col=corner[1]),
        'move': lambda: cloth.call(
            MovePin, 'move_pin', row=corner[0], col=corner[1], target=target,
            speed=chance.choice((0.0, 0.37, 2.0))),
        'mode': lambda: cloth.call(SetMode, 'set_mode', mode=chance.choice(MODES)),
        'parameter': lambda: cloth.set_parameters(publish__wrenches=chance.random() < 0.5),
        'clear': lambda: cloth.call(Trigger, 'clear_pushes'),
        'reset': lambda: cloth.call(Trigger, 'reset'),
    }


@pytest.mark.parametrize('mode', MODES)
def test_everything_that_can_be_done_is_done_again(cloth, recorded, mode, capsys):
    """A recorded run could not be made again: an input would lack, or come at another step."""
    node = cloth.client.node
    pushes = node.create_publisher(Push, f'{cloth.name}/push', 10)
    targets = node.create_publisher(PinTarget, f'{cloth.name}/pins/target', 100)
    cloth.client.spin_until(
        lambda: pushes.get_subscription_count() and targets.get_subscription_count(), 'it listens')
    cloth.call(SetMode, 'set_mode', mode=mode)
    step(cloth, 7)
    cloth.call(ApplyPush, 'apply_push', force=Vector3(z=2.0), duration=0.0333)
    pushes.publish(Push(
        force=Vector3(x=1.0), region=Push.SPHERE, radius=0.5, center=Point(z=0.9), start=0.1234,
        duration=0.05))
    cloth.client.spin_until(lambda: len(cloth['inputs/push']) == 2, 'both pushes are taken')
    cloth.call(SetPin, 'set_pin', row=5, col=5)
    cloth.call(MovePin, 'move_pin', row=0, col=0, target=Point(x=-0.5, y=0.3, z=1.1), speed=0.7)
    step(cloth, 20)
    targets.publish(PinTarget(row=5, col=5, target=Point(z=0.9), speed=0.31))
    cloth.client.spin_until(lambda: len(cloth['inputs/pin_target']) == 2, 'the target is taken')
    step(cloth, 3)
    cloth.call(SetPin, 'set_pin', row=5, col=5, release=True)
    cloth.call(SetMode, 'set_mode', mode=MODES[MODES.index(mode) - 1])
    cloth.set_parameters(publish__wrenches=False, clicked_point__radius=0.5)
    step(cloth, 11)
    cloth.call(ApplyPush, 'apply_push', force=Vector3(y=1.0), duration=9.0)
    step(cloth, 2)
    cloth.call(Trigger, 'clear_pushes')
    step(cloth, 5)
    cloth.call(Trigger, 'reset')
    cloth.call(ApplyPush, 'apply_push', force=Vector3(x=1.0, z=1.0), duration=0.02)
    step(cloth, 15)
    path = recorded()
    assert main(['resimulate', str(path), '--node', cloth.name]) == 0
    assert capsys.readouterr().out.splitlines() == ['9 of 9 frames bitwise identical']
    for publisher in (pushes, targets):
        node.destroy_publisher(publisher)


@pytest.mark.parametrize('seed', [
    1, 2, *(pytest.param(seed, marks=pytest.mark.long) for seed in range(3, 43))])
def test_random_inputs_are_done_again(cloth, recorded, seed):
    """An order of inputs that nobody has thought of would come out otherwise."""
    chance = random.Random(seed)
    frames = 1
    for _ in range(25):
        for _ in range(chance.choice((0, 1, 1, 3))):
            name, act = chance.choice(list(inputs_of(cloth, chance).items()))
            act()
            frames += name == 'reset'
        step(cloth, chance.choice((1, 2, 9)))
        frames += 1
    assert_same(recorded(), frames, cloth.name)


@pytest.mark.parametrize('factor', [0.0, 1.0])
def test_a_running_node_is_made_again(cloth, recorded, factor):
    """What is given while the wall clock decides when would come at another step."""
    cloth.set_parameters(real_time_factor=factor, mode='adaptive')
    cloth.call(SetBool, 'pause', data=False)
    chance = random.Random(5)
    end = time.monotonic() + 0.5
    while time.monotonic() < end:
        for name in ('push', 'corner', 'move', 'sphere', 'mode', 'pin', 'push'):
            inputs_of(cloth, chance)[name]()
        cloth.client.spin_for(0.02)
    cloth.call(Trigger, 'reset')
    cloth.client.spin_for(0.2)
    cloth.call(SetBool, 'pause', data=True)
    assert_same(recorded(), node=cloth.name)


def test_late_mass_spring_recording_has_the_same_bits(cloth):
    """Only runs recorded from their start could be compared bit by bit."""
    cloth.call(SetPin, 'set_pin', row=4, col=4)
    cloth.call(SetPin, 'set_pin', row=0, col=9, release=True)
    step(cloth, 30)
    cloth.call(ApplyPush, 'apply_push', force=Vector3(z=1.0), duration=0.3)
    step(cloth, 10)
    path = Path(cloth.call(StartRecording, 'start_recording').path)
    for _ in range(4):
        step(cloth, 13)
        cloth.call(ApplyPush, 'apply_push', force=Vector3(x=1.0), duration=0.05)
    cloth.call(SetMode, 'set_mode', mode='adaptive')
    step(cloth, 20)
    cloth.call(Trigger, 'stop_recording')
    assert_same(path, 6, cloth.name)


@pytest.mark.parametrize('mode', ['constraint', 'adaptive'])
def test_a_recording_that_begins_late_says_what_it_lacks(cloth, mode, capsys):
    """Bits would be promised that depend on what is not recorded, or nobody learn how far."""
    cloth.call(SetMode, 'set_mode', mode=mode)
    cloth.call(MovePin, 'move_pin', row=0, col=0, target=Point(x=-0.35, y=0.3, z=1.1), speed=0.2)
    step(cloth, 100)
    path = Path(cloth.call(StartRecording, 'start_recording').path)
    step(cloth, 4)
    step(cloth, 4)
    cloth.call(Trigger, 'reset')
    step(cloth, 50)
    cloth.call(Trigger, 'stop_recording')
    with made_again(path, cloth.name) as rerun:
        assert rerun.unknown[0] == f'what mode {mode} carried over from earlier steps'
        assert 'the moving pins' in rerun.unknown[1]
        # The reset and what came after it.
        assert rerun.check.equal >= 2
        assert rerun.check.largest is None or rerun.check.largest.distance < 1e-3
        assert rerun.check.last_rms == 0.0
    assert main(['resimulate', str(path), '--node', cloth.name]) == 0
    assert f'does not contain what mode {mode} carried over' in capsys.readouterr().out
