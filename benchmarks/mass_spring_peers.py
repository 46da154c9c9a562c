# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""
The cloth of springs of `cloth_sim bench`, here and in other simulators, on one core.

All step the same cloth: springs to 12 neighbours with damping, gravity, two pins, symplectic
Euler. First all make 100 steps of a small cloth: who is farther than 5e-5 m from the float64
reference is named and not timed. Then they take turns, several rounds at each size.

The peers are in benchmarks/peers. Those that are not installed are left out and named:
python -m pip install numba warp-lang taichi, and gcc for those in C.

For example:
  python benchmarks/mass_spring_peers.py
  python benchmarks/mass_spring_peers.py --sizes 128 1024 --rounds 9 --only fused 'C, once' Warp
  python benchmarks/mass_spring_peers.py --json
"""

from argparse import ArgumentParser
from argparse import Namespace
from collections.abc import Callable
from collections.abc import Iterator
from collections.abc import Mapping
from collections.abc import Sequence
from contextlib import closing
from contextlib import redirect_stdout
from dataclasses import asdict
from dataclasses import dataclass
from functools import partial
from importlib import import_module
from importlib.metadata import PackageNotFoundError
from importlib.metadata import version
import json
import os
from pathlib import Path
import platform
import statistics
import subprocess
import sys
import time
from typing import Any

from cloth_sim_ros.gl.context import Context
from cloth_sim_ros.recording.bag_metadata import project_version
from cloth_sim_ros.reference.explicit_cloth import MassSpringReference
from cloth_sim_ros.study.speed import bench_scene
from cloth_sim_ros.study.speed_page import processor_name
import numpy as np
from peers.c_peer import compiler
from peers.cloth import Cloth
from peers.cloth import cloth_of
from peers.cloth import Peer
from peers.cloth import PeerMissingError
from peers.simulation_peer import SimulatedCloth

Factory = Callable[[Cloth], Peer]

# What is compared with the others.
FUSED = 'fused'
# Modules are imported when their peer is asked for: not all are installed everywhere.
MODULES = {
    'C, once': 'c_peer:OnceCloth',
    'C, gather': 'c_peer:GatherCloth',
    'numba': 'numba_peer:NumbaCloth',
    'NumPy': 'numpy_peer:NumpyCloth',
    'Warp': 'warp_peer:WarpCloth',
    'Taichi': 'taichi_peer:TaichiCloth',
}
NAMES = (FUSED, 'paper', *MODULES)
STEPS_TO_AGREE = 100
TOLERANCE = 5e-5
# No multiple of the width of a vector: the ends of rows count too.
NODES_TO_AGREE = 37
_PACKAGES = ('numpy', 'PyOpenGL', 'numba', 'warp-lang', 'taichi')
# They are read when the libraries are loaded.
ONE_THREAD = {
    'LP_NUM_THREADS': '0', 'NUMBA_NUM_THREADS': '1', 'OMP_NUM_THREADS': '1',
    'ENABLE_TAICHI_HEADER_PRINT': '0'}


@dataclass(frozen=True)
class PeerSpeed:
    """
    Node steps a second of one peer at one size.

    :param median: over the rounds, by wall time
    :param ratio: of the fused simulation over this peer, the median of those round by round
    :param processor_ratio: the same by processor time, which depends less on other load
    """

    peer: str
    median: float
    rounds: tuple[float, ...]
    ratio: float
    ratio_rounds: tuple[float, ...]
    processor_ratio: float


@dataclass(frozen=True)
class SizeSpeeds:
    """All peers at one size."""

    nodes: int
    dt: float
    speeds: tuple[PeerSpeed, ...]


def factories(names: Sequence[str], context: Context) -> tuple[dict[str, Factory], dict[str, str]]:
    """Return what makes a cloth of each peer, and for those that are not here why."""
    found: dict[str, Factory] = {}
    left_out = {}
    for name in names:
        if name not in MODULES:
            found[name] = partial(SimulatedCloth, layout=name, context=context)
            continue
        module, kind = MODULES[name].split(':')
        try:
            found[name] = getattr(import_module(f'peers.{module}'), kind)
            if module == 'c_peer':
                compiler()
        except (ImportError, PeerMissingError) as error:
            found.pop(name, None)
            left_out[name] = str(error)
    return found, left_out


def deviations(made: Mapping[str, Factory], nodes: int = NODES_TO_AGREE) -> dict[str, float]:
    """Return how far each is from the float64 reference after 100 steps, at most [m]."""
    scene = bench_scene(nodes, {})
    reference = MassSpringReference(scene)
    reference.step(STEPS_TO_AGREE)
    far = {}
    for name, factory in made.items():
        peer = factory(cloth_of(scene))
        peer.step(STEPS_TO_AGREE)
        errors = np.linalg.norm(peer.positions() - reference.positions, axis=-1)
        far[name] = float(np.nan_to_num(errors, nan=np.inf).max())
        _close(peer)
    return far


def compare(
        made: Mapping[str, Factory], sizes: Sequence[int], rounds: int,
        round_seconds: float) -> Iterator[SizeSpeeds]:
    """
    Yield the speeds at each size; in a round each peer has its turn.

    :param sizes: nodes along each side
    :param round_seconds: wall time that each turn aims at [s]
    """
    for size in sizes:
        cloth = cloth_of(bench_scene(size, {}))
        peers = {name: factory(cloth) for name, factory in made.items()}
        counts = {name: _steps_for(peer, round_seconds) for name, peer in peers.items()}
        walls: dict[str, list[float]] = {name: [] for name in peers}
        processor: dict[str, list[float]] = {name: [] for name in peers}
        for _ in range(rounds):
            for name, peer in peers.items():
                wall, used = time_steps(peer, counts[name])
                walls[name].append(size**2 * counts[name] / wall)
                processor[name].append(size**2 * counts[name] / used)
        for peer in peers.values():
            _close(peer)
        yield SizeSpeeds(size, cloth.dt, tuple(
            _speed(name, walls, processor) for name in peers))


def time_steps(peer: Peer, count: int) -> tuple[float, float]:
    """Make ``count`` steps and return the wall time and the time of all processors [s]."""
    begin, used = time.perf_counter(), time.process_time()
    peer.step(count)
    return time.perf_counter() - begin, time.process_time() - used


def _steps_for(peer: Peer, seconds: float) -> int:
    # The first steps compile what is put off until then.
    peer.step(2)
    count = 2
    while (wall := time_steps(peer, count)[0]) < seconds / 8.0:
        count *= 2
    return max(1, round(count * seconds / wall))


def _speed(
        name: str, walls: Mapping[str, list[float]],
        processor: Mapping[str, list[float]]) -> PeerSpeed:
    ratios, processor_ratios = (
        tuple(fused / own for fused, own in zip(figures[FUSED], figures[name]))
        for figures in (walls, processor))
    return PeerSpeed(
        name, statistics.median(walls[name]), tuple(walls[name]), statistics.median(ratios),
        ratios, statistics.median(processor_ratios))


def _close(peer: Peer) -> None:
    if isinstance(peer, SimulatedCloth):
        peer.close()


def machine(context: Context) -> dict[str, Any]:
    """Return what the figures depend on, for JSON."""
    return {
        'device': context.device, 'driver': context.version, 'processor': processor_name(),
        'versions': _versions(), 'commit': _said_by('git', 'describe', '--always', '--dirty'),
        'environment': ONE_THREAD}


def _versions() -> dict[str, str]:
    versions = {'python': platform.python_version(), 'cloth_sim_ros': project_version()}
    for package in _PACKAGES:
        try:
            versions[package] = version(package)
        except PackageNotFoundError:
            continue
    try:
        versions['C'] = _said_by(compiler(), '--version').partition('\n')[0]
    except PeerMissingError:
        pass
    return versions


def _said_by(*command: str) -> str:
    try:
        return subprocess.run(
            command, cwd=Path(__file__).parent, capture_output=True, text=True,
            check=True).stdout.strip()
    except (OSError, subprocess.CalledProcessError):
        return ''


def measure(args: Namespace, context: Context) -> Iterator[dict[str, Any]]:
    """Yield what is known before the first round, and then each size."""
    names = tuple(dict.fromkeys((FUSED, *args.only)))
    # Some libraries write there when they are loaded, or when they compile.
    with redirect_stdout(sys.stderr):
        made, left_out = factories(names, context)
        far = deviations(made)
        agreed = {name: factory for name, factory in made.items() if far[name] <= TOLERANCE}
    yield {**machine(context), 'left_out': left_out, 'deviations': far,
           'not_timed': [name for name in made if name not in agreed]}
    if FUSED not in agreed:
        return
    speeds = compare(agreed, args.sizes, args.rounds, args.round_seconds)
    while True:
        with redirect_stdout(sys.stderr):
            size = next(speeds, None)
        if size is None:
            return
        yield asdict(size)


def in_words(found: Mapping[str, Any]) -> str:
    """Return lines for people of one thing that ``measure`` yields."""
    if 'speeds' in found:
        lines = [f'{found["nodes"]} x {found["nodes"]}']
        for speed in found['speeds']:
            ratios = speed['ratio_rounds']
            lines.append(
                f'  {speed["peer"]:10}{speed["median"] / 1e6:8.1f} million node steps/s '
                f'({min(speed["rounds"]) / 1e6:.1f} to {max(speed["rounds"]) / 1e6:.1f}), fused '
                f'is {speed["ratio"]:6.2f} x ({min(ratios):.2f} to {max(ratios):.2f}; '
                f'by processor time {speed["processor_ratio"]:.2f})')
        return '\n'.join(lines)
    lines = [f'{found["device"]}, {found["driver"]}, on {found["processor"]}, one thread']
    lines += [f'  {name} is left out: {reason}' for name, reason in found['left_out'].items()]
    for name, far in found['deviations'].items():
        end = ': NOT TIMED' if name in found['not_timed'] else ''
        lines.append(f'  {name:10}{far:.1e} m from the reference{end}')
    return '\n'.join(lines)


def main(given: Sequence[str] | None = None) -> int:
    """Measure and print."""
    parser = ArgumentParser(description='Compare a cloth of springs with other simulators.')
    parser.add_argument('--sizes', type=int, nargs='+', metavar='N', default=[32, 128, 512, 1024],
                        help='nodes along each side (default: 32 128 512 1024)')
    parser.add_argument('--rounds', type=int, default=7, help='(default: %(default)s)')
    parser.add_argument('--round-seconds', type=float, default=0.4, metavar='T',
                        help='wall time that a turn aims at [s] (default: %(default)s)')
    parser.add_argument('--only', nargs='+', choices=NAMES, default=NAMES, metavar='NAME',
                        help=f'peers beside {FUSED}, of {"; ".join(NAMES[1:])} (default: all)')
    parser.add_argument('--json', action='store_true',
                        help='print JSON: a line of the machine, then a line per size')
    args = parser.parse_args(given)
    os.environ.update(ONE_THREAD)
    failed = False
    with closing(Context(single_thread=True)) as context:
        for found in measure(args, context):
            print(json.dumps(found) if args.json else in_words(found), flush=True)
            failed = failed or bool(found.get('not_timed'))
    return int(failed)


if __name__ == '__main__':
    sys.exit(main())
