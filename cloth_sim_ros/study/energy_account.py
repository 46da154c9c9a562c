# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""Whether a moving cloth has more energy than it began with and was given."""

from collections.abc import Mapping
from collections.abc import Sequence
from itertools import combinations

from cloth_sim_ros.sim.contact.contacts import ContactForce
from cloth_sim_ros.sim.held.pin_forces import edge_pulls
from cloth_sim_ros.sim.model.cells import edge_shares
from cloth_sim_ros.sim.model.colliders import Collider
from cloth_sim_ros.sim.model.colliders import FACING
from cloth_sim_ros.sim.model.colliders import FACING_THIN
from cloth_sim_ros.sim.model.edge_kinds import EDGE_KINDS
from cloth_sim_ros.sim.model.edge_kinds import EdgeKind
from cloth_sim_ros.sim.model.pose import rotation_between
from cloth_sim_ros.sim.model.push import Push
from cloth_sim_ros.sim.modes import AVAILABLE
from cloth_sim_ros.sim.scene import FAMILIES
from cloth_sim_ros.sim.scene import Scene
from cloth_sim_ros.sim.simulation import Simulation
from cloth_sim_ros.sim.snapshot import POINT_DTYPE
from cloth_sim_ros.sim.snapshot import Snapshot
from cloth_sim_ros.sim.solver.edge_law import EdgeLaw
from cloth_sim_ros.sim.solver.edge_law import FAR
import numpy as np

# Parts of a side of a triangle that thin colliders press on [1].
_PARTS = 48


def contact_work(
        forces: Sequence[ContactForce], before: Sequence[Collider],
        after: Sequence[Collider]) -> float:
    """
    Return the work that colliders have done on the cloth in a step of dt [J].

    :param forces: on the colliders, the mean over the step
    :param before: the colliders as it began
    :param after: as it ended
    """
    work = 0.0
    for force, first, last in zip(forces, before, after):
        axis, angle = rotation_between(first.orientation, last.orientation)
        way = np.array(last.position) - np.array(first.position)
        work -= float(force.force @ way + angle * (force.torque @ axis))
    return work


def compression_energy(
        scene: Scene, colliders: Sequence[Collider], positions: np.ndarray) -> float:
    """
    Return the energy [J] of cloth that colliders facing each other compress.

    In explicit modes, thin colliders press on its triangles, others on its nodes.

    :param positions: (rows, cols, 3) [m]
    """
    thickness = scene['contact.thickness']
    positions = np.asarray(positions, dtype=float)
    compressed = 0.0
    areas = scene.node_mass * scene.node_shares / scene.mass_per_area
    thin = () if AVAILABLE[scene['mode']].is_implicit else scene.thin_colliders
    for first, second in combinations(range(len(colliders)), 2):
        pair = colliders[first], colliders[second]
        is_thin = first in thin or second in thin
        places, parts = (
            _near_parts(scene, pair, positions) if is_thin else (positions, areas))
        lacking = np.maximum(thickness - sum(body.distance(places) for body in pair), 0.0)
        if not lacking.any():
            continue
        # The surface of a thin one bends, so a place near the middle of the pressed part decides.
        least, places = (FACING_THIN, places[np.argmax(lacking)]) if is_thin else (
            FACING, places)
        normals = [body.normals(places) for body in pair]
        lacking *= np.sum(normals[0] * normals[1], axis=-1) < least
        # The pressure grows up to a whole thickness, and no further.
        growing = np.minimum(lacking, thickness)
        linear = 0.5 * growing**2 / thickness if thickness > 0.0 else 0.0
        compressed += float(np.sum(parts * (linear + lacking - growing)))
    return float(scene['contact.compression']) * compressed


def _near_parts(
        scene: Scene, pair: tuple[Collider, Collider],
        positions: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """
    Return the parts of triangles of the cloth that are near both of a pair of colliders.

    :returns: the middle of each part, (n, 3) [m], and its area, (n,) [m2]
    """
    right, below = positions[:-1, 1:], positions[1:, :-1]
    corners = np.stack([
        np.stack([apex, right, below], axis=2)[
            ... if scene.cut_cells is None else scene.cut_cells].reshape(-1, 3, 3)
        for apex in (positions[:-1, :-1], positions[1:, 1:])]).reshape(-1, 3, 3)
    middles = corners.mean(axis=1)
    reach = np.linalg.norm(corners - middles[:, None], axis=-1).max(axis=1)
    # Room falls by at most 2 m a metre.
    room = sum(body.distance(middles) for body in pair) - scene['contact.thickness']
    corners = corners[room < 2.0 * reach]
    sides = corners[:, 1:] - corners[:, :1]
    areas = 0.5 * np.linalg.norm(np.cross(sides[:, 0], sides[:, 1]), axis=-1)
    steps = np.arange(_PARTS)
    i, j = np.meshgrid(steps, steps, indexing='ij')
    weights = np.concatenate([
        np.stack([i + third, j + third], axis=-1)[i + j < _PARTS - flipped]
        for third, flipped in ((1.0 / 3.0, 0), (2.0 / 3.0, 1))]) / _PARTS
    places = corners[:, None, 0] + np.einsum('pk,tkx->tpx', weights, sides)
    parts = np.repeat(areas / _PARTS**2, len(weights))
    return places.reshape(-1, 3), parts


# Relative rounding of float32 [1], of two operations.
_ROUNDING = 2e-7


class EnergyAccount:
    """
    Balances the energy of a run with the work of loads, pins, grasps and colliders.

    In every mode velocities lag positions by half a substep, so the energy E oscillates:
    near the stability limit of springs by as much as there is, in an implicit mode by
    some percent at its longest substeps. Symplectic Euler conserves, exactly where forces are
    linear, H = E + h sum(m v . a) / 2. That is balanced, with length and tensions of the
    last substep, and the mean power of the air in the last step.

    The work of pins that move is that of the forces on them at the end of each step; that of a
    limit which closes in on a cloth that came stretched is found from the pulls at both ends of a
    step, or is the ``settling_work`` of impulses, which have no law.

    :param run: as it begins; it is stepped by ``step`` alone
    """

    def __init__(self, run: Simulation) -> None:
        """Record the energy at the start."""
        self._run = run
        self._is_symplectic = not AVAILABLE[run.mode].is_implicit
        self._is_limited = AVAILABLE[run.mode].edge_model(run.scene) == 'limited'
        self._has_pin_moves = bool(
            run.scene.timed_pin_moves() or run.scene.timed_grasp_moves())
        self._colliders = run.colliders
        self._pushed: dict[Push, np.ndarray] = {}
        self._work = 0.0
        self._air_work = 0.0
        # Mean power of the air on the cloth in the last step [W].
        self._air_power = 0.0
        run.loads.keep_account()
        self._substeps = 0
        self._law = run.engines.energy_law()
        self.seen = self._look()
        self.begin = self.seen
        self._begin_energy = self._energy(self.seen)
        self._begin_energy += self._uncertain(self.seen)
        self._most = self._begin_energy - self.seen.gravitational_energy
        self._gain = 0.0

    @property
    def gained(self) -> float:
        """Return the most energy from nothing so far, over the most that moved or was elastic."""
        # A gain within rounding is not counted.
        excess = self._gain - self._rounding()
        return excess / self._most if excess > 0.0 else 0.0

    @property
    def energy(self) -> float:
        """Return what symplectic Euler keeps, at present [J]."""
        return self._energy(self.seen)

    @property
    def air_work(self) -> float:
        """Return the work of the air on the cloth so far [J]."""
        return self._air_work

    @property
    def pushed(self) -> Mapping[Push, np.ndarray]:
        """Return the nodes of each push that has begun, (rows, cols) bool."""
        return self._pushed

    def step(self, count: int = 1) -> Snapshot:
        """Make ``count`` steps of dt; one at a time while something does work on the cloth."""
        done = 0
        while done < count:
            # A push that begins within these steps needs its nodes at its start.
            some = 1 if self._is_worked_on(count - done) else count - done
            self._step(some)
            done += some
        return self.seen

    def _step(self, count: int) -> None:
        before, begin = self.seen, self._run.time
        end = begin + count * self._run.dt
        pushed = self._pushed_between(begin, end, before)
        self._run.step(count)
        self._substeps += count * self._run.substeps
        now = self._look()
        moved = now.positions.astype(float) - before.positions
        for push, nodes in pushed:
            moved_under = _moved_under(push, (begin, end), (before, now))
            # It accelerates its nodes alike, so that each has of the force by its mass.
            shares = self._run.scene.node_shares[nodes]
            self._work += float(np.array(push.force) @ np.average(
                moved_under[nodes], axis=0, weights=shares))
        if self._has_pin_moves and now.pin_forces is not None:
            rows, cols = now.pin_forces.nodes.T
            self._work -= float(np.sum(now.pin_forces.forces * moved[rows, cols]))
        if self._colliders:
            colliders = self._run.colliders
            self._work += contact_work(self._run.contact_forces(), self._colliders, colliders)
            self._colliders = colliders
        law = self._run.engines.energy_law()
        self._work += _closing_work(
            self._run.scene, self._moving_edges(), (self._law, before.positions),
            (law, now.positions))
        if not (law.has_limits or self._law.has_limits):
            # Impulses that let a stretched cloth down to its limit, as the mode accounts for them.
            self._work += now.settling_work - before.settling_work
        self._law = law
        air_work = self._run.loads.work()
        self._work += air_work - self._air_work
        self._air_power = (air_work - self._air_work) / (end - begin)
        self._air_work = air_work
        self.seen = now
        energy = self._energy(now) - self._begin_energy
        self._gain = max(self._gain, energy - self._work) if now.finite else np.inf
        self._most = max(self._most, self._moving(now))

    def _pushed_between(
            self, begin: float, end: float, before: Snapshot) -> list[tuple[Push, np.ndarray]]:
        """Return each push that acts, and its nodes."""
        pushed = []
        for push in (applied.push for applied in self._run.pushes):
            if push.overlap(begin, end) <= 0.0:
                continue
            if push not in self._pushed:
                self._pushed[push] = push.contains(before.positions) & ~self._run.pinned_nodes()
            if self._pushed[push].any():
                pushed.append((push, self._pushed[push]))
        return pushed

    def _is_worked_on(self, steps: int) -> bool:
        begin, end = self._run.time, self._run.time + steps * self._run.dt
        can_limits_move = self._law.has_limits or self._is_limited
        is_handled = self._has_pin_moves or bool(self._colliders)
        return can_limits_move or is_handled or any(
            applied.push.overlap(begin, end) > 0.0 for applied in self._run.pushes)

    def _look(self) -> Snapshot:
        seen = self._run.snapshot(tension=True, pin_forces=self._has_pin_moves)
        if self._run.scene.has_gaps:
            # Nodes that are not there have no mass and no area: at rest they do no work.
            absent = ~self._run.scene.present_nodes
            for name in (POINT_DTYPE.names or ())[:-1]:
                seen.records[name][absent] = 0.0
        return seen

    def _energy(self, seen: Snapshot) -> float:
        return self._moving(seen) + seen.gravitational_energy

    def _moving(self, seen: Snapshot) -> float:
        energy = seen.kinetic_energy + seen.elastic_energy
        if self._colliders:
            energy += compression_energy(self._run.scene, self._colliders, seen.positions)
        return energy + self._half_a_step(seen)

    def _moving_edges(self) -> list[np.ndarray]:
        """Return, for each kind of edge, which have an end that can move."""
        pinned, size = self._run.pinned_nodes(), (self._run.scene.rows, self._run.scene.cols)
        return [~(pinned[starts] & pinned[ends]) for starts, ends in (
            kind.everywhere(*size) for kind in EDGE_KINDS)]

    def _uncertain(self, seen: Snapshot) -> float:
        """Return the uncertainty of the energy at the start [J]."""
        # The initial velocities are used as those of half a substep before.
        free, forces = self._forces(seen)
        kick = 0.5 * self._run.dt / self._run.substeps
        masses = self._masses(free)
        return 0.5 * kick**2 * float(np.sum(forces**2 / masses))

    def _half_a_step(self, seen: Snapshot) -> float:
        """Return h sum(m v . a) / 2 [J]."""
        free, forces = self._forces(seen)
        velocities = seen.velocities[tuple(free.T)].astype(float)
        power = float(np.sum(velocities * forces)) + self._air_power
        return 0.5 * self._run.engines.last_length() * power

    def _forces(self, seen: Snapshot) -> tuple[np.ndarray, np.ndarray]:
        """Return the free nodes, (n, 2), and the forces of gravity and edges on them [N]."""
        scene = self._run.scene
        free = np.argwhere(~self._run.pinned_nodes() & scene.present_nodes)
        assert seen.tension is not None  # the snapshots are taken with it
        pulls = edge_pulls(scene, seen.positions, seen.velocities, seen.tension, free)
        return free, pulls + self._masses(free) * np.array(scene['gravity'])

    def _masses(self, nodes: np.ndarray) -> np.ndarray:
        """Return the masses of ``nodes`` (n, 2), (n, 1) [kg]."""
        scene = self._run.scene
        return scene.node_mass * scene.node_shares[tuple(nodes.T)][:, None]

    def _rounding(self) -> float:
        scene = self._run.scene
        reach = _ROUNDING * float(np.abs(self.begin.positions).max())
        law = self._law.times(scene.node_mass)
        stiffest = max(law.stiffness)
        if law.has_bounds:
            stiffest += max(law.limit_stiffness)
        energy = 12.0 * stiffest * scene.node_count * reach**2
        if self._is_symplectic:
            # Without damping, the rounding of each substep adds up like a random walk.
            energy *= 1.0 + 0.01 * self._substeps
        else:
            # A substep of hard edges corrects the rounding of lengths, at this speed.
            speed = reach * self._run.substeps / scene['dt']
            energy += 0.5 * scene.mass * speed**2
        # In a short substep the displacement of a node can be below float32 rounding.
        weight = scene.mass * float(np.linalg.norm(scene['gravity']))
        energy += 0.3 * reach * weight * self._substeps
        return energy + 1e-6 * abs(self.begin.gravitational_energy)


def _moved_under(
        push: Push, times: tuple[float, float], seen: tuple[Snapshot, Snapshot]) -> np.ndarray:
    """
    Return how far nodes have moved while ``push`` acted between two ``times`` [m].

    On the cubic that has their positions and velocities at both times.
    """
    (begin, end), (before, now) = times, seen
    length = end - begin
    moved = now.positions.astype(float) - before.positions
    first, last = (length * each.velocities.astype(float) for each in seen)
    since, until = (
        min(max((time - begin) / length, 0.0), 1.0) for time in (push.start, push.end))
    return (
        first * (until - since) + (3.0 * moved - 2.0 * first - last) * (until**2 - since**2)
        + (first + last - 2.0 * moved) * (until**3 - since**3))


def _closing_work(
        scene: Scene, counted: list[np.ndarray], begin: tuple[EdgeLaw, np.ndarray],
        end: tuple[EdgeLaw, np.ndarray]) -> float:
    """
    Return the work [J] of limits that move between two laws, each with its positions.

    :param counted: of each kind, the edges whose work it is
    """
    work = 0.0
    for kind, some in zip(EDGE_KINDS, counted):
        family = FAMILIES.index(kind.family)
        for side in ('shortest', 'longest'):
            before, after = (getattr(law, side)[family] for law, _ in (begin, end))
            if before != after and all(0.0 < bound < FAR for bound in (before, after)):
                pull = 0.5 * sum(
                    _pull_of_limits(scene, kind, some, side, *each) for each in (begin, end))
                work += (after - before) * kind.rest_length(scene) * pull
    return work


def _pull_of_limits(
        scene: Scene, kind: EdgeKind, some: np.ndarray, side: str, law: EdgeLaw,
        positions: np.ndarray) -> float:
    """Return the summed forces of one side's limits of some edges of a kind [N]."""
    bound = getattr(law, side)[FAMILIES.index(kind.family)] * kind.rest_length(scene)
    sign = -1.0 if side == 'shortest' else 1.0
    past = sign * (_lengths(scene, kind, positions)[some] - bound)
    width = law.transition * kind.rest_length(scene)
    pull = np.maximum(past, 0.0)
    if width > 0.0:
        pull = np.where(np.abs(past) < width, (past + width)**2 / (4.0 * width), pull)
    shares = np.broadcast_to(edge_shares(scene.cells, kind), some.shape)[some]
    stiffness = scene.node_mass * law.limit_stiffness[kind.rest]
    return -sign * stiffness * float(np.sum(shares * pull))


def _lengths(scene: Scene, kind: EdgeKind, positions: np.ndarray) -> np.ndarray:
    starts, ends = kind.everywhere(scene.rows, scene.cols)
    return np.linalg.norm(positions[ends].astype(float) - positions[starts], axis=-1)
