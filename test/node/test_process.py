# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""The end of the node: asked to stop, it closes its recording and leaves with exit code 0."""

from signal import SIGINT
from signal import SIGKILL
from signal import SIGTERM
import subprocess
import sys
import time

from cloth_sim_interfaces.msg import ClothStats
from cloth_sim_ros.gl.context import Context
from cloth_sim_ros.sim.device.tuning import Choice
from cloth_sim_ros.sim.scene import Scene
from cloth_sim_ros.sim.simulation import Simulation
from cloth_sim_ros.sim.snapshot import POINT_DTYPE
from cloth_under_test import SCENE
from node_process import NodeProcess
import numpy as np
import pytest
from recorded import Recorded
from tuned_device import tune_device

RECORDING = {
    **SCENE, 'recording.enabled': True, 'recording.name': 'run', 'real_time_factor': 0.0}


@pytest.mark.parametrize('signals', [
    *(pytest.param((SIGINT,) * count, marks=pytest.mark.long) for count in (1, 2, 3)),
    (SIGTERM,), (SIGTERM, SIGINT)],
    ids=lambda signals: '+'.join(number.name for number in signals))
def test_stops_cleanly_with_the_recording_closed(signals, client, tmp_path):
    """A stopped or impatiently stopped node would lose its recording, or fail."""
    namespace = f'/stopped_by_{"_".join(number.name for number in signals)}'
    with NodeProcess(tmp_path, RECORDING, '-r', f'__ns:={namespace}') as node:
        stats = client.watch(ClothStats, f'{namespace}/cloth_sim/stats')
        client.spin_until(
            lambda: stats.messages and stats.messages[-1].steps >= 100, 'the node runs')
        for number in signals:
            if node.running:
                node.send(number)
        assert node.wait() == 0, node.output
    assert 'Traceback' not in node.output
    bag = Recorded(tmp_path / 'bags' / 'run')
    clouds = bag.messages('points')
    assert len(clouds) > 100 // 4
    steps = [cloud.header.stamp.sec * 200 + cloud.header.stamp.nanosec // 5_000_000
             for cloud in clouds]
    assert steps == list(range(0, 4 * len(clouds), 4)), 'every frame, up to the last'
    simulation = Simulation(Scene(SCENE))
    simulation.step(steps[-1])
    last = np.frombuffer(clouds[-1].data, POINT_DTYPE)
    assert last.tobytes() == simulation.snapshot().records.tobytes()
    simulation.close()


# A signal after the first message of the tenth frame.
WITHIN_A_FRAME = """
from cloth_sim_ros.messages.frame_messages import FrameMessages
from cloth_sim_ros.node.main import main
import os
import rclpy
import signal
import sys
import time

frames = []

def of(messages, frame):
    frames.append(frame)
    for number, made in enumerate(works(messages, frame)):
        yield made
        if len(frames) == 10 and number == 0:
            os.kill(os.getpid(), signal.SIGINT)
            while rclpy.ok():
                time.sleep(1e-3)

works, FrameMessages.of = FrameMessages.of, of
sys.exit(main())
"""


def test_a_signal_within_a_frame_leaves_it_whole(client, tmp_path):
    """The last frame would be recorded without its cloud, or a trace be logged."""
    values = {**RECORDING, 'publish.clock': True}
    # Before the node, which may have ended by the time it is found.
    reader = client.node.create_subscription(
        ClothStats, '/within/cloth_sim/stats', lambda _: None, 10)
    with NodeProcess(tmp_path, values, '-r', '__ns:=/within', start=WITHIN_A_FRAME) as node:
        assert node.wait() == 0, node.output
    client.node.destroy_subscription(reader)
    assert 'Traceback' not in node.output and '[ERROR]' not in node.output
    bag = Recorded(tmp_path / 'bags' / 'run')
    clouds, stats = ([
        (message.header.stamp.sec, message.header.stamp.nanosec)
        for message in bag.messages(key)] for key in ('points', 'stats'))
    assert len(clouds) >= 10 and clouds == stats
    for key in ('pins/wrenches', 'pins/peak_wrenches'):
        assert len(bag.messages(key)) == 2 * len(clouds)


def test_a_tuning_that_is_none_is_warned_of(monkeypatch, tmp_path):
    """A node would not start because of a file that it can do without, or say nothing of it."""
    context = Context(single_thread=True)
    path = tune_device(
        monkeypatch, tmp_path, context.device, context.version, {16: Choice('storage', 2)})
    context.close()
    path.write_text('{')
    with NodeProcess(tmp_path, {**RECORDING, 'recording.enabled': False}) as node:
        node.wait_until_it_runs()
        node.send(SIGINT)
        assert node.wait() == 0, node.output
    warning, = (line for line in node.output.splitlines() if 'is not the tuning of' in line)
    assert warning.startswith('[WARN] ') and warning.endswith('or set CLOTH_SIM_TUNING=off')


def test_a_node_started_again_records_beside_what_is_there(tmp_path):
    """A launch that starts a killed node again would end, and no recording be made any more."""
    paths = [tmp_path / 'bags' / name for name in ('run', 'run_1', 'run_2')]
    kept = {}
    for number, path in enumerate(paths):
        with NodeProcess(tmp_path, RECORDING, '-r', '__ns:=/again') as node:
            while node.running and not list(path.glob('*.mcap')):
                time.sleep(0.01)
            node.wait_until_it_runs()
            node.send(SIGKILL)
            assert node.wait() == -SIGKILL, node.output
        told = f'{paths[0]} already exists, and no recording is overwritten: recording to {path}'
        assert (told in node.output) == (number > 0), node.output
        for file, content in kept.items():
            assert file.read_bytes() == content
        kept.update({file: file.read_bytes() for file in path.iterdir()})
    assert sorted(path.name for path in (tmp_path / 'bags').iterdir()) == ['run', 'run_1', 'run_2']


def test_an_interrupt_while_importing_is_a_clean_stop():
    """A launch that is stopped at once would report a failed node, or a traceback."""
    with subprocess.Popen(
            [sys.executable, '-X', 'importtime', '-m', 'cloth_sim_ros.node'],
            stderr=subprocess.PIPE, text=True) as node:
        # The first module behind the handler.
        seen = [next(line for line in node.stderr if 'cloth_sim_ros.files' in line)]
        node.send_signal(SIGINT)
        seen += node.stderr.readlines()
    assert node.returncode == 0, seen[-5:]
    assert not [line for line in seen if not line.startswith('import time:')]


def test_an_interrupt_while_starting_is_a_clean_stop(tmp_path):
    """A node stopped at once would fail, or not stop."""
    with NodeProcess(tmp_path, RECORDING) as node:
        while node.running and not (tmp_path / 'bags').exists():
            time.sleep(0.01)
        node.send(SIGINT)
        assert node.wait() == 0, node.output
    assert 'Traceback' not in node.output
