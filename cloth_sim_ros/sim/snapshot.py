# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""A look at the simulation at one instant: plain arrays and numbers, no GL."""

from dataclasses import dataclass
import hashlib
import math

from cloth_sim_ros.sim.held.pin_forces import PinForces
from cloth_sim_ros.sim.mesh import Mesh
from cloth_sim_ros.sim.mesh import mesh_of_nodes
import numpy as np

# One node as the shader packs it: the body of a sensor_msgs/PointCloud2.
POINT_DTYPE = np.dtype([
    (name, np.float32) for name in (
        'x', 'y', 'z', 'vx', 'vy', 'vz', 'normal_x', 'normal_y', 'normal_z', 'strain')
] + [('flags', np.uint32)])

# Strain of hard edges that is reported [1]: six times that of one that carries the whole cloth.
_MOST_HARD_STRAIN = 0.05
# Strain over its limit that is reported [1]: an edge that carries the whole cloth has 1.1.
_MOST_OVER_BOUND = 1.2

FLAG_PINNED = 1
FLAG_AT_LIMIT = 2
FLAG_PUSHED = 4
FLAG_TOUCHING = 8
FLAG_GRASPED = 16  # and pinned, as all nodes that are held
# There is no cell to the lower right, within the lattice; set at all nodes that are not there.
FLAG_GAP = 32


def present_cells(flags: np.ndarray) -> np.ndarray:
    """Return which cells there are between nodes with ``flags``, (rows - 1, cols - 1) bool."""
    return (flags[:-1, :-1] & FLAG_GAP) == 0


@dataclass(frozen=True)
class Measures:
    """
    Summary values of the state.

    :param kinetic_energy: of the free nodes [J]
    :param elastic_energy: of the edges, in the model of the current mode [J]
    :param gravitational_energy: [J], zero at the origin
    :param max_strain: largest abs(l / L0 - 1) of structural and shear edges
    :param finite: False when a position or velocity is not a finite number
    """

    kinetic_energy: float
    elastic_energy: float
    gravitational_energy: float
    max_strain: float
    finite: bool

    @property
    def total_energy(self) -> float:
        """Return the kinetic, elastic and gravitational energy [J]."""
        return self.kinetic_energy + self.elastic_energy + self.gravitational_energy


@dataclass(frozen=True, kw_only=True)
class Snapshot(Measures):
    """
    The complete state at one time.

    :param records: (rows, cols) of POINT_DTYPE
    :param time: simulated [s]
    :param steps: of dt since the start or the last reset
    :param dt: [s]
    :param substeps: in each dt
    :param stability_margin: substep over the stability limit, or, in an implicit step, over the
        longest in which edges turn by no more than they should
    :param strain_bound: what no structural or shear edge should be stretched or shortened beyond
        in the present mode, 0 for hard edges
    :param settling: True while a cloth that came with more strain than the mode allows is held to
        a wider limit, which closes in (docs/explanation/implicit_step.md)
    :param settling_work: that this limit has done since then [J]: the energy of the run has
        changed by it
    :param solver_iterations: most of a solve in the last step, 0 in a mode without a solver
    :param solver_residual: relative, where the worst solve of the last step stopped
    :param solver_reached: False when a solve of the last step stopped before the residual asked
        for
    :param solves: linear solves in the last step, 0 in a mode without a solver
    :param mean_iterations: of these solves
    :param active_constraints: springs at their limit
    :param active_fraction: of all springs
    :param constraint_switches: activations and deactivations in the last step
        (docs/explanation/adaptive.md)
    :param calm_substeps: of the last step, in which no edge came near its limit; this and the
        next five are those of mode adaptive, and 0 in other modes
    :param listed_substeps: of the last step, in which only the edges near their limit were
        solved for, in rounds
    :param whole_substeps: of the last step, in which the whole cloth was solved for
    :param listed_edges: most edges near their limit that a substep of the last step solved for; 0
        where there were none, or the whole cloth was solved for
    :param limit_rounds: most rounds that such a substep took
    :param limit_unreached: substeps of the last step whose rounds did not suffice for the
        tolerance
    :param stalled_pins: moving pins that stood still in the last step, as edges pulled at them
        with more than ``pin.max_force``
    :param air_margin: a substep over the longest in which air acts on a pinned cloth with all its
        force; 0 where it is below 1 without doubt
    :param sticking_nodes: that touched a collider in the last step and had its velocity
    :param sliding_nodes: that touched a collider in the last step and moved along it
    :param deepest_node: how far a node is inside a collider at most [m]
    :param self_contacts: most pairs of a node and a triangle, or of two edges, that touched or
        were about to in a substep of the last step
    :param layer_overlap: how much nearer than ``self_contact.thickness`` layers came in the last
        step, over that; 0 where they did not
    :param cut_nodes: whose way was cut short in the last step, so that nothing passed
    :param largest_cut: of their ways [m]
    :param halved_substeps: of the last step, made again in halves as ways would have been cut by
        more
    :param surface_contact_held: False if the cloth passes through itself, layers are nearer than
        half their thickness, a way was cut by more than 0.02 of a cell, a contact of edges or
        faces with a thin collider was lost, or a node is inside a collider by more than 1e-6 m
        where no other one presses it in, or both overlap
    :param tension: if requested, of the edges that start at each node [N], (rows, cols, 6)
        float32, above 0 where it pulls: of node (r, c) to (r, c + 1), (r + 1, c), (r + 1, c + 1),
        (r + 1, c - 1), (r, c + 2) and (r + 2, c); 0 where there is no such edge
    :param pin_forces: if requested, the reaction force at each pinned node
    """

    records: np.ndarray
    mode: str
    time: float
    steps: int
    dt: float
    substeps: int
    stability_margin: float
    strain_bound: float = math.inf
    settling: bool = False
    settling_work: float = 0.0
    solver_iterations: int = 0
    solver_residual: float = 0.0
    solver_reached: bool = True
    solves: int = 0
    mean_iterations: float = 0.0
    active_constraints: int = 0
    active_fraction: float = 0.0
    constraint_switches: int = 0
    calm_substeps: int = 0
    listed_substeps: int = 0
    whole_substeps: int = 0
    listed_edges: int = 0
    limit_rounds: int = 0
    limit_unreached: int = 0
    stalled_pins: int = 0
    air_margin: float = 0.0
    sticking_nodes: int = 0
    sliding_nodes: int = 0
    deepest_node: float = 0.0
    self_contacts: int = 0
    layer_overlap: float = 0.0
    cut_nodes: int = 0
    largest_cut: float = 0.0
    halved_substeps: int = 0
    surface_contact_held: bool = True
    tension: np.ndarray | None = None
    pin_forces: PinForces | None = None

    @property
    def lengths_are_held(self) -> bool:
        """
        Return whether no edge is beyond the strain bound by more than is to be expected.

        That is a strain of 0.05 for hard edges, 1.2 times the limit otherwise; also while
        ``settling``.
        """
        return not self.max_strain > (
            _MOST_OVER_BOUND * self.strain_bound if self.strain_bound else _MOST_HARD_STRAIN)

    @property
    def strain_over_bound(self) -> float:
        """Return ``max_strain / strain_bound``; 0 in a mode without a limit of strain."""
        has_limit = 0.0 < self.strain_bound < math.inf
        return self.max_strain / self.strain_bound if has_limit else 0.0

    @property
    def positions(self) -> np.ndarray:
        """Return positions [m], (rows, cols, 3) float32."""
        return self._vectors(0)

    @property
    def velocities(self) -> np.ndarray:
        """Return velocities [m/s], (rows, cols, 3) float32; a pinned node has its pin's."""
        return self._vectors(3)

    @property
    def normals(self) -> np.ndarray:
        """Return unit normals, up for a cloth that lies flat, (rows, cols, 3) float32."""
        return self._vectors(6)

    @property
    def strain(self) -> np.ndarray:
        """Return the largest abs(l / L0 - 1) at each node, (rows, cols) float32."""
        return self.records['strain']

    @property
    def flags(self) -> np.ndarray:
        """Return FLAG_PINNED, _AT_LIMIT, _PUSHED ... of each node, (rows, cols) uint32."""
        return self.records['flags']

    @property
    def state_sha256(self) -> str:
        """Return a hash of positions and velocities; bitwise identical states have the same."""
        digest = hashlib.sha256(np.ascontiguousarray(self.positions).tobytes())
        digest.update(np.ascontiguousarray(self.velocities).tobytes())
        return digest.hexdigest()

    def mesh(self) -> Mesh:
        """Return the surface as triangles, without what a shape cuts away."""
        return mesh_of_nodes(self.positions, self.normals, present_cells(self.flags))

    def _vectors(self, first: int) -> np.ndarray:
        words = self.records.view(np.float32).reshape(*self.records.shape, -1)
        return words[..., first:first + 3]
