# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""
What each shader of a mode takes to compile: processor time of linking it, and of its first run.

For example:
  MESA_SHADER_CACHE_DISABLE=true LP_NUM_THREADS=0 python benchmarks/compile_times.py adaptive
"""

from argparse import ArgumentParser
from collections import defaultdict
from collections.abc import Callable
from collections.abc import Mapping
from dataclasses import dataclass
from time import process_time
from typing import Any
from unittest.mock import patch

from cloth_sim_ros.gl import program
from cloth_sim_ros.gl import quick_calls
from cloth_sim_ros.sim.scene import Scene
from cloth_sim_ros.sim.simulation import Simulation
import yaml

# As small as has coarse levels: to run a shader takes hardly any time then.
_SIDE = 36


@dataclass
class CompileTime:
    """
    Of all variants of a shader.

    :param variants: how many there are
    :param linking: [s]
    :param running: that all runs together took [s]: most of it to compile
    """

    variants: int = 0
    linking: float = 0.0
    running: float = 0.0

    @property
    def seconds(self) -> float:
        """Return both together."""
        return self.linking + self.running


def compile_times(values: Mapping[str, Any]) -> tuple[dict[str, CompileTime], float]:
    """Return the times of all shaders by file, slowest first, and that of a first step [s]."""
    found: defaultdict[str, CompileTime] = defaultdict(CompileTime)
    names: dict[int, str] = {}
    in_use = 0

    def linked(stages: Mapping[int, Any]) -> int:
        name = ' and '.join(source.name for source in stages.values())
        begin = process_time()
        made: int = link(stages)
        found[name].linking += process_time() - begin
        found[name].variants += 1
        names[made] = name
        return made

    def used(number: int) -> None:
        nonlocal in_use
        in_use = number
        use(number)

    def timed(dispatch: Callable[..., None]) -> Callable[..., None]:
        def run(*arguments: int) -> None:
            begin = process_time()
            dispatch(*arguments)
            found[names[in_use]].running += process_time() - begin
        return run

    link, use = program._linked, quick_calls.use_program
    with patch.object(program, '_linked', linked), \
            patch.object(quick_calls, 'use_program', used), \
            patch.object(quick_calls, 'dispatch', timed(quick_calls.dispatch)), \
            patch.object(quick_calls, 'dispatch_indirect', timed(quick_calls.dispatch_indirect)):
        begin = process_time()
        with Simulation(Scene({'rows': _SIDE, 'cols': _SIDE, **values})) as simulation:
            simulation.warm_up()
            simulation.step()
            whole = process_time() - begin
    return dict(sorted(found.items(), key=lambda entry: -entry[1].seconds)), whole


def main() -> None:
    """Print a table."""
    parser = ArgumentParser(description=__doc__.partition('\n\n')[0])
    parser.add_argument('mode', help='mass_spring, constraint or adaptive')
    parser.add_argument(
        '--set', action='append', default=[], metavar='NAME=VALUE', help='of the scene')
    args = parser.parse_args()
    changes = dict(each.split('=', 1) for each in args.set)
    found, whole = compile_times({
        'mode': args.mode, **{name: yaml.safe_load(text) for name, text in changes.items()}})
    print(f'{"shader":32} variants  linking  running [s]')
    for name, took in found.items():
        print(f'{name:32} {took.variants:8} {took.linking:8.2f} {took.running:8.2f}')
    print(f'{whole:.1f} s of a processor to the end of the first step, '
          f'{sum(took.seconds for took in found.values()):.1f} of them for these')


if __name__ == '__main__':
    main()
