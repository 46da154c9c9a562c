# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""
A towel that lies folded in half on a slope, here and in other simulators.

The slope has half the inclination at which it would begin to slide, on the floor or on itself. So
nothing should move after a while: what does is creep.

The others are no part of the project: python -m pip install mujoco newton

For example:
  LP_NUM_THREADS=0 python benchmarks/folded_peers.py
  LP_NUM_THREADS=0 python benchmarks/folded_peers.py --nodes 16 --only mass_spring 'MuJoCo'
"""

from argparse import ArgumentParser
from collections.abc import Callable
import math
from pathlib import Path
import sys
import time
from typing import Any

from cloth_sim_ros.sim.scene import Scene
from cloth_sim_ros.sim.simulation import Simulation
from mujoco_peer import Flex
from mujoco_peer import Sheet
import numpy as np

sys.path.insert(0, str(Path(__file__).parents[1] / 'test' / 'support'))
from crossings import crossings  # noqa: E402, I100

SIDE, DENSITY, FRICTION = 0.4, 0.2, 0.5
GRAVITY = 9.81
SLOPE = math.atan(0.5 * FRICTION)
# Across the fold, so that the upper layer would slide off the lower one.
ACCELERATION = (0.0, GRAVITY * math.sin(SLOPE), -GRAVITY * math.cos(SLOPE))
SETTLED, LONG = 1.0, 1.0  # [s] before creep is measured, and for how long


def folded(nodes: int, thickness: float) -> np.ndarray:
    """Return a towel that is folded in half, its layers a cell apart, (nodes, nodes, 3) [m]."""
    cell = SIDE / (nodes - 1)
    row, col = np.indices((nodes, nodes))
    along = row * cell - SIDE / 2.0
    radius = 0.5 * cell
    arc = math.pi * radius / 2.0
    x = np.where(np.abs(along) < arc, radius * np.cos(along / radius), arc - np.abs(along))
    z = np.where(
        np.abs(along) < arc, radius * np.sin(along / radius), np.sign(along) * radius)
    found = np.stack([x, col * cell - SIDE / 2.0, z], axis=-1)
    found[..., 2] += 0.5 * thickness - found[..., 2].min()
    return found


class Here:
    """The towel here."""

    def __init__(self, nodes: int, thickness: float, **values: Any) -> None:
        """Compile the shaders."""
        self._cloth = Simulation(Scene({
            'rows': nodes, 'cols': nodes, 'width': SIDE, 'height': SIDE, 'pins': ['none'],
            'areal_density': DENSITY, 'start.z': 0.0, 'stiffness.structural': 500.0,
            'stiffness.shear': 150.0, 'stiffness.bend': 0.0,
            'bending.rigidity': [2e-6, 2e-6], 'dt': 0.002,
            'gravity': list(ACCELERATION), 'contact.thickness': thickness,
            'colliders.names': ['floor'], 'colliders.floor.shape': 'plane',
            'colliders.floor.friction': FRICTION, 'self_contact.enabled': True,
            'self_contact.thickness': thickness, 'self_contact.friction': FRICTION, **values}))
        places = folded(nodes, thickness)
        self._cloth.set_state(places, np.zeros_like(places))
        self._cloth.step(1)

    def advance(self, end: float) -> None:
        """Simulate up to ``end`` [s]."""
        self._cloth.advance(end - self._cloth.time)
        self._cloth.finish()

    def positions(self) -> np.ndarray:
        """Return where the nodes are, (n, n, 3) [m]."""
        return self._cloth.positions()


_MODEL = """
<mujoco>
  <option timestep="{step}" solver="CG" iterations="100" tolerance="1e-6" cone="elliptic"
      gravity="{gravity}" integrator="{integrator}">
    <flag ipc="{ipc}"/>
  </option>
  <size memory="2G"/>
  <worldbody>
    <geom type="plane" size="2 2 0.1" friction="{friction} 0 0"/>
    <flexcomp name="towel" type="grid" dim="2" count="{nodes} {nodes} 1"
        spacing="{cell} {cell} {cell}" pos="0 0 0.1" mass="{mass}" radius="{radius}">
      <edge equality="true" solref="{constant} 1"/>
      <contact selfcollide="auto" condim="3" friction="{friction} 0 0" solref="{constant} 1"/>
    </flexcomp>
  </worldbody>
</mujoco>
"""


class MuJoCo(Flex):
    """
    The towel as a flex of MuJoCo.

    :param step: its time step [s]
    :param ipc: enable or disable, of the flag of that name
    """

    def __init__(self, nodes: int, thickness: float, step: float, ipc: str) -> None:
        """Compile the model, and fold the towel."""
        super().__init__(nodes, _MODEL.format(
            step=step, constant=2.0 * step, gravity=' '.join(map(str, ACCELERATION)), ipc=ipc,
            integrator='discrete' if ipc == 'enable' else 'Euler', friction=FRICTION,
            nodes=nodes, cell=SIDE / (nodes - 1), mass=DENSITY * SIDE**2,
            radius=0.5 * thickness))
        # Its coordinates are displacements from where the model has the nodes.
        self._data.qpos[:] = (folded(nodes, thickness) - self.positions()).ravel()


class Newton:
    """
    The towel in Newton, by vertex block descent on the CPU.

    :param step: its time step [s]
    :param iterations: of a step
    """

    def __init__(self, nodes: int, thickness: float, step: float, iterations: int) -> None:
        """Make the model, and fold the towel."""
        import newton
        import warp
        warp.config.quiet = True
        self._nodes, self._step, self._time = nodes, step, 0.0
        with warp.ScopedDevice('cpu'):
            builder = newton.ModelBuilder(gravity=ACCELERATION)
            cell = SIDE / (nodes - 1)
            builder.add_cloth_grid(
                pos=warp.vec3(0.0, 0.0, 0.0), rot=warp.quat_identity(), vel=warp.vec3(0.0),
                dim_x=nodes - 1, dim_y=nodes - 1, cell_x=cell, cell_y=cell,
                mass=DENSITY * SIDE**2 / nodes**2, tri_ke=1e3, tri_ka=1e3, tri_kd=1e-4,
                edge_ke=1e-4, edge_kd=1e-4, particle_radius=0.5 * thickness)
            floor = newton.ModelBuilder.ShapeConfig(mu=FRICTION)
            builder.add_ground_plane(cfg=floor)
            builder.color(include_bending=True)
            self._model = builder.finalize()
            self._model.soft_contact_ke, self._model.soft_contact_kd = 1e4, 1e-4
            self._model.soft_contact_mu = FRICTION
            self._solver = newton.solvers.SolverVBD(
                self._model, iterations=iterations, particle_enable_self_contact=True,
                particle_self_contact_margin=thickness,
                particle_self_contact_gap=0.5 * thickness)
            self._states = [self._model.state() for _ in range(2)]
            # Rows of the grid of Newton run along y.
            places = folded(nodes, thickness).reshape(-1, 3).astype(np.float32)
            for state in self._states:
                state.particle_q.assign(places)
            self._control = self._model.control()
            self._contacts = self._model.contacts()

    def advance(self, end: float) -> None:
        """Simulate up to ``end`` [s]."""
        while self._time < end - 1e-9:
            self._time += self._step
            first, second = self._states
            first.clear_forces()
            self._model.collide(first, self._contacts)
            self._solver.step(first, second, self._control, self._contacts, self._step)
            self._states.reverse()

    def positions(self) -> np.ndarray:
        """Return where the nodes are, (n, n, 3) [m]."""
        return self._states[0].particle_q.numpy().reshape(self._nodes, self._nodes, 3)


def layers_of(towel: Sheet) -> tuple[np.ndarray, np.ndarray]:
    """Return the mean places of the lower and of the upper half, without hem and fold [m]."""
    places = towel.positions().astype(float)
    part = len(places) // 4
    return places[:part].mean(axis=(0, 1)), places[-part:].mean(axis=(0, 1))


def measure(make: Callable[[], Sheet]) -> str:
    """Return the figures of a towel."""
    towel = make()
    towel.advance(SETTLED)
    before = layers_of(towel)
    begin = time.process_time()
    towel.advance(SETTLED + LONG)
    taken = (time.process_time() - begin) / LONG
    creep = [np.linalg.norm((now - then)[:2]) / LONG for now, then in zip(
        layers_of(towel), before)]
    places = towel.positions()
    passed = len(crossings(places)) if np.isfinite(places).all() else 'not finite'
    lower, upper = layers_of(towel)
    return (f'{taken:7.1f} s of a processor a simulated second, creep {1e6 * creep[0]:9.3g} and '
            f'{1e6 * creep[1]:9.3g} um/s, crossings {passed}, layers '
            f'{1e3 * (upper - lower)[2]:.2f} mm apart')


def main() -> None:
    """Print a line for each."""
    parser = ArgumentParser(description=__doc__.splitlines()[1])
    parser.add_argument('--nodes', type=int, default=24)
    parser.add_argument('--only', nargs='+', default=[''])
    given = parser.parse_args()
    nodes = given.nodes
    thickness = 0.25 * SIDE / (nodes - 1)
    takers: dict[str, Callable[[], Sheet]] = {
        'mass_spring': lambda: Here(nodes, thickness),
        'constraint': lambda: Here(nodes, thickness, mode='constraint', dt=0.005),
        'MuJoCo, 2 ms': lambda: MuJoCo(nodes, thickness, 0.002, 'disable'),
        'MuJoCo, 0.5 ms': lambda: MuJoCo(nodes, thickness, 0.0005, 'disable'),
        'MuJoCo, ipc, 2 ms': lambda: MuJoCo(nodes, thickness, 0.002, 'enable'),
        'Newton, 2 ms, 10 iterations': lambda: Newton(nodes, thickness, 0.002, 10)}
    print(f'{nodes} x {nodes}, thickness {1e3 * thickness:.2f} mm')
    for name, make in takers.items():
        if any(each in name for each in given.only):
            try:
                print(f'{name:30}{measure(make)}', flush=True)
            except ImportError as missing:
                print(f'{name:30}left out: {missing}')


if __name__ == '__main__':
    main()
