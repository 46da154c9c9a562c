# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

r"""
Measure the service response times of a running node, and the gaps between its frames.

First, with an empty shader cache: the largest gap between frames and between responses during the
first switch of a node to each of the other modes, repeated for a node of another size. Then, in
each mode: the response times of services during simulation. Each figure is given as wall time and
as CPU time of the node; on a busy machine the latter is more meaningful.

For example:
  cloth_sim study answers
  cloth_sim study answers --sizes 64 --calls 50 --no-switches
"""

from argparse import ArgumentParser
from argparse import BooleanOptionalAction
from argparse import Namespace
from collections.abc import Callable
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass
import json
import os
from pathlib import Path
import signal
import subprocess
import sys
import tempfile
import time
from typing import Any

from cloth_sim_ros.files.errors import MOST_SHOWN
from cloth_sim_ros.files.errors import shown
from cloth_sim_ros.sim.errors import ClothSimError
from cloth_sim_ros.sim.model.scene_fields import MODES
import numpy as np

_PATIENCE = 300.0
_RATE = 50.0
_GET_EVERY = 0.05


def add_arguments(parser: ArgumentParser) -> None:
    """Add the arguments of this study."""
    parser.add_argument('--sizes', type=int, nargs='+', default=[64], metavar='N',
                        help='nodes along each side, for response times (default: %(default)s)')
    parser.add_argument('--calls', type=int, default=200, metavar='N',
                        help='number of calls per service and mode (default: %(default)s)')
    parser.add_argument('--switches', action=BooleanOptionalAction, default=True,
                        help='measure first mode switches, with an empty shader cache')
    parser.add_argument('--modes', nargs='+', default=list(MODES), choices=MODES,
                        help='modes in which to measure response times (default: all)')
    parser.add_argument('--json', action='store_true', help='print one line of JSON per figure')


def main(args: Namespace) -> int:
    """Measure and print."""
    show = _as_json if args.json else _as_text
    if args.switches:
        for title, figures in measure_switches():
            show(title, figures)
    for size in args.sizes:
        for mode in args.modes:
            title, figures = measure_services(mode, size, args.calls)
            show(title, figures)
    return 0


@dataclass(frozen=True)
class Times:
    """
    Durations of one kind.

    :param wall: [s]
    :param processor: of all threads of the node, within these [s]
    """

    wall: list[float]
    processor: list[float]

    def as_dict(self) -> dict[str, float]:
        """Return count, median, 95th percentile and largest."""
        return {'count': len(self.wall), **{
            f'{kind}_{name}': float(np.percentile(values, percent))
            for kind, values in (('wall', self.wall), ('processor', self.processor))
            for name, percent in (('p50', 50), ('p95', 95), ('max', 100))}}


class RunningNode:
    """
    A node in a process of its own, and a place in the graph to call it from.

    :param values: parameters by name
    :param environment: added to this process's own
    """

    def __init__(self, values: dict[str, Any], environment: dict[str, str]) -> None:
        """Start the node, and wait until it shows frames."""
        # ROS is needed for this study alone.
        from cloth_sim_interfaces.msg import ClothStats
        import rclpy
        self._rclpy = rclpy
        rclpy.init()
        self.frames: list[tuple[float, float]] = []
        self.node = rclpy.create_node('cloth_sim_answers')
        name = f'cloth_sim_answers_{os.getpid()}'
        self._target = f'/{name}'
        self._log = tempfile.TemporaryFile('w+')
        self.process = subprocess.Popen(
            [sys.executable, '-m', 'cloth_sim_ros.node', '--ros-args', '-r', f'__node:={name}',
             *(part for key, value in values.items()
               for part in ('-p', f'{key}:={json.dumps(value)}'))],
            stdout=self._log, stderr=self._log, env={**os.environ, **environment})
        self.node.create_subscription(
            ClothStats, f'{self._target}/stats',
            lambda _: self.frames.append((time.monotonic(), self.processor_time())), 1000)
        self.spin_until(lambda: len(self.frames) > 5)

    def processor_time(self) -> float:
        """Return what all threads of the node have had [s]."""
        total = 0
        for path in Path(f'/proc/{self.process.pid}/task').glob('*/schedstat'):
            try:
                total += int(path.read_text().split()[0])
            # A thread can end meanwhile.
            except OSError:
                continue
        return total * 1e-9

    def spin_until(self, condition: Callable[[], Any]) -> None:
        """Take in messages until ``condition`` holds; ClothSimError when it does not for long."""
        deadline = time.monotonic() + _PATIENCE
        while not condition():
            self._rclpy.spin_once(self.node, timeout_sec=0.02)
            if time.monotonic() > deadline or self.process.poll() is not None:
                self._log.seek(0)
                raise ClothSimError(
                    f'the node did not do what was waited for within {_PATIENCE:g} s: it said '
                    f'{shown(self._log.read().strip()[-MOST_SHOWN:])}')

    def call(self, kind: Any, service: str, **fields: Any) -> Any:
        """Send a request and return its future."""
        client = self._client(kind, service)
        return client.call_async(kind.Request(**fields))

    def timed_call(self, times: Times, kind: Any, service: str, **fields: Any) -> None:
        """Call, wait for the answer, and add how long that took to ``times``."""
        self._client(kind, service)
        begin, before = time.monotonic(), self.processor_time()
        future = self.call(kind, service, **fields)
        self.spin_until(future.done)
        times.wall.append(time.monotonic() - begin)
        times.processor.append(self.processor_time() - before)
        if not getattr(future.result(), 'success', True):
            raise ClothSimError(f'{service} was refused: {future.result().message}')

    def close(self) -> None:
        """End node and listener."""
        self.process.send_signal(signal.SIGINT)
        self.process.wait()
        self.node.destroy_node()
        self._rclpy.try_shutdown()

    def _client(self, kind: type, service: str) -> Any:
        name = f'{self._target}/{service}'
        for client in self.node.clients:
            if client.srv_name == name:
                return client
        client = self.node.create_client(kind, name)
        self.spin_until(client.service_is_ready)
        return client


@contextmanager
def running_node(values: dict[str, Any], environment: dict[str, str]) -> Iterator[RunningNode]:
    """Lend a node that is stopped at the end."""
    node = RunningNode({'publish.rate': _RATE, **values}, environment)
    try:
        yield node
    finally:
        node.close()


def measure_switches() -> Iterator[tuple[str, dict[str, Times]]]:
    """Yield what first switches cost with an empty shader cache, then with that of other sizes."""
    with tempfile.TemporaryDirectory() as cache:
        environment = {
            'XDG_CACHE_HOME': cache, 'MESA_SHADER_CACHE_DIR': cache, 'HOME': cache}
        for title, size in (('empty shader cache', (48, 48)), ('second grid size', (40, 56))):
            values = {'rows': size[0], 'cols': size[1]}
            with running_node(values, environment) as node:
                for mode in ('constraint', 'adaptive'):
                    yield (f'{title}, {size[0]} x {size[1]}, first switch to {mode}',
                           _measure_switch(node, mode))


def _measure_switch(node: RunningNode, mode: str) -> dict[str, Times]:
    from cloth_sim_interfaces.srv import SetMode
    from rcl_interfaces.srv import GetParameters
    answers = Times([], [])
    # Springs make frames without a gap of their own.
    node.timed_call(answers, SetMode, 'set_mode', mode='mass_spring')
    node.timed_call(answers, GetParameters, 'get_parameters', names=['dt'])
    node.frames.clear()
    node.spin_until(lambda: len(node.frames) > 10)
    answers.wall.clear()
    answers.processor.clear()
    begin = time.monotonic()
    done = node.call(SetMode, 'set_mode', mode=mode)
    while not done.done():
        node.timed_call(answers, GetParameters, 'get_parameters', names=['dt'])
        rest = time.monotonic() + _GET_EVERY
        node.spin_until(lambda: time.monotonic() > rest)
    took = time.monotonic() - begin
    count = len(node.frames)
    node.spin_until(lambda: len(node.frames) > count + 1)
    arrivals = np.diff(np.array(node.frames), axis=0)
    return {
        'switch': Times([took], [took]), 'get_parameters': answers,
        'gap between frames': Times(arrivals[:, 0].tolist(), arrivals[:, 1].tolist())}


def measure_services(mode: str, size: int, calls: int) -> tuple[str, dict[str, Times]]:
    """Return how long services take in ``mode`` while a cloth of ``size`` squared is advanced."""
    from cloth_sim_interfaces.srv import ApplyPush
    from cloth_sim_interfaces.srv import SetPin
    from geometry_msgs.msg import Vector3
    from rcl_interfaces.srv import GetParameters
    from std_srvs.srv import SetBool
    requests: dict[str, tuple[Any, Callable[[int], dict[str, Any]]]] = {
        'apply_push': (ApplyPush, lambda number: {
            'force': Vector3(z=1e-3), 'region': 'sphere', 'radius': 2.0, 'duration': 1e-3}),
        'set_pin': (SetPin, lambda number: {
            'row': 1 + number // 2 % (size - 2), 'col': size // 2, 'release': number % 2 == 1}),
        'pause': (SetBool, lambda number: {'data': number % 2 == 0}),
        'get_parameters': (GetParameters, lambda number: {'names': ['dt', 'mode']}),
    }
    times = {name: Times([], []) for name in requests}
    with running_node({'rows': size, 'cols': size, 'mode': mode}, {}) as node:
        for number in range(calls):
            for name, (kind, fields) in requests.items():
                node.timed_call(times[name], kind, name, **fields(number))
            # While it is paused for a call, nothing is advanced.
            node.timed_call(Times([], []), SetBool, 'pause', data=False)
        arrivals = np.diff(np.array(node.frames), axis=0)
        times['gap between frames'] = Times(arrivals[:, 0].tolist(), arrivals[:, 1].tolist())
    return f'mode {mode}, {size} x {size}, while it runs', times


def _as_json(title: str, figures: dict[str, Times]) -> None:
    print(json.dumps({'title': title, **{
        name: times.as_dict() for name, times in figures.items()}}), flush=True)


def _as_text(title: str, figures: dict[str, Times]) -> None:
    print(f'{title}\n  {"ms":20} {"n":>6} {"median":>9} {"95 %":>9} {"largest":>9}'
          f' {"of the processor: 95 %":>24} {"largest":>9}')
    for name, times in figures.items():
        row = times.as_dict()
        cells = [1e3 * row[key] for key in (
            'wall_p50', 'wall_p95', 'wall_max', 'processor_p95', 'processor_max')]
        print(f'  {name:20} {row["count"]:6} {cells[0]:9.1f} {cells[1]:9.1f} {cells[2]:9.1f}'
              f' {cells[3]:24.1f} {cells[4]:9.1f}', flush=True)
