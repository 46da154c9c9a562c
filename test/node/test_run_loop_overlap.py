# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""Late frames are sent after the next one has begun: each once, in order, and as it was."""

from collections.abc import Callable
from collections.abc import Iterator
from pathlib import Path

from cloth_sim_interfaces.srv import ApplyPush
from cloth_sim_interfaces.srv import MovePin
from cloth_sim_interfaces.srv import SetMode
from cloth_sim_interfaces.srv import SetPin
from cloth_sim_interfaces.srv import Step
from cloth_sim_ros.analysis.recording import Recording
from cloth_sim_ros.node.frame_executor import Alarm
from cloth_sim_ros.node.run_loop import Pacing
from cloth_sim_ros.node.run_loop import RunLoop
from cloth_sim_ros.sim import modes
from cloth_sim_ros.sim.scene import Scene
from cloth_sim_ros.sim.simulation import Simulation
from cloth_under_test import ClothUnderTest
from cloth_under_test import SCENE
from command import cloth_sim
from geometry_msgs.msg import Point
from geometry_msgs.msg import Vector3
from graph_client import GraphClient
from node_process import NodeProcess
import numpy as np
import pytest
from recorded import Recorded
from std_srvs.srv import SetBool
from std_srvs.srv import Trigger

# Steps of dt in a frame, and its simulated time [s].
STEPS = 4
FRAME = STEPS * SCENE['dt']
Sent = tuple[int, bool, bytes]


class Run:
    """
    A run loop without a node, which keeps what it sends.

    :param factor: to pace frames by; 0 for as fast as possible
    """

    def __init__(self, factor: float, *, overlaps: bool = True, **values: object) -> None:
        """Prepare a cloth."""
        self.simulation = Simulation(Scene({**SCENE, **values}))
        self.alarm = Alarm(lambda: None)
        # Steps, whether the next step was under way, and the records.
        self.sent: list[Sent] = []
        self.begun: list[int] = []
        self.asked: list[bool] = []
        self.log: list[str] = []
        self.pacing = Pacing(factor)
        self.loop = RunLoop(
            self.alarm, self.simulation, frame_seconds=FRAME, pacing=self.pacing,
            paused=False, on_frame=self._on_frame, on_stop=lambda: self.log.append('stopped'),
            note=lambda error, where: str(error), overlaps=overlaps)
        self.loop.start()

    def _on_frame(self, worked: float, steps: int, later: bool) -> Callable[[], None] | None:
        assert len(self.begun) == len(self.sent), 'the one before is sent'
        self.begun.append(self.simulation.steps)
        self.asked.append(later)
        take = self.simulation.begin_snapshot() if later else self.simulation.snapshot

        def send() -> None:
            snapshot = take()
            self.log.append(f'sent {snapshot.steps}')
            self.sent.append((
                snapshot.steps, self.simulation.stepping.is_mid_step, snapshot.records.tobytes()))

        if later:
            return send
        send()
        return None

    def ring(self) -> None:
        """Work for a slice, as the executor does between the requests that it serves."""
        if self.alarm.left is not None:
            self.alarm.ring()
        assert len(self.begun) == len(self.sent), 'no request meets a frame that waits'

    def until(self, count: int) -> None:
        """Go on until ``count`` frames are sent, or the run has stopped."""
        while len(self.sent) < count and self.alarm.left is not None:
            self.ring()


@pytest.fixture
def run() -> Iterator[Callable[..., Run]]:
    """Return a function that begins a run."""
    opened = []

    def begin(*arguments: float, **values: object) -> Run:
        opened.append(Run(*arguments, **values))
        return opened[-1]

    yield begin
    for each in opened:
        each.loop.close()
        each.simulation.close()


@pytest.mark.parametrize('mode', modes.AVAILABLE)
def test_late_frames_are_those_of_a_run_that_waits(run, mode: str):
    """A frame would be lost, sent twice, or be of another step than it says."""
    overlapping, waiting = run(0.0, mode=mode), run(0.0, mode=mode, overlaps=False)
    for each in (overlapping, waiting):
        each.until(6)
    assert [steps for steps, _, _ in overlapping.sent] == [STEPS * n for n in range(1, 7)]
    assert [(steps, data) for steps, _, data in overlapping.sent] == [
        (steps, data) for steps, _, data in waiting.sent]
    assert all(is_mid_step for _, is_mid_step, _ in overlapping.sent), 'the next has begun'
    assert not any(is_mid_step for _, is_mid_step, _ in waiting.sent)


def test_a_frame_that_is_in_time_waits_for_nothing(run):
    """At real-time pace messages would come later than they have to."""
    in_time = run(1e-3)
    in_time.until(1)
    assert in_time.asked == [False]
    assert not in_time.sent[0][1] and not in_time.simulation.stepping.is_mid_step
    late = run(1e9)
    late.until(3)
    assert late.asked == [True] * 3


@pytest.mark.parametrize('change', [
    lambda run: run.loop.pause(),
    lambda run: run.simulation.stepping.at_rest(lambda: (
        run.simulation.reset(), run.loop.restart())),
    lambda run: run.simulation.push((0.0, 0.0, 0.3), duration=0.05),
    lambda run: run.simulation.pin(3, 3),
    lambda run: run.simulation.stepping.at_rest(lambda: run.simulation.set_mode('constraint'))])
def test_requests_between_leave_the_frames_in_order(run, change: Callable[[Run], object]):
    """A request that meets the next frame under way would take the one before it along."""
    asked = run(0.0)
    for number in range(1, 4):
        asked.until(2 * number)
        change(asked)
        asked.ring()
        asked.ring()
        asked.loop.resume()
    steps = [steps for steps, _, _ in asked.sent]
    starts = [number for number, (before, after) in enumerate(zip(steps, steps[1:]), 1)
              if after <= before]
    for part in np.split(steps, starts):
        assert part.tolist() == list(range(STEPS, STEPS * len(part) + 1, STEPS))


def test_requested_steps_are_published_before_the_reply(run):
    """A caller would continue before the frame of its steps is published."""
    stepped = run(0.0)
    stepped.until(2)
    stepped.loop.pause()
    while stepped.alarm.left is not None:
        stepped.ring()
    before = stepped.simulation.steps
    answer = stepped.loop.step(3)
    while not answer.done():
        stepped.ring()
    assert answer.result() is None
    assert stepped.sent[-1][:2] == (before + 3, False)


def test_a_frame_is_sent_before_the_run_stops_at_the_next(run, monkeypatch: pytest.MonkeyPatch):
    """The last frame before a failure would be lost, or come after its report."""
    monkeypatch.setattr('cloth_sim_ros.sim.stepping.LATEST', 2 * FRAME)
    ends = run(0.0)
    ends.until(9)
    assert ends.log == ['sent 4', 'sent 8', 'stopped']
    assert 'simulated time ends at' in ends.loop.problem


def test_the_frames_before_a_blow_up_are_sent(run):
    """A run that is lost would take its last good frame along."""
    lost = run(0.0)
    lost.until(2)
    lost.simulation.push((1e30, 0.0, 0.0), duration=1.0)
    lost.until(99)
    assert lost.log[-1] == 'stopped' and 'non-finite' in lost.loop.problem
    steps = [steps for steps, _, _ in lost.sent]
    assert steps == sorted(set(steps)) and steps[-1] == lost.simulation.steps
    last = np.frombuffer(lost.sent[-1][2], dtype=np.float32)
    assert np.isfinite(last).all()


def test_a_run_that_is_closed_keeps_its_last_frame(run):
    """A step that was under way for the next frame would stay in the state."""
    closed = run(0.0)
    closed.until(3)
    assert closed.simulation.stepping.is_mid_step
    closed.loop.close()
    assert closed.simulation.steps == 3 * STEPS
    assert closed.simulation.snapshot().records.tobytes() == closed.sent[-1][2]


# The same in a node: published, recorded, and made again.

VALUES = {
    'rows': 24, 'cols': 24, 'dt': 0.005, 'publish.rate': 50.0, 'real_time_factor': 0.0,
    'publish.wrenches': False, 'recording.enabled': True, 'recording.name': 'late'}
# A node that overlaps on any device, and says at its end how often it has.
START = """
import sys
from cloth_sim_ros.node.process import run_node
from cloth_sim_ros.node.shared_memory import frame_bytes
from cloth_sim_ros.node.shared_memory import reclaim_dead_segments
from cloth_sim_ros.node.shared_memory import use_profile
from cloth_sim_ros.sim.simulation import Simulation
begun = []
begin_snapshot = Simulation.begin_snapshot
Simulation.begin_snapshot = lambda self: (begun.append(self.steps), begin_snapshot(self))[1]
run_node(sys.argv, use_profile(frame_bytes(24, 24)), reclaim_dead_segments(), overlaps=True)
print('begun', len(begun))
"""


def test_a_late_node_publishes_and_records_each_frame_once(client: GraphClient, tmp_path: Path):
    """A recording of a fast run would lack frames, or could not be made again to the bit."""
    with NodeProcess(tmp_path, VALUES, '-r', '__ns:=/late', start=START) as node:
        cloth = ClothUnderTest(client, VALUES, '/late/cloth_sim')
        # It has set the pace of real time, in getting to know the node.
        assert cloth.set_parameters(real_time_factor=0.0).successful
        cloth.wait_for('stats', lambda stats: stats.steps >= 80)
        assert cloth.call(
            ApplyPush, 'apply_push', force=Vector3(y=0.2, z=0.1), duration=0.05,
            region='sphere', center=Point(z=0.9), radius=0.6).success
        assert cloth.call(SetPin, 'set_pin', row=12, col=10).success
        assert cloth.call(
            MovePin, 'move_pin', row=0, col=0, speed=0.2, target=Point(x=-0.5, y=0.5, z=1.1)
        ).success
        assert cloth.call(SetMode, 'set_mode', mode='constraint', wait=True).success
        assert cloth.set_parameters(publish__wrenches=True).successful
        cloth.client.spin_for(0.2)
        assert cloth.set_parameters(publish__wrenches=False).successful
        assert cloth.call(SetMode, 'set_mode', mode='mass_spring', wait=True).success
        assert cloth.call(SetBool, 'pause', data=True).success
        assert cloth.call(Step, 'step', steps=3).success
        assert cloth.call(SetBool, 'pause', data=False).success
        heard = {cloth.steps_of(cloud): bytes(cloud.data) for cloud in cloth['points']}
        assert cloth.call(Trigger, 'reset').success
        cloth.clear()
        cloth.wait_for('stats', lambda stats: stats.steps >= 40)
        assert cloth.call(Trigger, 'stop_recording').success
    begun = int(node.output.rsplit('begun', 1)[1])
    folder = tmp_path / 'bags' / 'late'
    recorded = Recorded(folder)
    steps = [cloth.steps_of(cloud) for cloud in recorded.messages('points')]
    assert begun > 20, 'some are in time, before it is told to be as fast as it can'
    assert steps == [cloth.steps_of(stats) for stats in recorded.messages('stats')]
    reset = steps.index(0, 1)
    for part in (steps[:reset], steps[reset:]):
        assert part == sorted(set(part)), 'each once, and in order'
    # Frames are 4 steps apart, but for those that single steps have moved.
    apart = np.diff(steps[:reset])
    assert np.all(apart[:10] == STEPS) and np.count_nonzero(apart != STEPS) <= 3, apart
    assert np.all(np.diff(steps[reset:]) == STEPS)
    points = {
        cloth.steps_of(cloud): bytes(cloud.data) for cloud in recorded.messages('points')[:reset]}
    assert heard and all(
        points[then] == data for then, data in heard.items() if then in points)
    assert len(set(heard) - set(points)) <= 2, 'shown once more while it was paused'
    frames = len(list(Recording(folder).entries('points')))
    done = cloth_sim('resimulate', str(folder))
    assert f'{frames} of {frames} frames bitwise identical' in done.stdout, (
        done.stdout + done.stderr)
