# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""
What a run changes by when one tuning constant of the code has another value.

Each value is tried in a process of its own, on a copy of the sources in which the line of the
constant is replaced, so that Python and GLSL are treated alike. The scenes are short: cloth is
chaotic after a second, and they end before. Solves and iterations are the measure of cost; the
processor time is printed for orientation.

Columns of the table: RMS distance of the final positions over the RMS way of the nodes, change of
the energy over M g times the size of the cloth [1], largest strain over its limit (that of the
hard edges under the weight in mode constraint) once the start has settled [1], deepest node, or
overlap of layers, of a dt, mean over the run [um], solves and iterations per dt, rounds over the
edges at their limit in the substep of a dt that took most, processor time over that of the
default, switches of limits per dt, and the number of dt in which a solve did not reach its
tolerance. Differences and the strain are the largest of the scenes, the others are means. The row
"tolerance / 2" is a yardstick: what half the ``solver.tolerance`` of the scenes changes, with the
default of the constant.

For example:
  python benchmarks/constants.py
  python benchmarks/constants.py --only _EARLY _HALF --scenes adaptive stretched
"""

from argparse import ArgumentParser
from collections.abc import Iterator
from collections.abc import Mapping
from collections.abc import Sequence
from dataclasses import dataclass
import json
import math
import os
from pathlib import Path
import re
import shutil
import subprocess
import sys
from tempfile import TemporaryDirectory
from typing import Any

from cloth_sim_ros.sim.model.scene_fields import SCENE_FIELDS
import numpy as np

_ROOT = Path(__file__).resolve().parents[1]
_PARTS = ('cloth_sim_ros', 'shaders', 'config')
# Max. wall time of all scenes of one value [s]; beyond it the row says so.
_PATIENCE = 300.0
# Default of solver.tolerance [1].
_TOLERANCE = next(field.default for field in SCENE_FIELDS if field.name == 'solver.tolerance')

_SHEET = {
    'rows': 16, 'cols': 16, 'stiffness.structural': 300.0, 'stiffness.shear': 100.0,
    'stiffness.bend': 1.0, 'pushes.start': [0.1], 'pushes.duration': [0.1],
    'pushes.force': [0.0, 8.0, -4.0], 'pushes.center': [0.0, -0.3, 1.0], 'pushes.radius': [0.3]}
_STILL = {
    'rows': 12, 'cols': 12, 'pins': ['top_left'], 'start.jitter': 0.02,
    'stiffness.structural': 300.0, 'stiffness.shear': 100.0, 'stiffness.bend': 1.0}
_LOOSE = {
    'rows': 16, 'cols': 16, 'width': 0.5, 'height': 0.5, 'pins': ['none'], 'start.jitter': 0.01,
    'stiffness.structural': 300.0, 'stiffness.shear': 100.0, 'stiffness.bend': 1.0}
_FLOOR = {'colliders.floor.shape': 'plane'}
_BALL = {'colliders.ball.shape': 'sphere', 'colliders.ball.size': [0.12]}

# Name to parameters, simulated time [s], and factor of the positions at the start [1].
SCENES: Mapping[str, tuple[Mapping[str, Any], float, float]] = {
    'constraint': ({**_SHEET, 'mode': 'constraint'}, 0.6, 1.0),
    'adaptive': ({**_SHEET, 'mode': 'adaptive', 'adaptive.threshold': 0.02}, 0.6, 1.0),
    # The implicit step of the whole cloth, and passes over the lattice, whatever they cost.
    'whole': ({**_SHEET, 'mode': 'adaptive', 'adaptive.scheme': 'whole',
               'adaptive.threshold': 0.02}, 0.6, 1.0),
    'lattice': ({**_SHEET, 'mode': 'adaptive', 'adaptive.scheme': 'lattice',
                 'adaptive.threshold': 0.02}, 0.6, 1.0),
    # It hangs as it starts: what changes is rounding.
    'rest': ({**_STILL, 'mode': 'constraint', 'pins': ['top_edge'], 'start.pose': 'hanging',
              'start.jitter': 0.0}, 0.3, 1.0),
    # The limit of 2 % has come into force at 1.2 of it; a wider one nearer to it.
    'wide': ({**_SHEET, 'mode': 'adaptive', 'stiffness.structural': 30.0}, 0.6, 1.0),
    # The springs of a scene without any values, and a limit of 10 %.
    'swing': ({'rows': 24, 'cols': 24, 'mode': 'adaptive', 'pushes.start': [0.2],
               'pushes.duration': [0.1], 'pushes.force': [0.0, 6.0, 0.0],
               'pushes.center': [0.0, 0.0, 1.0], 'pushes.radius': [0.3]}, 0.8, 1.0),
    # Two pins would keep its initial width.
    'stretched': ({**_STILL, 'mode': 'constraint'}, 0.45, 1.1),
    'small': ({**_STILL, 'mode': 'constraint', 'width': 0.05, 'height': 0.05, 'dt': 0.001},
              0.45, 1.1),
    'sail': ({**_STILL, 'mode': 'constraint', 'width': 20.0, 'height': 20.0}, 2.0, 1.1),
    'drape': ({**_LOOSE, **_BALL, 'mode': 'constraint', 'start.z': 0.15,
               'colliders.names': ['ball'], 'colliders.ball.friction': 0.3}, 0.5, 1.0),
    'squeezed': ({
        **_LOOSE, **_FLOOR, **_BALL, 'rows': 12, 'cols': 12, 'mode': 'constraint',
        'start.z': 0.002, 'contact.thickness': 0.004, 'colliders.names': ['floor', 'ball'],
        'colliders.ball.position': [0.0, 0.0, 0.2], 'motion.speed': 0.5,
        'collider_moves.start': [0.05], 'collider_moves.name': ['ball'],
        'collider_moves.target': [0.0, 0.0, 0.121]}, 0.4, 1.0),
    'friction': ({
        **_LOOSE, **_FLOOR, **_BALL, 'mode': 'adaptive', 'adaptive.scheme': 'whole',
        'adaptive.threshold': 0.02, 'start.z': 0.15, 'colliders.names': ['floor', 'ball'],
        'colliders.floor.friction': 1.0,
        'colliders.ball.friction': 1.0}, 0.5, 1.0),
    'sunk': ({
        **_LOOSE, **_FLOOR, 'rows': 12, 'cols': 12, 'mode': 'constraint', 'start.z': -0.02,
        'colliders.names': ['floor'], 'colliders.floor.orientation': [0.0, 0.05, 0.0, 1.0]},
        0.3, 1.0),
    # A ribbon that falls into a heap.
    'heap': ({
        **_FLOOR, 'rows': 32, 'cols': 4, 'width': 0.06, 'height': 0.62, 'mode': 'constraint',
        'pins': ['none'], 'start.pose': 'hanging', 'start.z': 0.0, 'start.jitter': 0.003,
        'dt': 0.005, 'colliders.names': ['floor'], 'colliders.floor.position': [0.0, 0.0, -0.35],
        'self_contact.enabled': True, 'self_contact.thickness': 0.005}, 0.45, 1.0),
    'springy heap': ({
        **_FLOOR, 'rows': 48, 'cols': 6, 'width': 0.0635, 'height': 0.6, 'pins': ['none'],
        'start.pose': 'hanging', 'start.z': 0.0, 'start.jitter': 0.003, 'dt': 0.002,
        'stiffness.structural': 300.0, 'stiffness.shear': 100.0, 'stiffness.bend': 1.0,
        'colliders.names': ['floor'], 'colliders.floor.position': [0.0, 0.0, -0.35],
        'self_contact.enabled': True, 'self_contact.thickness': 0.004}, 0.6, 1.0),
}
_LIMITED = ('whole', 'stretched', 'friction')
_HARD = ('constraint', 'drape')
_SPRINGS = ('adaptive', 'whole', 'wide')
# In which edges are listed.
_LISTED = ('adaptive', 'wide', 'swing', 'lattice')
_TOUCHING = ('drape', 'squeezed', 'friction')


@dataclass(frozen=True)
class Constant:
    """
    A tuning constant.

    :param file: that defines it, below the repository
    :param values: tried instead, as they are written
    :param scenes: in which it has any effect
    """

    name: str
    file: str
    values: tuple[str, ...]
    scenes: tuple[str, ...]

    @property
    def _line(self) -> re.Pattern[str]:
        name = re.escape(self.name)
        return re.compile(
            rf'^(#define {name} |const float {name} = |{name}(?:: \w+)? = )([^;\n#]+?)'
            r'(;?(?: *(?:#|//).*)?)$', re.MULTILINE)

    def default(self, root: Path) -> str:
        """Return its value in the sources below ``root``, as it is written."""
        found = self._line.findall((root / self.file).read_text(encoding='utf-8'))
        if len(found) != 1:
            raise SystemExit(f'{self.file} has {len(found)} lines that define {self.name}, not 1')
        return found[0][1]

    def replace(self, root: Path, value: str) -> None:
        """Write ``value`` in its place."""
        path = root / self.file
        text = path.read_text(encoding='utf-8')
        path.write_text(self._line.sub(rf'\g<1>{value}\g<3>', text), encoding='utf-8')


_SOLVER = 'cloth_sim_ros/sim/solver/'
_MODES = 'cloth_sim_ros/sim/modes/'
_CONTACT = 'cloth_sim_ros/sim/contact/'
_LIMITS = 'cloth_sim_ros/sim/limits/'
CONSTANTS = (
    Constant('_EARLY', f'{_SOLVER}solver.py', ('0.0', '0.1', '0.5', '0.9'), _LIMITED),
    Constant('_HALF', f'{_SOLVER}solver.py', ('0.0', '0.25', '0.75', '1.1'), _LIMITED),
    Constant('_LACKING', f'{_SOLVER}solver.py', ('0.1', '0.25', '1.0', '2.0'), _LIMITED),
    Constant('_AIM', f'{_SOLVER}solver.py', ('0.4', '0.6', '1.0'), ('whole', *_HARD)),
    Constant('_SHARE', f'{_LIMITS}limit_law.py', ('0.05', '0.2', '0.5'), _SPRINGS),
    Constant('_MOST', f'{_LIMITS}limit_law.py', ('0.0005', '0.001', '0.004'), _SPRINGS),
    Constant('_TRANSITION', f'{_MODES}limited_springs.py', ('0.0', '0.5', '2.0'), ('whole',)),
    Constant('_RELEASE', f'{_LIMITS}limit_marks.py', ('0.0', '0.25', '0.75', '1.0'), _SPRINGS),
    Constant('NEAR', f'{_LIMITS}limit_program.py', ('0.7', '0.8', '0.95', '1.0'), _LISTED),
    Constant('_WIDE', f'{_LIMITS}limit_program.py', ('0.0', '0.25', '0.75', '0.9'), _LISTED),
    Constant('_TOLERANCE', f'{_LIMITS}limit_program.py', ('1e-6', '1e-4', '1e-3'), _LISTED),
    Constant('_REDUCTION', f'{_LIMITS}limit_program.py',
             ('(0.01, 0.1)', '(0.1, 0.1)', '(0.5, 0.5)', '(0.9, 0.9)'), _LISTED),
    Constant('_LOOSE', f'{_LIMITS}limit_program.py', ('0.0', '0.001', '0.1'), _LISTED),
    Constant('_MOTION', f'{_LIMITS}limit_program.py', ('0.001', '0.1', '1.0'), _LISTED),
    Constant('CLOSING', f'{_LIMITS}limit_program.py', ('0.02', '0.05', '0.2', '0.5'), _LISTED),
    Constant('MOST_ROUNDS', f'{_LIMITS}limit_program.py', ('25', '100', '1600'), _LISTED),
    Constant('MOST_SCALE', f'{_LIMITS}limit_program.py', ('0.0', '1.0', '4.0'), _LISTED),
    Constant('MISSED', 'shaders/include/limit_law.glsl', ('0.01', '0.2', '1e9'), _LISTED),
    Constant('_MOST_PASSES', f'{_LIMITS}active_limits.py', ('1', '4', '64'), _LISTED),
    Constant('_MANY', f'{_LIMITS}active_limits.py', ('0.0', '0.3', '4.0'), _LISTED[:3]),
    Constant('_FEWER', f'{_LIMITS}active_limits.py', ('0.2', '1.2'), _LISTED[:3]),
    Constant('_ROUNDS_AT_ONCE', f'{_LIMITS}lattice_rounds.py', ('1', '2', '8', '16'),
             ('lattice',)),
    Constant('_LOOK', f'{_MODES}adaptive.py', ('4', '8', '32', '64'), _LISTED),
    Constant('_REVIEW', f'{_MODES}adaptive.py', ('2', '4', '16', '32'), _LISTED),
    Constant('_LISTED_COST', f'{_MODES}adaptive.py', ('0.0', '4.0'), _LISTED[:3]),
    Constant('_ROUND_COST', f'{_MODES}adaptive.py', ('1.0', '6.0', '12.0'), _LISTED[:3]),
    Constant('_WHOLE_COST', f'{_MODES}adaptive.py', ('40.0', '80.0', '300.0', '600.0'),
             _LISTED[:3]),
    Constant('_RETURN', f'{_MODES}adaptive.py', ('0.1', '0.25', '0.75', '1.0'), _LISTED[:3]),
    Constant('_FIRST', f'{_MODES}adaptive.py', ('2', '4', '8'), _LISTED),
    Constant('_LONGER', f'{_MODES}adaptive.py', ('0.25', '0.75', '1.0'), _LISTED),
    Constant('_KEPT_FOR', f'{_MODES}adaptive.py', ('0', '64', '4096'), _LISTED),
    Constant('_SOME', f'{_MODES}adaptive.py', ('0.0', '0.01', '0.1', '1.0'), _LISTED),
    Constant('_ROUGH', f'{_MODES}adaptive.py', ('0.005', '0.01', '0.05', '0.2'), _LISTED),
    Constant('_ROUGH_FOR', f'{_MODES}adaptive.py', ('8', '16', '64', '128'), _LISTED),
    Constant('_DEAR', f'{_MODES}adaptive.py', ('1.0', '3.0', '1e9'), _LISTED),
    Constant('_ROUGH_MOST', f'{_MODES}adaptive.py', ('32', '128', '4096'), _LISTED),
    Constant('_NOTABLE', f'{_MODES}adaptive.py', ('1.0', '1.02', '1.2', '100.0'),
             (*_LISTED, 'whole')),
    Constant('_MEAN_TURN', f'{_MODES}edge_watch.py', ('0.0005', '0.001', '0.004', '0.1'),
             ('whole', *_HARD)),
    Constant('_LARGEST_TURN', f'{_MODES}edge_watch.py', ('0.002', '0.00375', '0.015', '0.4'),
             ('whole', *_HARD)),
    Constant('_SETTLING_TIME', f'{_MODES}implicit.py', ('0.01', '0.067', '0.15', '0.6'),
             ('stretched', 'small', 'sail')),
    Constant('_NOTABLE', f'{_MODES}constraint.py', ('0.0', '0.625', '2.5', '100.0'),
             ('constraint', 'stretched')),
    Constant('_MOST_SOLVES', f'{_MODES}implicit.py', ('2', '8', '16', '64'), _LIMITED),
    Constant('_MOST_CONTACT_SOLVES', f'{_MODES}implicit.py', ('2', '4', '16', '64'), _TOUCHING),
    Constant('_LAYERS_UNSOLVED', f'{_MODES}layered_constraint.py', ('1e-5', '1e-3'), ('heap',)),
    Constant('_MOST_LAYER_SOLVES', f'{_MODES}layered_constraint.py', ('6', '24', '48'),
             ('heap',)),
    Constant('_ROUNDS_OF_SOLVE', f'{_CONTACT}self_contact.py', ('2', '4', '24'), ('heap',)),
    Constant('_SKIN_OF_LONG_WAY', f'{_CONTACT}self_contact.py', ('4.0', '16.0'), ('heap',)),
    Constant('AHEAD', 'shaders/self_contact/contacts.comp', ('0.5', '1.0', '2.0'),
             ('springy heap',)),
    Constant('PART_OF_SPEED', 'shaders/self_contact/contacts.comp', ('0.0', '1.0'),
             ('springy heap',)),
    Constant('_MOST_CONTACT_TURNS', f'{_MODES}implicit.py', ('1', '2', '8'), _TOUCHING),
    Constant('_WAY_OUT_SPEED', f'{_CONTACT}contacts.py',
             ('0.0', '0.25', '0.5', '2.0', '4.0'), ('drape', 'squeezed', 'sunk')),
    Constant('FACING', 'shaders/include/contact.glsl', ('0.5', '0.8', '0.95', '0.99'),
             ('squeezed', 'friction')),
    Constant('NEARLY', 'shaders/solver/contact.comp', ('0.0', '0.25', '0.75', '1.0'), _TOUCHING),
    Constant('_HANGING_SHARE', f'{_SOLVER}edge_law.py', ('0.015', '0.06', '1.0'),
             ('constraint', 'whole')),
    Constant('_MOST_UNSOLVED', f'{_SOLVER}active_set.py', ('1e-6', '1e-5', '1e-3', '1e-2'),
             _TOUCHING),
    Constant('_FLAT', f'{_SOLVER}active_set.py', ('0.01', '0.025', '0.1', '0.5'), _LIMITED),
    Constant('_LOOKS', f'{_SOLVER}active_set.py', ('1', '3', '12'), _LIMITED),
    Constant('_SPREAD_OF_WEIGHT', f'{_SOLVER}preconditioner.py', ('2.5', '5.0', '20.0', '40.0'),
             ('whole', *_HARD)),
    Constant('_COARSEST_STEPS', f'{_SOLVER}preconditioner.py', ('5', '20'), ('whole', *_HARD)),
    Constant('_LEAST_SPREAD', f'{_SOLVER}preconditioner.py', ('2.0', '8.0', '60.0'),
             ('whole', *_HARD)),
    Constant('_MOST_SPREAD', f'{_SOLVER}preconditioner.py', ('4.0', '30.0', '120.0'),
             ('whole', *_HARD)),
    Constant('_LEAST', f'{_SOLVER}solver_programs.py', ('0.0625', '0.125', '0.5', '1.0'),
             ('whole', *_HARD)),
    Constant('_LEAST_CHANGE', f'{_SOLVER}tally.py', ('0.0', '1e-4', '1e-2', '0.1'),
             ('constraint', 'whole', 'friction', 'rest')),
)

# Runs the scenes that it reads, and prints one line of results for each.
_WORKER = """
import json, sys, time
from cloth_sim_ros.sim.scene import Scene
from cloth_sim_ros.sim.simulation import Simulation
import numpy as np
for line in sys.stdin:
    name, values, seconds, factor = json.loads(line)
    cloth = Simulation(Scene(values))
    cloth.warm_up()
    if factor != 1.0:
        cloth.set_state(factor * cloth.positions(), np.zeros_like(cloth.positions()))
    found = dict(solves=0, iterations=0.0, strain=0.0, deepest=0.0, switches=0, unreached=0,
                 rounds=0)
    begin = time.process_time()
    steps = round(seconds / cloth.scene['dt'])
    for _ in range(steps):
        cloth.step()
        now = cloth.snapshot()
        found['solves'] += now.solves
        found['rounds'] += now.limit_rounds
        found['iterations'] += now.solves * now.mean_iterations
        limit = now.strain_bound or cloth.scene['constraint.strain']
        if not now.settling:
            found['strain'] = max(found['strain'], now.max_strain / limit)
        overlap = now.layer_overlap * cloth.scene['self_contact.thickness']
        found['deepest'] += max(now.deepest_node, overlap) / steps
        found['switches'] += now.constraint_switches
        found['unreached'] += not now.solver_reached
    found |= dict(
        scene=name, steps=steps, processor=time.process_time() - begin, energy=now.total_energy,
        start=(factor * cloth.scene.start_positions()).tolist(), positions=now.positions.tolist(),
        weight=cloth.scene.node_mass * cloth.scene.node_count * 9.81
        * max(cloth.scene['width'], cloth.scene['height']))
    print(json.dumps(found), flush=True)
    cloth.close()
"""


def run_scenes(
        root: Path, scenes: Sequence[str],
        looseness: float = 1.0) -> list[dict[str, Any]] | str:
    """
    Return the results of ``scenes`` with the code below ``root``, or why there are none.

    ``looseness`` is a factor of their ``solver.tolerance``.

    Of each scene: ``positions`` at its end and at the ``start`` [m], ``energy`` [J], ``weight``
    times size [J], ``strain`` over the limit [1], ``deepest`` node [m], ``processor`` time [s],
    and sums over all ``steps`` of ``solves``, ``iterations``, ``rounds``,
    ``switches`` and ``unreached``.
    """
    environment = {
        **os.environ, 'PYTHONPATH': str(root), 'LP_NUM_THREADS': '0', 'CLOTH_SIM_TUNING': 'off'}
    orders = ''
    for name in scenes:
        values, seconds, factor = SCENES[name]
        tolerance = looseness * values.get('solver.tolerance', _TOLERANCE)
        values = {**values, 'solver.tolerance': tolerance}
        orders += json.dumps([name, values, seconds, factor]) + '\n'
    try:
        done = subprocess.run(
            [sys.executable, '-c', _WORKER], input=orders, capture_output=True, text=True,
            cwd=root, env=environment, timeout=_PATIENCE)
    except subprocess.TimeoutExpired:
        return f'not done after {_PATIENCE:g} s'
    if done.returncode:
        return (done.stderr.strip().splitlines() or ['ended without a word'])[-1]
    return [json.loads(line) for line in done.stdout.splitlines()]


@dataclass(frozen=True)
class Row:
    """The columns of the table, in their order and with the units of the module's docstring."""

    moved: float
    energy: float
    strain: float
    deepest: float
    solves: float
    iterations: float
    rounds: float
    processor: float
    switches: float
    unreached: int

    def __str__(self) -> str:
        """Return the end of a line of a Markdown table."""
        return (
            f'{self.moved:.1e} | {self.energy:+.1e} | {self.strain:.3f} '
            f'| {1e6 * self.deepest:.3g} | {self.solves:.2f} | {self.iterations:.1f} '
            f'| {self.rounds:.1f} | {self.processor:.2f} | {self.switches:.2f} '
            f'| {self.unreached} |')


def compare(found: Sequence[Mapping[str, Any]], usual: Sequence[Mapping[str, Any]]) -> Row:
    """Return the row of what was found, beside what the default values make of the scenes."""
    moves, energies = [], []
    for one, other in zip(found, usual):
        here, there, start = (np.array(each) for each in (
            one['positions'], other['positions'], other['start']))
        moves.append(math.sqrt(((here - there)**2).sum() / ((there - start)**2).sum()))
        energies.append((one['energy'] - other['energy']) / other['weight'])
    steps = sum(each['steps'] for each in found)
    per_step = {
        name: sum(each[name] for each in found) / steps
        for name in ('solves', 'iterations', 'rounds', 'switches')}
    return Row(
        max(moves), max(energies, key=abs), max(each['strain'] for each in found),
        max(each['deepest'] for each in found), per_step['solves'], per_step['iterations'],
        per_step['rounds'], sum(each['processor'] for each in found)
        / sum(each['processor'] for each in usual),
        per_step['switches'], sum(each['unreached'] for each in found))


class _Known:
    """Runs of scenes with the default values, each made once; ``looseness`` as of run_scenes."""

    def __init__(self, root: Path, looseness: float) -> None:
        self._root = root
        self._looseness = looseness
        self._found: dict[str, Mapping[str, Any]] = {}

    def runs(self, scenes: Sequence[str]) -> list[Mapping[str, Any]]:
        """Return what run_scenes does."""
        missing = [name for name in scenes if name not in self._found]
        made = run_scenes(self._root, missing, self._looseness) if missing else []
        if isinstance(made, str):
            raise SystemExit(made)
        self._found.update((each['scene'], each) for each in made)
        return [self._found[name] for name in scenes]


def tries(
        root: Path, constants: Sequence[Constant], chosen: Sequence[str]
        ) -> Iterator[tuple[Constant, str, Row | str]]:
    """Yield each constant with each value, the default first, and its row or why it has none."""
    of_default, of_fine = _Known(root, 1.0), _Known(root, 0.5)
    for constant in constants:
        scenes = [name for name in constant.scenes if name in chosen]
        if not scenes:
            continue
        usual = of_default.runs(scenes)
        yield constant, f'**{constant.default(root)}**', compare(usual, usual)
        yield constant, 'tolerance / 2', compare(of_fine.runs(scenes), usual)
        for value in constant.values:
            with TemporaryDirectory() as folder:
                copy = Path(folder)
                copy_sources(root, copy)
                constant.replace(copy, value)
                found = run_scenes(copy, scenes)
            yield constant, value, found if isinstance(found, str) else compare(found, usual)


def copy_sources(root: Path, to: Path) -> None:
    """Copy what a run needs of the sources below ``root``."""
    for part in _PARTS:
        shutil.copytree(root / part, to / part)


def main() -> None:
    """Print a table with a row for each value."""
    names = [constant.name for constant in CONSTANTS]
    parser = ArgumentParser(description=__doc__.strip().splitlines()[0])
    parser.add_argument('--only', nargs='+', metavar='NAME', choices=names, default=names,
                        help=f'constants to try, of {", ".join(names)}')
    parser.add_argument('--scenes', nargs='+', metavar='SCENE', choices=tuple(SCENES),
                        default=tuple(SCENES), help=f'of {", ".join(SCENES)}')
    args = parser.parse_args()
    print('| constant | value | moved | energy | strain | deepest | solves | iterations '
          '| rounds | time | switches | unreached |\n|' + 12 * '---|')
    with TemporaryDirectory() as folder:
        # So that an edit during the run changes nothing.
        root = Path(folder)
        copy_sources(_ROOT, root)
        constants = [constant for constant in CONSTANTS if constant.name in args.only]
        for constant, value, row in tries(root, constants, args.scenes):
            print(f'| `{constant.name}` | {value} | {row}', flush=True)


if __name__ == '__main__':
    main()
