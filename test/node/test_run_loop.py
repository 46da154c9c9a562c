# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""Advance the simulation frame by frame at the pace of the wall clock, or stop at a blow-up."""

from collections.abc import Callable
from signal import SIGINT

from cloth_sim_interfaces.msg import ClothStats
from cloth_sim_interfaces.srv import ApplyPush
from cloth_sim_interfaces.srv import SetPin
from cloth_sim_interfaces.srv import StartRecording
from cloth_sim_interfaces.srv import Step
from cloth_sim_ros.analysis.frames import read_frames
from cloth_sim_ros.analysis.recording import Recording
from cloth_sim_ros.node.run_loop import PaceReport
from cloth_sim_ros.node.run_loop import Pacing
from cloth_sim_ros.node.run_loop import QUIET
from cloth_sim_ros.node.run_loop import STEADY
from cloth_sim_ros.sim.scene import Scene
from cloth_sim_ros.sim.simulation import Simulation
from cloth_under_test import ClothUnderTest
from cloth_under_test import SCENE
from geometry_msgs.msg import Vector3
from node_process import NodeProcess
import numpy as np
import pytest
from std_srvs.srv import SetBool
from std_srvs.srv import Trigger

_FRAME = 0.02
Log = list[tuple[float, str, str]]


def test_waits_for_the_rest_of_a_frame():
    """A node that took 5 ms for a frame of 20 ms would not run at real time."""
    pacing = Pacing(1.0)
    pacing.restart(100.0)
    assert pacing.delay(100.005, 0.02) == pytest.approx(0.015)


@pytest.mark.parametrize('factor, wait', [(2.0, 0.01), (0.5, 0.04)])
def test_keeps_to_the_factor(factor, wait):
    """Twice real time would not halve the wait, or half real time not double it."""
    pacing = Pacing(factor)
    pacing.restart(0.0)
    assert pacing.delay(0.0, 0.02) == pytest.approx(wait)


def test_factor_0_never_waits():
    """As fast as possible would still be paced."""
    pacing = Pacing(0.0)
    pacing.restart(0.0)
    assert [pacing.delay(0.001 * i, 0.02) for i in range(5)] == [0.0] * 5


def test_catches_up_after_a_late_frame():
    """One late frame would make the whole run late."""
    pacing = Pacing(1.0)
    pacing.restart(0.0)
    assert pacing.delay(0.05, 0.02) == 0.0
    assert pacing.delay(0.051, 0.02) == 0.0
    assert pacing.delay(0.052, 0.02) == pytest.approx(0.008)


def test_gives_up_what_is_too_late_to_catch_up_with():
    """After a long halt the node would run without a pause for as long again."""
    pacing = Pacing(1.0)
    pacing.restart(0.0)
    pacing.delay(10.0, 0.02)
    waits = [pacing.delay(10.0, 0.02) for _ in range(20)]
    assert waits[0] == 0.0
    assert waits[-1] > 0.0


def test_measures_the_factor_achieved():
    """The factor in ~/stats would not be simulated time over wall time."""
    pacing = Pacing(1.0)
    pacing.restart(0.0)
    assert pacing.achieved == 0.0
    for frame in range(1, 201):
        pacing.delay(0.04 * frame, 0.02)
    assert pacing.achieved == pytest.approx(0.5)


@pytest.mark.parametrize('factor', [0.5, 1.0, 2.0])
def test_real_time_factor_from_the_first_frame(factor):
    """Plots would begin at ten times real time, since the first frame waits for nothing."""
    pacing = Pacing(factor)
    pacing.restart(10.0)
    now = 10.0
    for _ in range(100):
        now += 0.001
        wait = pacing.delay(now, _FRAME)
        assert pacing.achieved == pytest.approx(factor, rel=0.03)
        now += wait


@pytest.mark.parametrize('frame_time, too_slow', [(0.04, True), (0.02, False)])
def test_tells_when_it_is_too_slow(frame_time, too_slow):
    """A slow machine would give no warning, or a fast enough one would."""
    pacing = Pacing(1.0)
    pacing.restart(0.0)
    pacing.delay(frame_time, 0.02)
    assert not pacing.too_slow, 'one frame says nothing yet'
    for frame in range(2, 201):
        pacing.delay(frame_time * frame, 0.02)
    assert pacing.too_slow == too_slow


@pytest.fixture
def run() -> Callable[..., Log]:
    """
    Return a function that runs frames, and returns when the log got what.

    It takes spans of wall time [s], each with the pace of its frames.
    """
    simulation = Simulation(Scene({'rows': 8, 'cols': 8}))
    assert simulation.substeps > 1

    def make(*spans: tuple[float, float]) -> Log:
        log: Log = []
        now = 0.0
        pacing = Pacing(1.0)
        report = PaceReport(
            simulation, pacing, warn=lambda text: log.append((now, 'warning', text)),
            say=lambda text: log.append((now, 'info', text)))
        pacing.restart(now)
        for length, pace in spans:
            end = now + length
            while now < end:
                now += _FRAME / pace
                pacing.delay(now, _FRAME)
                report.look(now)
        return log

    yield make
    simulation.close()


def test_a_slow_run_is_warned_of_once(run):
    """The log of a slow machine would fill with one and the same line."""
    (time, level, text), = run((600.0, 0.5))
    assert level == 'warning' and time < 2.0
    assert text == (
        '0.5 x real time, below the target 1: use fewer nodes, softer springs, another mode or a '
        'lower real_time_factor')


def test_a_run_that_keeps_up_again_says_so(run):
    """Nobody would know whether what was changed has helped."""
    _, (time, level, text) = run((20.0, 0.5), (60.0, 1.0))
    assert level == 'info' and 20.0 + STEADY < time < 20.0 + STEADY + 3.0
    assert text == '1 x real time: the run keeps up again'


def test_slow_run_warning_once_a_minute(run):
    """Two lines would come every few seconds."""
    log = run(*[(10.0, 0.5), (10.0, 1.0)] * 30)
    warnings = [time for time, level, _ in log if level == 'warning']
    assert 5 <= len(warnings) <= 600.0 / QUIET + 1
    assert min(after - before for before, after in zip(warnings, warnings[1:])) >= QUIET
    assert len(log) <= 2 * len(warnings)


def test_a_short_halt_is_not_told(run):
    """A garbage collection would look like a machine that is too slow."""
    assert run((10.0, 1.0), (0.05, 0.4), (20.0, 1.0)) == []


# Long frames, and a run whose next state would not be finite.

FRAME = 4  # steps of dt
TOO_MUCH = {'force': Vector3(x=1e30), 'duration': 1.0}


def test_stops_before_the_state_is_not_finite_and_can_go_on(client, tmp_path):
    """A cloth of NaN would be published for ever, or the node could not be used any more."""
    with NodeProcess(tmp_path, SCENE, '-r', '__ns:=/blow_up') as node:
        cloth = ClothUnderTest(client, SCENE, '/blow_up/cloth_sim')
        cloth.wait_for('stats', lambda stats: stats.steps > 0)
        started = cloth.call(StartRecording, 'start_recording', name='blow_up')
        assert cloth.call(ApplyPush, 'apply_push', **TOO_MUCH).success
        cloth.wait_for('state', lambda state: state.run_state == 'stopped')
        found = cloth.wait_for('diagnostics', lambda array: any(
            'non-finite' in status.message for status in array.status))
        [status] = [status for status in found.status if 'non-finite' in status.message]
        assert status.level == status.ERROR
        assert 'push with less force' in status.message
        assert node.output.count('the state became non-finite') == 1
        assert 'call ~/reset' in node.output

        answer = cloth.call(Step, 'step', steps=1)
        assert not answer.success and 'push with less force' in answer.message
        assert cloth.call(SetPin, 'set_pin', row=1, col=1).success, 'services still answer'
        cloth.clear()
        assert cloth.call(SetBool, 'pause', data=False).success, 'it tries again'
        cloth.wait_for('state', lambda state: state.run_state == 'running')
        cloth.wait_for('state', lambda state: state.run_state == 'stopped')

        assert cloth.call(Trigger, 'clear_pushes').success
        stopped_at = cloth.wait_for('stats').steps
        cloth.clear()
        assert cloth.call(SetBool, 'pause', data=False).success
        cloth.wait_for('state', lambda state: state.run_state == 'running')
        cloth.wait_for('stats', lambda stats: stats.steps > stopped_at + 20)
        assert cloth['state'][-1].run_state == 'running'
        assert all(np.abs(cloth.points_of(cloud)['x']).max() < 1e3 for cloud in cloth['points'])

        assert cloth.call(ApplyPush, 'apply_push', **TOO_MUCH).success
        cloth.client.spin_until(
            lambda: cloth['state'][-1].run_state == 'stopped', 'the second stop')
        cloth.clear()
        assert cloth.call(Trigger, 'reset').success
        cloth.wait_for('state', lambda state: state.run_state == 'running')
        assert cloth.call(Trigger, 'stop_recording').success
    frames = list(read_frames(Recording(started.path, '/blow_up/cloth_sim')))
    assert len(frames) > 2
    assert all(np.isfinite(frame.positions).all() for frame in frames)


def test_a_step_into_the_same_is_told_too(cloth):
    """A paused cloth would be stepped on as NaN, or forget that it was paused."""
    cloth.call(ApplyPush, 'apply_push', **TOO_MUCH)
    answer = cloth.call(Step, 'step', steps=50)
    assert not answer.success and 'non-finite' in answer.message
    assert answer.sim_time < 50 * cloth.dt
    cloth.wait_for('state', lambda state: state.run_state == 'stopped')
    cloth.clear()
    assert cloth.call(Trigger, 'clear_pushes').success
    assert cloth.call(Step, 'step', steps=1).success, 'without the push it can go on'
    cloth.wait_for('state', lambda state: state.run_state == 'paused')
    cloth.call(ApplyPush, 'apply_push', **TOO_MUCH)
    cloth.call(Step, 'step', steps=50)
    cloth.clear()
    cloth.call(Trigger, 'reset')
    cloth.wait_for('state', lambda state: state.run_state == 'paused')
    assert cloth.call(Step, 'step', steps=1).success


def test_services_are_answered_during_a_long_frame(client, tmp_path):
    """A low rate of frames would make the node deaf, to requests and to being stopped."""
    slow = {**SCENE, 'publish.rate': 0.001, 'dt': 1e-4}
    with NodeProcess(tmp_path, slow, '-r', '__ns:=/long_frame') as node:
        cloth = ClothUnderTest(client, slow, '/long_frame/cloth_sim')
        assert cloth.call(SetBool, 'pause', data=True).success
        assert 0.0 < cloth.call(Step, 'step', steps=1).sim_time < 1000.0
        assert cloth.call(SetBool, 'pause', data=False).success
        node.send(SIGINT)
        assert node.wait() == 0


def test_a_quick_cloth_runs_on(client, tmp_path):
    """A node whose frames are made in no time would end after 1024 of them."""
    quick = {**SCENE, 'rows': 2, 'cols': 2, 'real_time_factor': 0.0}
    with NodeProcess(tmp_path, quick, '-r', '__ns:=/quick') as node:
        stats = client.watch(ClothStats, '/quick/cloth_sim/stats', depth=10)
        client.spin_until(
            lambda: not node.running or (
                stats.messages and stats.messages[-1].steps > 1100 * FRAME), 'the 1100th frame')
        assert node.running, node.output


def test_a_run_stops_where_stamps_end(client, tmp_path):
    """The node would fail at each frame from then on, or leave a step without its answer."""
    start = (
        'import sys; import cloth_sim_ros.sim.stepping as stepping; stepping.LATEST = 0.1; '
        'from cloth_sim_ros.node.main import main; sys.exit(main())')
    with NodeProcess(tmp_path, SCENE, '-r', '__ns:=/late', start=start) as node:
        cloth = ClothUnderTest(client, SCENE, '/late/cloth_sim')
        cloth.wait_for('state', lambda state: state.run_state == 'stopped')
        client.spin_until(
            lambda: 'simulated time ends at 0.1 s' in node.output, 'the reason in the log')
        cloth.wait_for('stats', lambda stats: cloth.steps_of(stats) == 20)
        assert all(cloth.steps_of(stats) <= 20 for stats in cloth['stats'])
        for _ in range(2):
            answer = cloth.call(Step, 'step', steps=1)
            assert not answer.success and 'reset it' in answer.message
        # Else it may be at the end again before it is paused.
        assert cloth.call(SetBool, 'pause', data=True).success
        assert cloth.call(Trigger, 'reset').success
        assert cloth.call(Step, 'step', steps=1).message.startswith('1 steps done')
