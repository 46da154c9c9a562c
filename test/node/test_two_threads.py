# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""What comes while a step is under way: what ROS is asked is answered, the cloth changes after."""

from pathlib import Path
import time
from typing import Any

from cloth_sim_interfaces.msg import ClothStats
from cloth_sim_interfaces.srv import ApplyPush
from cloth_sim_interfaces.srv import Grasp
from cloth_sim_interfaces.srv import Release
from cloth_sim_interfaces.srv import SetMode
from cloth_sim_interfaces.srv import SetPin
from cloth_sim_interfaces.srv import StartRecording
from cloth_sim_interfaces.srv import Step
from cloth_sim_ros.recording.bag_reader import BagReader
from cloth_under_test import ClothUnderTest
from cloth_under_test import PAUSED
from cloth_under_test import SCENE
from geometry_msgs.msg import Point
from geometry_msgs.msg import Pose
from geometry_msgs.msg import PoseStamped
from geometry_msgs.msg import Vector3
from graph_client import GraphClient
from graph_client import PATIENCE
from node_process import NodeProcess
import pytest
from rcl_interfaces.srv import GetParameters
import rclpy
from recorded import Recorded
from rosgraph_msgs.msg import Clock
from sensor_msgs.msg import PointCloud2
from std_srvs.srv import SetBool
from std_srvs.srv import Trigger

FRAME = 4  # steps of dt
UNPACED = {**SCENE, 'real_time_factor': 0.0}

# A node whose steps wait, each by itself, while there is a file ``hold``; then ``held`` has the
# number of the step.
HELD = """
from cloth_sim_ros.node.main import main
from cloth_sim_ros.sim.simulation import Simulation
from pathlib import Path
import sys
import time

def held(simulation, number, most, stop):
    is_told = False
    while Path('hold').exists() and not stop():
        if not is_told:
            Path('held.new').write_text(str(number))
            Path('held.new').rename('held')
            is_told = True
        time.sleep(1e-3)
    return works(simulation, number, 1, stop)

works, Simulation._make_steps = Simulation._make_steps, held
sys.exit(main())
"""

# A node that writes its recordings more slowly than it makes them.
SLOW_DISK = """
from cloth_sim_ros.node.main import main
from cloth_sim_ros.recording import recorder
from cloth_sim_ros.recording.bag_writer import BagWriter
import sys
import time

def write(*arguments):
    time.sleep(2e-3)
    return works(*arguments)

works, BagWriter.write, recorder.MOST_WAITING = BagWriter.write, write, 2**14
sys.exit(main())
"""


def hold(folder: Path) -> int:
    """Return the number of a step that is under way until ``let_go``."""
    (folder / 'hold').touch()
    deadline = time.monotonic() + PATIENCE
    while not (folder / 'held').exists():
        assert time.monotonic() < deadline, 'no step begins'
        time.sleep(1e-3)
    return int((folder / 'held').read_text())


def let_go(folder: Path) -> None:
    """Let the step under way end, and all others."""
    (folder / 'hold').unlink()
    (folder / 'held').unlink()


def ask(cloth: ClothUnderTest, kind: type, name: str, /, **fields: Any) -> Any:
    """Call a service of the node and return the future of its answer."""
    return cloth.client.service(kind, f'{cloth.name}/{name}').call_async(kind.Request(**fields))


def wait_until_taken(cloth: ClothUnderTest) -> None:
    """Return when the ROS thread has taken what was asked of it before."""
    for _ in range(5):
        cloth.call(GetParameters, 'get_parameters', names=['dt'])
        cloth.client.spin_for(0.1)


def test_parameters_are_told_while_a_step_is_under_way(client: GraphClient, tmp_path: Path):
    """With a slow cloth, every tool that lists parameters would take the node for dead."""
    with NodeProcess(tmp_path, SCENE, '-r', '__ns:=/held', start=HELD):
        cloth = ClothUnderTest(client, SCENE, '/held/cloth_sim')
        step = hold(tmp_path)
        pin = ask(cloth, SetPin, 'set_pin', row=4, col=4)
        # Else the second request could wait for the end of the step that the first begins with.
        for _ in range(5):
            assert cloth.call(GetParameters, 'get_parameters', names=['dt']).values
            assert cloth.set_parameters(publish__markers=False).successful
        assert not pin.done()
        let_go(tmp_path)
        client.spin_until(pin.done, 'the pin')
        assert cloth.steps_of(cloth.wait_for('inputs/pin')) == step + 1


def test_requests_are_carried_out_after_the_step(client: GraphClient, tmp_path: Path):
    """A push, a pin or a pause would wait for the end of the frame, or of all steps asked for."""
    with NodeProcess(tmp_path, SCENE, '-r', '__ns:=/held', start=HELD):
        cloth = ClothUnderTest(client, SCENE, '/held/cloth_sim')
        cloth.wait_for('stats')
        step = hold(tmp_path)
        futures = [
            ask(cloth, SetPin, 'set_pin', row=4, col=4),
            ask(cloth, ApplyPush, 'apply_push', force=Vector3(z=0.01), duration=0.01),
            ask(cloth, SetBool, 'pause', data=True)]
        wait_until_taken(cloth)
        let_go(tmp_path)
        client.spin_until(lambda: all(future.done() for future in futures), 'the answers')
        assert all(future.result().success for future in futures)
        for key in ('inputs/pin', 'inputs/push'):
            assert step + 1 <= cloth.steps_of(cloth.wait_for(key)) <= step + 2
        paused = futures[-1].result().message
        assert float(paused.split()[-2]) <= (step + 2) * cloth.dt + 1e-9, paused


def test_one_health_report_after_a_long_step(client: GraphClient, tmp_path: Path):
    """After a step of a minute, sixty reports would hold up the requests behind them."""
    with NodeProcess(tmp_path, SCENE, '-r', '__ns:=/held', '-r', '__node:=alone', start=HELD):
        cloth = ClothUnderTest(client, SCENE, '/held/alone')
        hold(tmp_path)
        client.spin_for(6.5)
        cloth.clear()
        let_go(tmp_path)
        assert cloth.call(SetBool, 'pause', data=True).success
        # The topic is everybody's.
        assert sum('alone' in array.status[0].name for array in cloth['diagnostics']) <= 3


def test_step_is_answered_with_what_was_asked_for(client: GraphClient, tmp_path: Path):
    """Requests between its steps would cost it some, or be counted as steps."""
    with NodeProcess(tmp_path, PAUSED, '-r', '__ns:=/counted') as node:
        cloth = ClothUnderTest(client, PAUSED, '/counted/cloth_sim')
        made = 0
        for asked in (1, 7, 250, 3, 2000):
            steps = ask(cloth, Step, 'step', steps=asked)
            while not steps.done():
                assert cloth.call(
                    ApplyPush, 'apply_push', force=Vector3(z=1e-3), duration=0.01).success
            made += asked
            assert steps.result().success, steps.result().message
            assert steps.result().sim_time == pytest.approx(made * cloth.dt, rel=1e-12)
            # It was emitted before the answer.
            assert cloth.wait_for('stats', lambda stats, made=made: stats.steps == made)
        assert 'unexpected' not in node.output


@pytest.mark.long
def test_large_cloth_answers_within_a_step(client: GraphClient, tmp_path: Path):
    """256 x 256 nodes in mode constraint take a second a step, and a caller has a timeout."""
    values = {**PAUSED, 'rows': 256, 'cols': 256, 'mode': 'constraint', 'dt': 0.02,
              'publish.markers': False}
    with NodeProcess(tmp_path, values, '-r', '__ns:=/large'):
        name = '/large/cloth_sim'
        client.call_until_answered(GetParameters, f'{name}/get_parameters', names=['dt'])
        for kind, service in ((Step, 'step'), (SetPin, 'set_pin'), (SetBool, 'pause')):
            client.service(kind, f'{name}/{service}')
        assert client.call(Step, f'{name}/step', steps=1).success
        steps = client.service(Step, f'{name}/step').call_async(Step.Request(steps=3))
        for _ in range(3):
            assert client.call(GetParameters, f'{name}/get_parameters', names=['dt']).values
            assert not steps.done()
        # Between two of many steps.
        client.spin_until(steps.done, 'the step')
        steps = client.service(Step, f'{name}/step').call_async(Step.Request(steps=1000))
        assert client.call(SetPin, f'{name}/set_pin', row=128, col=128).success
        assert not steps.done()
        client.call(SetBool, f'{name}/pause', data=True)
        client.spin_until(steps.done, 'the answer to the steps')
        assert not steps.result().success


# Recordings.

def steps_of(message: Any, dt: float = SCENE['dt']) -> int:
    """Return how many steps the stamp of ``message`` amounts to."""
    stamp = message.header.stamp
    return round((stamp.sec + stamp.nanosec * 1e-9) / dt)


def check_frames(bag: Recorded, *, is_cut: bool = False) -> list[int]:
    """
    Return the steps of the recorded frames; nothing may be missing between them.

    ``is_cut`` allows for a last frame that is not complete.
    """
    clouds = [steps_of(cloud) for cloud in bag.messages('points')]
    stats = [steps_of(stats) for stats in bag.messages('stats')]
    assert clouds == stats or (is_cut and clouds[:-1] == stats)
    gaps = [after - before for before, after in zip(clouds, clouds[1:])]
    # The first one has what was under way, the second the rest of that frame.
    assert 0 < gaps[0] <= FRAME and set(gaps[1:]) == {FRAME}
    return clouds


@pytest.mark.parametrize('start', [None, SLOW_DISK], ids=['disk', 'slow disk'])
@pytest.mark.parametrize('factor', [0.0, 1.0])
def test_recordings_miss_no_frame_of_a_run(
        client: GraphClient, tmp_path: Path, start: str | None, factor: float):
    """A recording that was begun while the cloth runs would have gaps that nobody sees."""
    given = {} if start is None else {'start': start}
    values = {**SCENE, 'real_time_factor': factor}
    with NodeProcess(tmp_path, values, '-r', '__ns:=/run', **given) as node:
        # It never reads what it gets.
        slow = rclpy.create_node('slow', context=client.node.context)
        slow.create_subscription(PointCloud2, '/run/cloth_sim/points', print, 1)
        stats = client.watch(ClothStats, '/run/cloth_sim/stats')
        client.spin_until(lambda: stats.messages, 'the node runs')
        for name in ('first', 'second'):
            before = stats.messages[-1].steps
            answer = client.call_until_answered(
                StartRecording, '/run/cloth_sim/start_recording', name=name)
            assert (tmp_path / 'bags' / name).exists(), answer.message
            stats.clear()
            client.spin_until(
                lambda: stats.messages and stats.messages[-1].steps > before + 40 * FRAME,
                'some frames')
            newest = stats.messages[-1].steps
            client.call_until_answered(Trigger, '/run/cloth_sim/stop_recording')
            clouds = check_frames(Recorded(tmp_path / 'bags' / name))
            assert before <= clouds[0]
            # All up to the answer, which comes after what was seen before it was asked for.
            assert clouds[-1] >= newest
        slow.destroy_node()
        assert 'unexpected' not in node.output


def test_recordings_that_begin_beside_a_reset(client: GraphClient, tmp_path: Path):
    """Players would show it far in the future, or its beginning after its end."""
    with NodeProcess(tmp_path, UNPACED, '-r', '__ns:=/again') as node:
        cloth = ClothUnderTest(client, UNPACED, '/again/cloth_sim')
        assert cloth.set_parameters(real_time_factor=0.0).successful
        for number in range(6):
            cloth.clear()
            cloth.wait_for('stats', lambda stats: stats.steps > 20)
            futures = [
                ask(cloth, Trigger, 'reset'),
                ask(cloth, StartRecording, 'start_recording', name=f'run{number}')]
            client.spin_until(lambda: all(future.done() for future in futures), 'the answers')
            cloth.clear()
            cloth.wait_for('stats')
            assert cloth.call(Trigger, 'reset').success
            cloth.clear()
            cloth.wait_for('stats')
            assert cloth.call(Trigger, 'stop_recording').success
            times, offset, latest = [], 0, 0
            for topic, time_ns, message in Recorded(tmp_path / 'bags' / f'run{number}').entries:
                if topic.endswith('/stats'):
                    step = steps_of(message)
                    # Before the reset, it went on up to some time after the last frame.
                    if step < latest:
                        offset = time_ns - round(step * SCENE['dt'] * 1e9)
                        assert offset >= round(latest * SCENE['dt'] * 1e9)
                    assert time_ns - offset == round(step * SCENE['dt'] * 1e9)
                    latest = step
                times.append(time_ns)
            assert times == sorted(times)
        assert 'unexpected' not in node.output


def test_recordings_that_are_full_while_others_begin(client: GraphClient, tmp_path: Path):
    """Frames of one recording would get into the next, or a start fail for ever."""
    values = {**UNPACED, 'recording.max_size': 2**20}
    with NodeProcess(tmp_path, values, '-r', '__ns:=/full') as node:
        cloth = ClothUnderTest(client, values, '/full/cloth_sim')
        assert cloth.set_parameters(real_time_factor=0.0).successful
        begun = []
        while len(begun) < 8:
            answer = cloth.call(StartRecording, 'start_recording')
            if answer.success:
                begun.append(Path(answer.path))
            else:
                assert 'a recording is being written' in answer.message
        cloth.call(Trigger, 'stop_recording')
        assert node.output.count('recording.max_size') >= len(begun) - 1
        assert 'unexpected' not in node.output
    for path in begun[:-1]:
        bag = Recorded(path)
        assert len(bag.messages('topology')) == len(bag.messages('inputs/mode')) == 1
        check_frames(bag, is_cut=True)
        assert BagReader(path).problems == []


# What both threads look at.

def test_modes_and_a_reset_within_one_step(client: GraphClient, tmp_path: Path):
    """The mode asked for first would step, or a caller wait for ever."""
    with NodeProcess(tmp_path, SCENE, '-r', '__ns:=/modes', start=HELD) as node:
        cloth = ClothUnderTest(client, SCENE, '/modes/cloth_sim')
        for mode in ('constraint', 'mass_spring'):
            assert cloth.call(SetMode, 'set_mode', mode=mode, wait=True).success
        cloth.clear()
        hold(tmp_path)
        futures = []
        for mode in ('constraint', 'mass_spring', 'constraint'):
            futures.append(ask(cloth, SetMode, 'set_mode', mode=mode, wait=True))
            futures.append(ask(cloth, Trigger, 'reset'))
            wait_until_taken(cloth)
        let_go(tmp_path)
        client.spin_until(lambda: all(future.done() for future in futures), 'the answers')
        told = [future.result() for future in futures]
        assert [answer.success for answer in told] == [False, True, False, True, True, True]
        assert 'requested before' in told[0].message and 'requested before' in told[2].message
        cloth.clear()
        cloth.wait_for('stats', lambda stats: stats.steps > 0)
        assert cloth.call(
            SetMode, 'set_mode', mode='constraint', wait=True).previous_mode == 'constraint'
        assert 'unexpected' not in node.output


def test_a_grasp_that_goes_while_targets_come(client: GraphClient, tmp_path: Path):
    """A target for a grasp that has just been lost would end the node, or move the next one."""
    with NodeProcess(tmp_path, UNPACED, '-r', '__ns:=/grasps') as node:
        cloth = ClothUnderTest(client, UNPACED, '/grasps/cloth_sim')
        publisher = client.node.create_publisher(
            PoseStamped, '/grasps/cloth_sim/grasps/hand/target', 100)
        here = Pose(position=Point(x=0.0, y=0.0, z=1.0))
        for number in range(10):
            lost = node.output.count('has lost the cloth')
            # The cloth pulls itself loose from every other one.
            grasp = cloth.call(
                Grasp, 'grasp', name='hand', pose=here, radius=2.0,
                max_force=0.01 if number % 2 else 0.0)
            assert grasp.success, grasp.message
            # One that is lost at once may be gone before it is discovered.
            client.spin_until(
                lambda: publisher.get_subscription_count()
                or node.output.count('has lost the cloth') > lost, 'the node listens')
            for step in range(20):
                target = PoseStamped(pose=Pose(position=Point(x=0.0, y=0.0, z=1.0 + step * 0.01)))
                publisher.publish(target)
            released = ask(cloth, Release, 'release', name='hand')
            for _ in range(20):
                publisher.publish(PoseStamped(pose=here))
            client.spin_until(released.done, 'the release')
            client.spin_until(
                lambda: publisher.get_subscription_count() == 0, 'the node listens no more')
            assert cloth.call(Trigger, 'reset').success
        assert 'unexpected' not in node.output
        client.node.destroy_publisher(publisher)


def test_frames_of_pins_while_pins_and_transforms_change(client: GraphClient, tmp_path: Path):
    """A push in the frame of a pin would be looked up in what the other thread is changing."""
    with NodeProcess(tmp_path, UNPACED, '-r', '__ns:=/frames') as node:
        cloth = ClothUnderTest(client, UNPACED, '/frames/cloth_sim')
        pushed, futures = [], []
        for number in range(60):
            row = 2 + number % 4
            futures.append(ask(cloth, SetPin, 'set_pin', row=row, col=5))
            push = ApplyPush.Request(force=Vector3(z=1e-3), duration=0.01)
            push.header.frame_id = f'frames_cloth_sim_pin_{row}_5'
            pushed.append(cloth.client.service(
                ApplyPush, f'{cloth.name}/apply_push').call_async(push))
            futures.append(ask(cloth, SetPin, 'set_pin', row=row, col=5, release=True))
            client.spin_for(0.01)
            # A client keeps ten answers of a service; more that come at once are lost.
            if number % 4 == 3:
                client.spin_until(lambda: all(
                    future.done() for future in futures + pushed), 'the answers')
        assert all(future.result().success for future in futures)
        # A push may come before its pin or after; then it says so.
        for future in pushed:
            answer = future.result()
            assert answer.success or 'grasp or pin first' in answer.message, answer.message
        assert 'unexpected' not in node.output


def test_a_clock_that_comes_and_goes(client: GraphClient, tmp_path: Path):
    """The thread that steps would ask a publisher that the other has just closed."""
    values = {**UNPACED, 'publish.clock': True}
    with NodeProcess(tmp_path, values, '-r', '__ns:=/clocks') as node:
        stats = client.watch(ClothStats, '/clocks/cloth_sim/stats', depth=10)
        client.spin_until(lambda: stats.messages, 'the node runs')

        def has_clock() -> bool:
            return '/clocks' in [
                info.node_namespace
                for info in client.node.get_publishers_info_by_topic('/clock')]

        client.spin_until(has_clock, 'the node has the clock')
        for _ in range(2):
            other = client.node.create_publisher(Clock, '/clock', 10)
            client.spin_until(lambda: not has_clock(), 'the node has closed it')
            client.node.destroy_publisher(other)
            client.spin_until(has_clock, 'the node has it again')
        steps = stats.messages[-1].steps
        client.spin_until(lambda: stats.messages[-1].steps > steps, 'it runs on')
        assert 'unexpected' not in node.output
