# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""Cloths stepped by symplectic Euler: mass-spring, and the adaptive scheme of the paper."""

from cloth_sim_ros.reference.cloth import ReferenceCloth
from cloth_sim_ros.reference.edge_law import LIMITED
from cloth_sim_ros.reference.edges import edges_of
from cloth_sim_ros.reference.forces import air_forces
from cloth_sim_ros.sim.model.stability import choose_substeps
from cloth_sim_ros.sim.scene import Scene
import numpy as np
from scipy import sparse
from scipy.sparse.linalg import splu


class MassSpringReference(ReferenceCloth):
    """
    One cloth and its state.

    Each substep of length h does v += h (g + a_push + F / m), then x += h v, on free nodes.

    :param scene: what is modelled; its timed pushes act at their times
    :param substeps: substeps in each dt; the scene's own choice when not given
    """

    def __init__(self, scene: Scene, substeps: int | None = None) -> None:
        """Start at rest in the scene's start pose."""
        super().__init__(scene)
        self._edges = edges_of(scene)
        self.substeps = substeps or self._substeps_of_scene()

    def accelerations(self, positions: np.ndarray, velocities: np.ndarray) -> np.ndarray:
        """Return g + F / m, 0 at pinned nodes [m/s2]; no pushes and no air."""
        forces = self._edges.spring_forces(positions.reshape(-1, 3), velocities.reshape(-1, 3))
        if self.scene.has_rigidity:
            forces += self.bending.forces(positions).reshape(-1, 3)
            forces += self.bending.damping_forces(positions, velocities).reshape(-1, 3)
        forces *= self.inverse_masses[:, None]
        return self.gravity * self.free[..., None] + forces.reshape(positions.shape)

    def right_hand_side(self, t: float, state: np.ndarray) -> np.ndarray:
        """
        Return d(state)/dt of the same cloth in continuous time, for scipy's solve_ivp.

        :param t: not used: pushes and gusts are steps in time, which such a solver cannot cross
        :param state: positions then velocities, flat
        """
        positions, velocities = state.reshape(2, *self.positions.shape)
        moving = velocities * self.free[..., None]
        wind = np.array(self.scene['air.wind'])
        air = air_forces(self.scene, positions, moving, wind) * self._over_mass
        accelerations = self.accelerations(positions, moving) + air * self.free[..., None]
        return np.concatenate((moving.ravel(), accelerations.ravel()))

    def _substeps_of_scene(self) -> int:
        return choose_substeps(self.scene) if self.scene['auto_substeps'] else (
            self.scene['substeps'])

    def _step_of_dt(self) -> None:
        for substep in range(self.substeps):
            begin = (self.steps + substep / self.substeps) * self.dt
            end = (self.steps + (substep + 1) / self.substeps) * self.dt
            self._substep(begin, end)

    def _substep(self, begin: float, end: float) -> None:
        acceleration = self.accelerations(self.positions, self.velocities)
        acceleration += self._load_accelerations(begin, end)
        self.velocities += (end - begin) * acceleration
        self.positions += (end - begin) * self.velocities


class PaperAdaptiveReference(ReferenceCloth):
    """
    The scheme to compare with: it is known to fail at larger steps.

    Its explicit springs have their own stability limit, and an edge that passes the limit is
    pulled all the way to rest length within one step.

    :param scene: what is modelled; its timed pushes act at their times
    :param limit: the strain beyond which an edge is a constraint, if not the scene's
    :param delta: regularisation of the constraints, over the sum of their inverse masses
    """

    def __init__(self, scene: Scene, limit: float | None = None, delta: float = 1e-3) -> None:
        """Start at rest in the scene's start pose."""
        super().__init__(scene)
        self.limit: float = scene['adaptive.threshold'] if limit is None else limit
        self.delta = delta
        self.edges = edges_of(scene)
        weights = self.inverse_masses
        self.weight_sums = weights[self.edges.first] + weights[self.edges.second]
        self.limited = self.edges.of(LIMITED) & (self.weight_sums > 0.0)
        self.substeps: int = (
            choose_substeps(scene) if scene['auto_substeps'] else scene['substeps'])

    def max_strain(self) -> float:
        """Return the largest |l / L0 - 1| of the limited edges."""
        strains = np.abs(self.edges.strains(self._flat_positions))
        return float(np.max(strains[self.limited], initial=0.0))

    def held(self) -> np.ndarray:
        """Return which edges are beyond the limit, and so constraints, bool."""
        strains = np.abs(self.edges.strains(self._flat_positions))
        return self.limited & (strains > self.limit)

    @property
    def _flat_positions(self) -> np.ndarray:
        return self.positions.reshape(-1, 3)

    def _step_of_dt(self) -> None:
        h = self.dt / self.substeps
        for substep in range(self.substeps):
            begin = self.steps * self.dt + substep * h
            self._substep(begin, begin + h)

    def _substep(self, begin: float, end: float) -> None:
        h = end - begin
        edges = self.edges
        start = self._flat_positions
        directions = edges.directions(start)
        lengths = edges.lengths(start)
        error = lengths - edges.rest_length
        active = self.held()
        springs = ~active
        rate = np.sum(edges.differences(self.velocities.reshape(-1, 3)) * directions, axis=1)
        tension = springs * (edges.stiffness * error + edges.damping * rate)
        forces = -edges.scatter(tension[:, None] * directions, len(start))
        bending = self.bending.forces(self.positions)
        forces += (bending + self.bending.damping_forces(
            self.positions, self.velocities)).reshape(-1, 3)
        velocities = self.velocities + h * (
            self._applied_accelerations(begin, end)
            + (self.inverse_masses[:, None] * forces).reshape(self.positions.shape))
        if active.any():
            # The paper's constraint Phi = |d|^2 - L0^2, divided by |J| = 2 l to have unit rows.
            squares = (lengths[active]**2 - edges.rest_length[active]**2) / (
                2.0 * lengths[active])
            jacobian = edges.jacobian(directions, len(start))[active]
            residual = squares / h**2 + jacobian @ velocities.ravel() / h
            inverse_mass = np.repeat(self.inverse_masses, 3)
            matrix = (jacobian @ sparse.diags(inverse_mass) @ jacobian.T
                      + sparse.diags(self.delta * self.weight_sums[active]))
            pull = jacobian.T @ splu(matrix.tocsc()).solve(residual)
            velocities = velocities - h * (inverse_mass * pull).reshape(velocities.shape)
        self.velocities = velocities
        self.positions = self.positions + h * velocities
