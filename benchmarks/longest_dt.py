# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

r"""
Up to which dt the methods of the project and of the paper hold, in the scene of Fig. 10 and 11.

For example:
  python benchmarks/longest_dt.py
  python benchmarks/longest_dt.py --nodes 20 --push 20 --dts 0.005 0.01 0.02
"""

from argparse import ArgumentParser
from collections.abc import Mapping
from collections.abc import Sequence
from typing import Any

from cloth_sim_ros.sim.model.given_values import load_parameters
from cloth_sim_ros.study.paper_figures import PAPER_ADAPTIVE
from cloth_sim_ros.study.paper_figures import PAPER_CONSTRAINT
from cloth_sim_ros.study.paper_figures import paper_scene_file
from limits import limit_run
from limits import LimitRun
from pushed_scenes import GRAVITY

_DTS = (0.002, 0.005, 0.01, 0.015, 0.02, 0.03, 0.05, 0.1, 0.2)
_METHODS = (
    ('constraint', {'mode': 'constraint'}, 0.0),
    ('constraint, no substeps', {'mode': 'constraint', 'auto_substeps': False}, 0.0),
    ("constraint, the paper's method", PAPER_CONSTRAINT, 0.0),
    ('adaptive', {'mode': 'adaptive'}, 0.1),
    ('adaptive, no substeps', {'mode': 'adaptive', 'auto_substeps': False}, 0.1),
    ("adaptive, the paper's scheme", PAPER_ADAPTIVE, 0.1))
# What counts as holding: strain beyond what the method allows, and energy over that with a dt so
# short that it changes no more.
_MOST_BEYOND = 0.02
_MOST_ENERGY = 1.1
_SHORT_DT = 0.002


def pushed_cloth(nodes: int, push: float) -> dict[str, Any]:
    """Return the scene's values with ``nodes`` a side, pushed with ``push`` times the weight."""
    values = {
        name: value for name, value in load_parameters(paper_scene_file()).items()
        if not name.startswith('publish.')}
    side = nodes - 1.0
    free_mass = values['node_mass'] * (nodes**2 - len(values['pins']))
    return {
        **values, 'rows': nodes, 'cols': nodes, 'width': side, 'height': side,
        'pushes.force': [0.0, 0.0, push * GRAVITY * free_mass]}


def run_at(
        values: Mapping[str, Any], changes: Mapping[str, Any], dt: float,
        seconds: float) -> LimitRun:
    """Run the scene by one method at one dt, without the stability check or a stop at NaN."""
    return limit_run(
        {**values, **changes, 'dt': dt}, seconds, check_stability=False,
        stop_at_non_finite=False)


def holds(run: LimitRun, allowed: float, short: LimitRun) -> bool:
    """
    Tell whether a run keeps its lengths and its energy.

    :param allowed: the strain up to which edges may come
    :param short: the same mode as the project has it, at a short dt
    """
    return run.finite and run.max_strain - allowed <= _MOST_BEYOND and (
        run.peak_kinetic_energy <= _MOST_ENERGY * short.peak_kinetic_energy)


def _cell(run: LimitRun, allowed: float, short: LimitRun) -> str:
    if not run.finite:
        return 'not finite'
    beyond = 100.0 * max(0.0, run.max_strain - allowed)
    ratio = run.peak_kinetic_energy / short.peak_kinetic_energy
    text = f'{_plain(beyond, 2)} %, {_plain(ratio, 3)}'
    return f'**{text}**' if holds(run, allowed, short) else text


def _plain(value: float, digits: int) -> str:
    return f'{value:.{digits}g}' if value < 10.0**digits - 0.5 else f'{value:.0f}'


def _row(
        name: str, changes: Mapping[str, Any], allowed: float, values: Mapping[str, Any],
        dts: Sequence[float], seconds: float) -> str:
    short = run_at(values, {'mode': changes['mode']}, _SHORT_DT, seconds)
    cells = [_cell(run_at(values, changes, dt, seconds), allowed, short) for dt in dts]
    return f'| {name} | {" | ".join(cells)} |'


def main() -> None:
    """Print the table of docs/notes/paper.md."""
    parser = ArgumentParser(description=__doc__)
    parser.add_argument('--nodes', type=int, default=12, help='along each side')
    parser.add_argument('--push', type=float, default=5.0, help='times the weight')
    parser.add_argument('--dts', type=float, nargs='+', default=_DTS)
    parser.add_argument('--seconds', type=float, default=3.0, help='simulated, of each run')
    args = parser.parse_args()
    values = pushed_cloth(args.nodes, args.push)
    print(f'| dt [s] | {" | ".join(f"{dt:g}" for dt in args.dts)} |')
    print('|' + '---|' * (1 + len(args.dts)))
    for name, changes, allowed in _METHODS:
        print(_row(name, changes, allowed, values, args.dts, args.seconds), flush=True)


if __name__ == '__main__':
    main()
