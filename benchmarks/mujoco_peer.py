# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""
A sheet that falls over a sphere, here and as a flex of MuJoCo, at equal stretch.

Size, mass, nodes, sphere, friction and start are the same. MuJoCo's edges are equality
constraints, whose time constant is twice its step, the stiffest that it allows. The simulators
take turns every 20 ms of simulated time, on one core.

MuJoCo is no part of the project: python -m pip install mujoco

For example:
  LP_NUM_THREADS=0 python benchmarks/mujoco_peer.py
  LP_NUM_THREADS=0 python benchmarks/mujoco_peer.py --nodes 16 --mujoco-steps 0.0005
"""

from argparse import ArgumentParser
from collections.abc import Iterator
import statistics
import sys
import time
from typing import Any
from typing import Protocol

from cloth_sim_ros.gl.context import Context
from cloth_sim_ros.sim.scene import Scene
from cloth_sim_ros.sim.simulation import Simulation
import numpy as np

SIDE, MASS, HEIGHT, RADIUS, FRICTION = 1.0, 0.15, 0.2, 0.15, 0.3
# Half the thickness of the sheet [m].
CLEARANCE = 0.001
TURN = 0.02
MODES: dict[str, dict[str, Any]] = {
    'mass_spring, 1e4 N/m': {
        'mode': 'mass_spring', 'stiffness.structural': 1e4, 'stiffness.shear': 1e3},
    'constraint': {'mode': 'constraint', 'constraint.strain': 0.01},
}
_MODEL = """
<mujoco>
  <option timestep="{step}" solver="CG" iterations="100" tolerance="1e-6" cone="elliptic"/>
  <size memory="1G"/>
  <worldbody>
    <geom type="sphere" size="{radius}" friction="{friction} 0 0"/>
    <flexcomp name="sheet" type="grid" dim="2" count="{nodes} {nodes} 1"
        spacing="{spacing} {spacing} {spacing}" pos="0 0 {height}" mass="{mass}"
        radius="{clearance}">
      <edge equality="true" solref="{constant} 1"/>
      <contact selfcollide="none" condim="3" friction="{friction} 0 0" solref="{constant} 1"/>
    </flexcomp>
  </worldbody>
</mujoco>
"""


class Sheet(Protocol):
    """What takes part."""

    def advance(self, end: float) -> None:
        """Simulate up to ``end`` [s]."""

    def positions(self) -> np.ndarray:
        """Return where the nodes are, (n, n, 3) [m]."""


class Flex:
    """
    A model of MuJoCo with one flex of nodes in a square.

    :param nodes: along a side
    :param model: as MJCF
    """

    def __init__(self, nodes: int, model: str) -> None:
        """Compile the model."""
        import mujoco
        self._mujoco = mujoco
        self._nodes = nodes
        self._model = mujoco.MjModel.from_xml_string(model)
        self._data = mujoco.MjData(self._model)

    def advance(self, end: float) -> None:
        """Simulate up to ``end`` [s]."""
        while self._data.time < end - 1e-9:
            self._mujoco.mj_step(self._model, self._data)

    def positions(self) -> np.ndarray:
        """Return where the nodes are, (n, n, 3) [m]."""
        # Those of a step are where it began.
        self._mujoco.mj_kinematics(self._model, self._data)
        self._mujoco.mj_flex(self._model, self._data)
        return self._data.flexvert_xpos.reshape(self._nodes, self._nodes, 3).copy()


def falling(nodes: int, step: float) -> Flex:
    """Return the sheet in MuJoCo, in steps of ``step`` [s]."""
    return Flex(nodes, _MODEL.format(
        step=step, constant=2.0 * step, nodes=nodes, spacing=SIDE / (nodes - 1), mass=MASS,
        radius=RADIUS, friction=FRICTION, height=HEIGHT, clearance=CLEARANCE))


class Cloth:
    """The sheet here."""

    def __init__(self, nodes: int, values: dict[str, Any], context: Context) -> None:
        """Compile the shaders."""
        self._run = Simulation(Scene({
            'rows': nodes, 'cols': nodes, 'width': SIDE, 'height': SIDE,
            'areal_density': MASS / SIDE**2, 'start.pose': 'horizontal', 'start.z': HEIGHT,
            'material.preset': 'none', 'pins': ['none'], 'dt': 0.005,
            'contact.thickness': 2.0 * CLEARANCE,
            'colliders.names': ['ball'], 'colliders.ball.shape': 'sphere',
            'colliders.ball.size': [RADIUS], 'colliders.ball.friction': FRICTION, **values}),
            context=context)
        self._run.warm_up()
        self._run.finish()

    def advance(self, end: float) -> None:
        """Simulate up to ``end`` [s]."""
        while self._run.time < end - 1e-9:
            self._run.step()
        self._run.finish()

    def positions(self) -> np.ndarray:
        """Return where the nodes are, (n, n, 3) [m]."""
        return self._run.positions()


def stretch(positions: np.ndarray) -> np.ndarray:
    """Return how much longer each edge along the threads is, over its length at rest."""
    lengths = [np.linalg.norm(np.diff(positions, axis=axis), axis=-1) for axis in (0, 1)]
    rest = SIDE / (len(positions) - 1)
    return np.concatenate([each.ravel() for each in lengths]) / rest - 1.0


def compare(sheets: dict[str, Sheet], seconds: float) -> Iterator[str]:
    """Run all of them in turns, and yield a row of the table for each."""
    walls = {name: [] for name in sheets}
    peak, usual, deepest = ({name: [] for name in sheets} for _ in range(3))
    for turn in range(1, round(seconds / TURN) + 1):
        for name, sheet in sheets.items():
            begin = time.perf_counter()
            sheet.advance(turn * TURN)
            walls[name].append(time.perf_counter() - begin)
            positions = sheet.positions()
            stretched = stretch(positions)
            peak[name].append(stretched.max())
            usual[name].append(np.percentile(np.abs(stretched), 95))
            gap = np.linalg.norm(positions, axis=-1).min() - RADIUS - CLEARANCE
            deepest[name].append(max(-gap, 0.0))
    for name in sheets:
        yield (
            f'| {name} | {sum(walls[name]) / seconds:.2f} | {100 * max(peak[name]):.1f} | '
            f'{100 * statistics.median(usual[name]):.2f} | {1e3 * max(deepest[name]):.3f} |')


def main() -> int:
    """Measure and print."""
    parser = ArgumentParser(description='Compare a sheet that falls over a sphere with MuJoCo.')
    parser.add_argument('--nodes', type=int, default=32, help='along each side')
    parser.add_argument('--seconds', type=float, default=0.6, help='simulated')
    parser.add_argument('--rounds', type=int, default=2)
    parser.add_argument('--mujoco-steps', type=float, nargs='+', default=[0.001, 0.0005, 0.00025],
                        help='time steps to try [s]')
    args = parser.parse_args()
    context = Context(single_thread=True)
    print('| sheet | wall time of a simulated second [s] | largest stretch [%] | 95 % of the '
          'edges, median over time [%] | deepest node [mm] |')
    print('|---|---|---|---|---|')
    for _ in range(args.rounds):
        sheets: dict[str, Sheet] = {
            name: Cloth(args.nodes, values, context) for name, values in MODES.items()}
        try:
            for step in args.mujoco_steps:
                sheets[f'MuJoCo, step {step:g} s'] = falling(args.nodes, step)
        except ImportError:
            print('MuJoCo is missing: python -m pip install mujoco', file=sys.stderr)
        for row in compare(sheets, args.seconds):
            print(row, flush=True)
    return 0


if __name__ == '__main__':
    sys.exit(main())
