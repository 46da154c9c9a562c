# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""Readers come and go, crash, or never read: the node serves all others as ever."""

from contextlib import contextmanager
from contextlib import ExitStack
from pathlib import Path
import random
import signal
import subprocess
import sys

from cloth_sim_interfaces.msg import ClothStats
from cloth_sim_interfaces.srv import SetMode
from cloth_sim_ros.node.shared_memory import VARIABLE
from graph_client import GraphClient
from node_process import NodeProcess
import pytest
from sensor_msgs.msg import PointCloud2
from std_srvs.srv import Trigger

PROGRAM = Path(__file__).parent / 'programs' / 'readers.py'
PATIENCE = 300.0
# A reader that runs late by a second still gets all: the node keeps 10 frames for it.
SCENE = {'rows': 64, 'cols': 64, 'dt': 0.005, 'publish.rate': 10.0}
FEWEST_FRAMES = 10


@contextmanager
def readers(target, *arguments):
    """Run readers in a process of their own, and kill it in the end if it has not ended."""
    process = subprocess.Popen(
        [sys.executable, str(PROGRAM), target, *map(str, arguments)], stdout=subprocess.PIPE)
    try:
        yield process
    finally:
        process.kill()
        process.wait(PATIENCE)


def frames(watch):
    """Return the simulated times of the messages of a topic, in frames."""
    stamps = [message.header.stamp for message in watch.messages]
    return [round((stamp.sec + 1e-9 * stamp.nanosec) * SCENE['publish.rate']) for stamp in stamps]


def assert_none_is_missing(watch, what):
    """Fail when a frame was lost or came twice."""
    got = frames(watch)
    assert len(got) > FEWEST_FRAMES, what
    missing = sorted(set(range(got[0], got[-1] + 1)) - set(got))
    assert got == list(range(got[0], got[-1] + 1)), f'{what}: {missing} are missing'


@pytest.mark.parametrize('processes, each', [
    (2, 4), pytest.param(5, 10, marks=pytest.mark.long)])
def test_no_reader_harms_another(processes, each, tmp_path, monkeypatch):
    """A viewer that hangs or crashes would cost a recorder its frames, or the node its answers."""
    monkeypatch.delenv(VARIABLE, raising=False)
    seed = random.randrange(10**6)
    print(f'seed {seed}')
    target = '/read/cloth_sim'
    with GraphClient() as client, NodeProcess(tmp_path, SCENE, '-r', '__ns:=/read') as node:
        stats = client.watch(ClothStats, f'{target}/stats')
        clouds = client.watch(PointCloud2, f'{target}/points')
        client.spin_until(lambda: stats.messages and clouds.messages, 'the first frame')
        # Found before the load: how long discovery takes is not what is asked.
        client.service(SetMode, f'{target}/set_mode')
        assert client.call_until_answered(Trigger, f'{target}/clear_pushes').success
        answers = 0
        with readers(target, 'never') as mute:
            assert b'has joined' in mute.stdout.readline()
            client.spin_until(
                lambda: client.node.count_subscribers(f'{target}/points') > 1, 'it is there')
            mute.send_signal(signal.SIGSTOP)
            with ExitStack() as stack:
                running = [
                    stack.enter_context(readers(target, each, seed + number))
                    for number in range(processes)]
                while any(process.poll() is None for process in running) or answers <= 10:
                    assert client.call(Trigger, f'{target}/clear_pushes').success
                    refused = client.call(SetMode, f'{target}/set_mode', mode='silk')
                    assert 'mode must be one of' in refused.message and not refused.success
                    answers += 2
                assert [process.returncode for process in running] == [0] * processes
            client.spin_until(
                lambda: min(len(frames(stats)), len(frames(clouds))) > FEWEST_FRAMES,
                'enough frames to miss one')
            client.spin_for(1.0)
        assert node.running, node.output
        for watch, what in ((stats, 'stats'), (clouds, 'clouds')):
            assert_none_is_missing(watch, f'{what} with seed {seed}')
