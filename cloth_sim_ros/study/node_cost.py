# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""What a node costs beyond its simulation: CPU time as topics and the recording are added."""

from collections.abc import Iterator
from collections.abc import Mapping
from collections.abc import Sequence
from concurrent.futures import ProcessPoolExecutor
from contextlib import contextmanager
from dataclasses import asdict
from dataclasses import dataclass
from dataclasses import field
import json
import multiprocessing
import os
from pathlib import Path
import statistics
import subprocess
import sys
import tempfile
import time
from typing import Any

from cloth_sim_ros.files.errors import MOST_SHOWN
from cloth_sim_ros.files.errors import shown
from cloth_sim_ros.sim.errors import ClothSimError
from cloth_sim_ros.sim.scene import Scene
from cloth_sim_ros.sim.simulation import Simulation

RATE = 50.0
_TARGET = 'cloth_sim_node_cost'
# Line that the listener prints after the first message on every topic.
READY = 'ready'
_PATIENCE = 300.0
# Max. time in which the node has to send two clouds [s].
_LONGEST = 60.0
# Discovery and the first messages are not measured [s].
_SETTLE = 1.0
_WARM_UP_FRAMES = 10
_REFERENCE_SIZE = 32
# On that grid [N/m, N s/m].
_SPRINGS = {
    'stiffness.structural': 1000.0, 'stiffness.shear': 200.0, 'stiffness.bend': 10.0,
    'damping.structural': 0.04, 'damping.shear': 0.04, 'damping.bend': 0.01}
_ALL = 'recording'
# Topics subscribed to as each part is added.
_ADDED: dict[str, tuple[str, ...]] = {
    'node': (), 'points': ('points',), 'markers': ('markers',),
    'wrenches': ('pins/wrenches', 'tf'), 'stats': ('stats', 'diagnostics'), _ALL: ()}
PARTS = tuple(_ADDED)


@dataclass
class PartCost:
    """
    What a node has cost with one more part.

    :param part: the last of the parts that are on
    :param processor: CPU time of all threads of the node, per simulated second, in each round
    :param over_bare: the same over that of the simulation alone, round by round
    :param pace: simulated time per wall time, in each round
    :param sent: clouds that the node has made meanwhile, in all rounds
    :param lost: those of them that have not reached the subscriber
    """

    part: str
    processor: list[float] = field(default_factory=list)
    over_bare: list[float] = field(default_factory=list)
    pace: list[float] = field(default_factory=list)
    sent: int = 0
    lost: int = 0


@dataclass
class NodeCost:
    """
    The costs of a node on one grid.

    :param checkout: where its code lies; empty for that of this process
    :param bare: CPU time of the simulation alone per simulated second, around each round
    :param parts: in the order in which they are added
    """

    rows: int
    cols: int
    checkout: str = ''
    device: str = ''
    substeps: int = 0
    bare: list[float] = field(default_factory=list)
    parts: list[PartCost] = field(default_factory=lambda: [PartCost(part) for part in PARTS])

    def as_dict(self) -> dict[str, Any]:
        """Return all numbers."""
        return asdict(self)

    def in_words(self) -> str:
        """Return a table: CPU time, over the bare simulation, what each part adds, and clouds."""
        bare = statistics.median(self.bare)
        lines = [
            f'{self.rows} x {self.cols}, {self.substeps} substeps a dt, on {self.device}'
            + (f', of {self.checkout}' if self.checkout else ''),
            f'  simulation alone {bare:8.4f} CPU s per simulated s']
        before = bare
        for cost in self.parts:
            now = statistics.median(cost.processor)
            name = cost.part if cost.part == PARTS[0] else f'+ {cost.part}'
            lines.append(
                f'  {name:16} {now:8.4f}, {statistics.median(cost.over_bare):5.2f} x '
                f'({min(cost.over_bare):.2f} to {max(cost.over_bare):.2f}), '
                f'{1e3 * (now - before) / RATE:+6.2f} ms a frame, '
                f'{statistics.median(cost.pace):4.2f} x real time'
                + (f', {cost.lost} of {cost.sent} clouds lost' if cost.sent else ''))
            before = now
        return '\n'.join(lines)


def scene_values(size: int, changes: Mapping[str, Any]) -> dict[str, Any]:
    """
    Return a scene of ``size`` x ``size`` nodes: springs and pins of config/studies/two_corners.

    Finer than 32 x 32, stiffness and damping are proportional to N^-3. Then substeps decrease
    with N^-1/2, and a fine cloth can keep up with real time on a CPU.

    :param changes: parameters that replace them; with material.*, no springs are set
    """
    softer = min(_REFERENCE_SIZE / size, 1.0) ** 3
    springs = {} if any(name.startswith('material.') for name in changes) else {
        name: softer * value for name, value in _SPRINGS.items()}
    return {
        'rows': size, 'cols': size, 'areal_density': 0.2, 'dt': 0.005, **springs, **changes}


def measure_node(
        sizes: Sequence[int], changes: Mapping[str, Any], *, seconds: float, rounds: int,
        checkouts: Sequence[str] = ('',)) -> Iterator[NodeCost]:
    """
    Yield the cost of a node on each grid, part by part; the checkouts take turns.

    :param changes: scene parameters by name
    :param seconds: wall time of each measurement [s]
    :param checkouts: folders of the code of the nodes; an empty one is that of this process
    :raises ClothSimError: when a node or its subscriber fails
    """
    for size in sizes:
        values = scene_values(size, changes)
        costs = [NodeCost(size, size, checkout) for checkout in checkouts]
        for _ in range(rounds):
            for cost in costs:
                _measure_round(cost, values, seconds)
        yield from costs


def _measure_round(cost: NodeCost, values: Mapping[str, Any], seconds: float) -> None:
    first = _measure_bare(cost, values, seconds)
    with tempfile.TemporaryDirectory() as folder:
        with _running_node(values, cost.checkout, folder) as process:
            keys: tuple[str, ...] = ()
            for part in cost.parts:
                keys += _ADDED[part.part]
                _measure_part(part, keys, process, cost.checkout, seconds)
    # On both sides of the node, as the clock rate and other load change.
    bare = 0.5 * (first + _measure_bare(cost, values, seconds))
    cost.bare.append(bare)
    for part in cost.parts:
        part.over_bare.append(part.processor[-1] / bare)


def _measure_bare(cost: NodeCost, values: Mapping[str, Any], seconds: float) -> float:
    # A process of its own, as a GL context takes its number of threads once.
    with ProcessPoolExecutor(1, multiprocessing.get_context('spawn')) as executor:
        bare, cost.device, cost.substeps = executor.submit(
            bare_cost, dict(values), seconds).result()
    return bare


def bare_cost(values: Mapping[str, Any], seconds: float) -> tuple[float, str, int]:
    """
    Return the CPU time per simulated second of the simulation alone, device and substeps.

    It makes the frames of the node at the same pace: a process that sleeps in between finds the
    caches cold, and takes longer for the same work than one that does not.

    :param seconds: simulated time [s]
    """
    with Simulation(Scene(dict(values))) as simulation:
        for _ in range(_WARM_UP_FRAMES):
            simulation.advance(1.0 / RATE)
        simulation.finish()
        begin, before, due = time.process_time(), simulation.time, time.monotonic()
        for _ in range(max(round(seconds * RATE), 1)):
            simulation.advance(1.0 / RATE)
            due += 1.0 / RATE
            time.sleep(max(due - time.monotonic(), 0.0))
        simulation.finish()
        spent = (time.process_time() - begin) / (simulation.time - before)
        return spent, simulation.device, simulation.substeps


def interpreter(checkout: str) -> str:
    """Return the Python of ``checkout``: its own where it is set up, or that of this process."""
    own = Path(checkout, '.venv', 'bin', 'python')
    return str(own) if checkout and own.exists() else sys.executable


def environment(checkout: str) -> dict[str, str]:
    """Return the environment in which the Python of ``checkout`` finds its own messages."""
    own = Path(checkout, '.venv')
    if not (checkout and own.exists()):
        return dict(os.environ)
    return {**os.environ, **{
        name: os.pathsep.join(filter(None, (str(own), os.environ.get(name))))
        for name in ('AMENT_PREFIX_PATH', 'CMAKE_PREFIX_PATH')}}


@contextmanager
def _running_node(
        values: Mapping[str, Any], checkout: str,
        folder: str) -> Iterator[subprocess.Popen[str]]:
    """Run a node, which records into ``folder``."""
    given = {**values, 'publish.rate': RATE, 'recording.directory': folder}
    log = tempfile.TemporaryFile('w+')
    process = subprocess.Popen(
        [interpreter(checkout), '-m', 'cloth_sim_ros.node', '--ros-args',
         '-r', f'__node:={_TARGET}',
         *(part for name, value in given.items()
           for part in ('-p', f'{name}:={json.dumps(value)}'))],
        # Python looks for modules to run in the working directory first.
        stdout=log, stderr=log, text=True, cwd=checkout or None, env=environment(checkout))
    try:
        yield process
    except ClothSimError as error:
        log.seek(0)
        raise ClothSimError(
            f'{error}; it said {shown(log.read().strip()[-MOST_SHOWN:])}') from error
    finally:
        process.terminate()
        process.wait()


@contextmanager
def _listening(
        keys: Sequence[str], node: subprocess.Popen[str], checkout: str, *,
        record: bool = False) -> Iterator[dict[str, Any]]:
    """Subscribe to ``keys`` for the time of the block; what came is in the dict after it."""
    listener = subprocess.Popen(
        [interpreter(checkout), '-m', 'cloth_sim_ros.study.topic_listener', _TARGET, *keys,
         *(['--record'] if record else [])],
        stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True, cwd=checkout or None,
        env=environment(checkout))
    assert listener.stdin is not None and listener.stdout is not None
    found: dict[str, Any] = {}
    try:
        os.set_blocking(listener.stdout.fileno(), False)
        end, line = time.monotonic() + _PATIENCE, ''
        # The middleware may print there, too.
        while line.strip() != READY:
            if time.monotonic() > end or node.poll() is not None or listener.poll() is not None:
                raise ClothSimError(
                    f'no message of {", ".join(keys)} came from the node within {_PATIENCE:g} s')
            time.sleep(_SETTLE / 20.0)
            line = listener.stdout.readline()
        os.set_blocking(listener.stdout.fileno(), True)
        yield found
        listener.stdin.close()
        found.update(json.loads(listener.stdout.read().splitlines()[-1]))
    finally:
        listener.terminate()
        listener.wait()


def _measure_part(
        part: PartCost, keys: Sequence[str], node: subprocess.Popen[str], checkout: str,
        seconds: float) -> None:
    if keys:
        while True:
            with _listening(keys, node, checkout, record=part.part == _ALL) as found:
                begin, end, spent = _spend(node, seconds)
            frames = [
                frame for frame in found['arrivals']['points'] if begin <= frame[0] <= end]
            if len(frames) >= 2:
                break
            if seconds > _LONGEST:
                raise ClothSimError(f'the node has sent {len(frames)} clouds in {seconds:g} s')
            # A machine that is busy besides has let it run for less.
            seconds *= 2.0
        first, last = frames[0], frames[-1]
        sent = round((last[1] - first[1]) * RATE) + 1
        part.sent += sent
        part.lost += sent - len({stamp for _, stamp in frames})
    else:
        # Subscriptions before and after the measurement give the pace.
        with _listening(['stats'], node, checkout) as found:
            pass
        first = found['arrivals']['stats'][-1]
        begin, end, spent = _spend(node, seconds)
        with _listening(['stats'], node, checkout) as found:
            pass
        last = found['arrivals']['stats'][0]
    pace = (last[1] - first[1]) / (last[0] - first[0])
    part.pace.append(pace)
    part.processor.append(spent / ((end - begin) * pace))


def _spend(node: subprocess.Popen[str], seconds: float) -> tuple[float, float, float]:
    """Let the node run, and return the times of begin and end, and the CPU time between [s]."""
    time.sleep(_SETTLE)
    begin, before = time.monotonic(), processor_time(node.pid)
    time.sleep(seconds)
    return begin, time.monotonic(), processor_time(node.pid) - before


def processor_time(process: int) -> float:
    """Return the CPU time of all threads of ``process``, in user and system mode [s]."""
    # Behind the name, which can have spaces: utime and stime are fields 14 and 15, proc(5).
    fields = Path(f'/proc/{process}/stat').read_text(encoding='ascii').rpartition(')')[2].split()
    return (int(fields[11]) + int(fields[12])) / os.sysconf('SC_CLK_TCK')
