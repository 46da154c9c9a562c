# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""The scenes of comparison.py in Newton, by vertex block descent on the CPU."""

from typing import Any

import numpy as np
from peers.gripped import BOX
from peers.gripped import BOX_MASS
from peers.gripped import CELL
from peers.gripped import GAP
from peers.gripped import GRAVITY
from peers.gripped import Grip
from peers.gripped import hanging
from peers.gripped import level
from peers.gripped import PAD
from peers.gripped import pad_center
from peers.gripped import THICKNESS
from peers.gripped import THROWN_MASS
from peers.gripped import THROWN_SIDE
from peers.gripped import THROWN_SPEED

STEP = 0.002  # [s]


class Sheet:
    """
    A sheet, and what its model has besides.

    :param builder: with all bodies and shapes
    :param places: where the nodes begin, (n, n, 3) [m]
    :param stiffness: of contacts [N/m]
    :param options: of SolverVBD, its iterations among them
    """

    def __init__(
            self, builder: Any, places: np.ndarray, cell: float, mass: float, speed: float,
            stiffness: float, friction: float, **options: Any) -> None:
        """Make the model."""
        import newton
        import warp
        self._nodes, self._time, self._mass = len(places), 0.0, mass
        builder.add_cloth_grid(
            pos=warp.vec3(0.0, 0.0, 0.0), rot=warp.quat_identity(), vel=warp.vec3(0.0),
            dim_x=self._nodes - 1, dim_y=self._nodes - 1, cell_x=cell, cell_y=cell,
            mass=mass / self._nodes**2, tri_ke=1e3, tri_ka=1e3, tri_kd=1e-4, edge_ke=1e-4,
            edge_kd=1e-4, particle_radius=0.5 * THICKNESS)
        builder.color(include_bending=True)
        self._model = builder.finalize(device='cpu')
        self._model.soft_contact_ke, self._model.soft_contact_kd = stiffness, 1e-4
        self._model.soft_contact_mu = friction
        self._solver = newton.solvers.SolverVBD(self._model, **options)
        self._states = [self._model.state() for _ in range(2)]
        # Rows of the grid of Newton run along y, from the lowest.
        flat = np.ascontiguousarray(places[::-1].reshape(-1, 3), dtype=np.float32)
        velocities = np.zeros_like(flat)
        velocities[:, 2] = -speed
        for state in self._states:
            state.particle_q.assign(flat)
            state.particle_qd.assign(velocities)
        self._control = self._model.control()
        self._contacts = self._model.contacts()

    def advance(self, end: float) -> None:
        """Simulate up to ``end`` [s]."""
        while self._time < end - 1e-9:
            self._time += STEP
            first, second = self._states
            first.clear_forces()
            self._model.collide(first, self._contacts)
            self._solver.step(first, second, self._control, self._contacts, STEP)
            self._states.reverse()

    def positions(self) -> np.ndarray:
        """Return where the nodes are, (nodes, nodes, 3) [m]."""
        places = self._states[0].particle_q.numpy()
        return places.reshape(self._nodes, self._nodes, 3)[::-1].copy()


def _builder(gravity: float) -> Any:
    import newton
    import warp
    warp.config.quiet = True
    return newton.ModelBuilder(gravity=(0.0, 0.0, gravity))


def _shape(friction: float, stiffness: float, density: float) -> Any:
    import newton
    return newton.ModelBuilder.ShapeConfig(
        mu=friction, ke=stiffness, kd=1e-4, density=density)


class PinchedNewton(Sheet):
    """The sheet between pads."""

    def __init__(self, grip: Grip, iterations: int) -> None:
        """Make the model."""
        import warp
        builder = _builder(-GRAVITY)
        # A node is pressed in by a quarter of the thickness on each side.
        stiffness = grip.normal / (0.5 * (THICKNESS - GAP))
        for side in (-1.0, 1.0):
            builder.add_shape_box(
                -1, xform=warp.transform(warp.vec3(*pad_center(side)), warp.quat_identity()),
                hx=0.5 * PAD[0], hy=0.5 * PAD[1], hz=0.5 * PAD[2],
                cfg=_shape(grip.friction, stiffness, 0.0))
        super().__init__(
            builder, hanging(), CELL, grip.mass, 0.0, stiffness, grip.friction,
            iterations=iterations)

    def lift(self) -> None:
        """Return None: the solver reports no force of a sheet on a shape at rest."""


class ThrownNewton(Sheet):
    """
    The sheet that hits a free box.

    :param capacity: most contacts of the box with the sheet
    """

    def __init__(self, nodes: int, iterations: int, capacity: int) -> None:
        """Make the model."""
        import warp
        builder = _builder(0.0)
        body = builder.add_body(xform=warp.transform(
            warp.vec3(0.0, 0.0, -0.5 * BOX[2]), warp.quat_identity()))
        builder.add_shape_box(
            body, hx=0.5 * BOX[0], hy=0.5 * BOX[1], hz=0.5 * BOX[2],
            cfg=_shape(0.5, 1e3, BOX_MASS / float(np.prod(BOX))))
        super().__init__(
            builder, level(nodes), THROWN_SIDE / (nodes - 1), THROWN_MASS, THROWN_SPEED, 1e3,
            0.5, iterations=iterations, rigid_body_particle_contact_buffer_size=capacity)

    def momenta(self) -> tuple[float, float]:
        """Return the vertical momentum of the sheet, and what the box has got [N s]."""
        speeds = self._states[0].particle_qd.numpy()[:, 2].astype(float)
        return (float(self._mass / len(speeds) * speeds.sum()),
                float(BOX_MASS * self._states[0].body_qd.numpy()[0, 2]))
