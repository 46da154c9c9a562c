# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""SIGKILL at any moment: what was recorded before stays, and the next start is as the first."""

from pathlib import Path
import random
import signal
import time

from cloth_sim_interfaces.msg import ClothStats
from cloth_sim_interfaces.srv import SetMode
from cloth_sim_ros.recording.bag_reader import BagReader
from cloth_sim_ros.recording.recovery import Recovery
from cloth_sim_ros.sim.errors import ClothSimError
from graph_client import GraphClient
from node_process import NodeProcess
import pytest
from rosbags.highlevel import AnyReader
from shared_memory import shared_memory_files
from std_srvs.srv import Trigger
from writers_clock import WritersClock

MOST_LOST = 1.0  # [s], while neither the disk nor the machine stands still
NODE = '/kills/cloth_sim'
PARAMETERS = {
    'rows': 16, 'cols': 16, 'recording.enabled': True, 'recording.max_bagfile_duration': 1.0}
MOMENTS = ('start', 'flush', 'stop', 'switch')


class Kills:
    """Starts a node again and again with the same parameters, and kills it."""

    def __init__(self, folder: Path, client: GraphClient, seed: int) -> None:
        """Listen to whoever is the node."""
        self._folder = folder
        self._client = client
        self._generator = random.Random(seed)
        self._heard: list[tuple[float, int]] = []
        self._started = 0
        client.node.create_subscription(ClothStats, f'{NODE}/stats', self._hear, 1000)

    def _hear(self, stats: ClothStats, info: dict) -> None:
        # A busy client may get the last words of the node before while this one starts.
        sent = info['source_timestamp']
        if sent >= self._started:
            self._heard.append((sent * 1e-9, stats.steps))

    def _forget(self) -> None:
        self._started = time.time_ns()
        self._heard.clear()

    def kill(self, moment: str) -> None:
        """Start the node, kill it around ``moment``, and check its recording."""
        before = self.recordings()
        self._forget()
        with WritersClock(self._folder) as clock, NodeProcess(
                self._folder, PARAMETERS, '-r', '__ns:=/kills') as node:
            getattr(self, f'_{moment}')()
            written = clock.before(MOST_LOST)
            killed = time.time()
            node.send(signal.SIGKILL)
            node.wait()
        self._client.spin_for(0.2)  # receive the messages of its end
        fresh = sorted(self.recordings() - before)
        assert len(fresh) <= 1
        safe = [steps for at, steps in self._heard if at < written]
        assert fresh or not safe
        if fresh:
            check_recording(
                fresh[0], max(safe, default=-1),
                f'killed at {moment}, {killed - written:.3f} s before')

    def end_in_peace(self) -> None:
        """Start the node, and let it complete its recording."""
        before = self.recordings()
        self._forget()
        with NodeProcess(self._folder, PARAMETERS, '-r', '__ns:=/kills') as node:
            self._flush()
            node.send(signal.SIGINT)
            assert node.wait() == 0, node.output
        path, = self.recordings() - before
        with AnyReader([path]) as bag:
            assert bag.message_count > len(self._heard)
        assert BagReader(path).problems == []

    def recordings(self) -> set[Path]:
        """Return the folders of all recordings."""
        bags = self._folder / 'bags'
        return set(bags.iterdir()) if bags.exists() else set()

    def _start(self) -> None:
        self._client.spin_for(self._generator.uniform(0.0, 3.0))

    def _flush(self) -> None:
        self._client.spin_until(lambda: self._heard, 'the node runs')
        self._client.spin_for(self._generator.uniform(0.5, 2.5))

    def _stop(self) -> None:
        self._flush()
        self._client.service(Trigger, f'{NODE}/stop_recording').call_async(Trigger.Request())
        self._client.spin_for(self._generator.uniform(0.0, 0.1))

    def _switch(self) -> None:
        self._flush()
        self._client.service(SetMode, f'{NODE}/set_mode').call_async(
            SetMode.Request(mode='adaptive'))
        self._client.spin_for(self._generator.uniform(0.0, 0.5))


def check_recording(path: Path, safe: int, story: str) -> None:
    """Read what a killed node has recorded; ``safe`` steps must be in it."""
    try:
        reader = BagReader(path)
        found = [
            reader.decode(raw).steps for raw in reader.messages([f'{NODE}/stats'])]
        check_recovery(path, sum(1 for _ in reader.messages()))
    except ClothSimError as error:
        assert 'killed before the first flush' in str(error)
        found = []
    assert found == sorted(found)
    assert max(found, default=-1) >= safe, (
        f'{story}, step {safe} was sent, and the last in {path} is {max(found, default=-1)}')


def check_recovery(path: Path, number: int) -> None:
    """Have rosbags read all of the ``number`` messages of the recording, made whole if need be."""
    recovery = Recovery(path)
    if recovery.problems:
        path = path.parents[1] / f'{path.name}_recovered'
        recovery.write(path, '--out')
    with AnyReader([path]) as bag:
        assert sum(1 for _ in bag.messages()) == number


def attack(folder: Path, client: GraphClient, seed: int, number: int) -> None:
    """Kill ``number`` nodes, each moment as often as the others; then let one end in peace."""
    kills = Kills(folder, client, seed)
    for count in range(number):
        kills.kill(MOMENTS[count % len(MOMENTS)])
    kills.end_in_peace()


def test_a_killed_node_loses_less_than_a_second(tmp_path, client, usual_seed):
    """A crash would take a recording, or the next start fail for what the last one left."""
    attack(tmp_path, client, usual_seed, 4)


@pytest.mark.long
def test_a_hundred_killed_nodes(tmp_path, client, seed):
    """A moment that is rarely met would lose a recording, or fill the shared memory."""
    attack(tmp_path / 'first', client, seed, 20)
    files = shared_memory_files()
    attack(tmp_path / 'others', client, seed + 1, 80)
    print(f'{files} files in shared memory after 20 kills, {shared_memory_files()} after 100')


@pytest.mark.parametrize('kills', [3, pytest.param(30, marks=pytest.mark.long)])
def test_a_fixed_name_survives_kills(kills, tmp_path, seed):
    """A node that is started again with a name that is taken would end, or overwrite it."""
    drawn = random.Random(seed)
    parameters = {**PARAMETERS, 'recording.name': 'fixed'}
    bags, kept = tmp_path / 'bags', {}
    for number in range(kills):
        folder = bags / (f'fixed_{number}' if number else 'fixed')
        with NodeProcess(tmp_path, parameters, '-r', '__ns:=/fixed') as node:
            while not list(folder.glob('*.mcap')):
                assert node.running, node.output
                time.sleep(0.01)
            time.sleep(drawn.uniform(0.0, 1.5))
            node.send(signal.SIGKILL)
            assert node.wait() == -signal.SIGKILL, node.output
        kept.update({file: file.read_bytes() for file in folder.iterdir()})
        assert all(file.read_bytes() == content for file, content in kept.items())
    assert len(list(bags.iterdir())) == kills
