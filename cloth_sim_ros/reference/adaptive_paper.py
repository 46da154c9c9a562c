# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""The paper's adaptive scheme: a spring within the limit, a hard edge at rest length beyond."""

from cloth_sim_ros.reference.cloth import ReferenceCloth
from cloth_sim_ros.reference.edge_law import LIMITED
from cloth_sim_ros.reference.edges import edges_of
from cloth_sim_ros.sim.scene import Scene
from cloth_sim_ros.sim.stability import choose_substeps
import numpy as np
from scipy import sparse
from scipy.sparse.linalg import splu


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
            # Of Phi = |d|^2 - L0^2, over |J| = 2 l: the paper's constraint, with unit rows.
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
