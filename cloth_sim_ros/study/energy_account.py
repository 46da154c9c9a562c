# Copyright 2026 the cloth_sim_ros authors
#
# Licensed under the Apache License, Version 2.0 (the "License");
# you may not use this file except in compliance with the License.
# You may obtain a copy of the License at
#
#     http://www.apache.org/licenses/LICENSE-2.0
#
# Unless required by applicable law or agreed to in writing, software
# distributed under the License is distributed on an "AS IS" BASIS,
# WITHOUT WARRANTIES OR CONDITIONS OF ANY KIND, either express or implied.
# See the License for the specific language governing permissions and
# limitations under the License.

"""Whether a moving cloth has more energy than it began with and was given."""

from collections.abc import Mapping

from cloth_sim_ros.reference.energy import elastic_energy
from cloth_sim_ros.reference.springs import spring_sets
from cloth_sim_ros.sim.modes import AVAILABLE
from cloth_sim_ros.sim.pin_forces import pin_forces
from cloth_sim_ros.sim.push import Push
from cloth_sim_ros.sim.scene import FAMILIES
from cloth_sim_ros.sim.simulation import Simulation
from cloth_sim_ros.sim.snapshot import Snapshot
import numpy as np

# What float32 rounds of a number, twice.
_ROUNDING = 2e-7


class EnergyAccount:
    """
    Keeps the books of a run: its energy, and the work that pushes and moving pins do.

    Symplectic Euler has its velocities half a substep before its positions, so its energy swings
    to and fro near the stability limit by as much as there is. What it keeps, exactly where forces
    are linear, is H = E + h sum(m v . a) / 2: that is what is accounted for in the modes that step
    so.

    In an implicit mode it is the energy itself, and hard edges hold none.

    The work of pins that move is that of the forces on them at the end of each step.

    :param run: as it begins; it is stepped by ``step`` alone
    """

    def __init__(self, run: Simulation) -> None:
        """Take down the energy at the start."""
        self._run = run
        self._is_symplectic = not AVAILABLE[run.mode].is_implicit
        self._has_pin_moves = bool(run.scene.timed_pin_moves())
        self._pushed: dict[Push, np.ndarray] = {}
        self._work = 0.0
        self._substeps = 0
        self.seen = self._look()
        self.begin = self.seen
        self._begin_energy = self._energy(self.seen)
        self._begin_energy += self._uncertain(self.seen)
        self._most = self._begin_energy - self.seen.gravitational_energy
        self._gain = 0.0

    @property
    def gained(self) -> float:
        """Return the most energy from nothing so far, over the most that moved or was elastic."""
        # What rounding alone may add is no gain.
        excess = self._gain - self._rounding()
        return excess / self._most if excess > 0.0 else 0.0

    @property
    def pushed(self) -> Mapping[Push, np.ndarray]:
        """Return the nodes of each push that has begun, (rows, cols) bool."""
        return self._pushed

    def step(self, count: int = 1) -> Snapshot:
        """Make ``count`` steps of dt; one at a time while something does work on the cloth."""
        done = 0
        while done < count:
            # A push that begins within the steps to come needs its nodes as they are by then.
            some = 1 if self._is_worked_on(count - done) else count - done
            self._step(some)
            done += some
        return self.seen

    def _step(self, count: int) -> None:
        before, begin = self.seen, self._run.time
        shares = self._shares(begin, begin + count * self._run.dt, before)
        self._run.step(count)
        self._substeps += count * self._run.substeps
        now = self._look()
        moved = now.positions.astype(float) - before.positions
        for nodes, force in shares:
            self._work += float(force @ moved[nodes].mean(axis=0))
        if self._has_pin_moves and now.pin_forces is not None:
            rows, cols = now.pin_forces.nodes.T
            self._work += float(np.sum(now.pin_forces.forces * moved[rows, cols]))
        self.seen = now
        energy = self._energy(now) - self._begin_energy
        self._gain = max(self._gain, energy - self._work) if now.finite else np.inf
        self._most = max(self._most, self._moving(now))

    def _shares(
            self, begin: float, end: float,
            before: Snapshot) -> list[tuple[np.ndarray, np.ndarray]]:
        """Return the nodes of each push that acts, and its force [N] for the share it acts in."""
        shares = []
        for push in (applied.push for applied in self._run.pushes):
            share = push.overlap(begin, end)
            if share <= 0.0:
                continue
            if push not in self._pushed:
                self._pushed[push] = push.contains(before.positions) & ~self._run.pinned_nodes()
            if self._pushed[push].any():
                shares.append((self._pushed[push], share * np.array(push.force)))
        return shares

    def _is_worked_on(self, steps: int) -> bool:
        begin, end = self._run.time, self._run.time + steps * self._run.dt
        return self._has_pin_moves or any(
            applied.push.overlap(begin, end) > 0.0 for applied in self._run.pushes)

    def _look(self) -> Snapshot:
        return self._run.snapshot(tension=self._is_symplectic, pin_forces=self._has_pin_moves)

    def _energy(self, seen: Snapshot) -> float:
        return self._moving(seen) + seen.gravitational_energy

    def _moving(self, seen: Snapshot) -> float:
        energy = seen.kinetic_energy + seen.elastic_energy
        return energy + self._half_a_step(seen) if self._is_symplectic else energy

    def _uncertain(self, seen: Snapshot) -> float:
        """Return the energy [J] that the state at the start may have besides what it tells."""
        if not self._is_symplectic:
            # Edges that are off their length are springs until their limit has closed in.
            stretched = (springs for springs in spring_sets(self._run.scene)
                         if springs.family in self._run.scene['constraint.hard'])
            return elastic_energy(tuple(stretched), seen.positions.astype(float))
        # What is set as the velocity now is taken as that of half a substep ago.
        free, forces = self._forces(seen)
        kick = 0.5 * self._run.dt / self._run.substeps / self._run.scene.node_mass
        return 0.5 * self._run.scene.node_mass * kick**2 * float(np.sum(forces**2))

    def _half_a_step(self, seen: Snapshot) -> float:
        """Return h sum(m v . a) / 2 [J]."""
        free, forces = self._forces(seen)
        velocities = seen.velocities[tuple(free.T)].astype(float)
        return 0.5 * self._run.dt / seen.substeps * float(np.sum(velocities * forces))

    def _forces(self, seen: Snapshot) -> tuple[np.ndarray, np.ndarray]:
        """Return the free nodes, (n, 2), and the forces of gravity and edges on them [N]."""
        free = np.argwhere(~self._run.pinned_nodes())
        # What would hold a node still is the opposite of the force on it.
        held = pin_forces(
            self._run.scene, seen.positions, seen.tension, free, np.zeros((len(free), 3)))
        return free, -held.forces

    def _rounding(self) -> float:
        scene = self._run.scene
        reach = _ROUNDING * float(np.abs(self.begin.positions).max())
        springs = FAMILIES if self._is_symplectic else scene['constraint.springs']
        stiffest = max((scene.stiffness(family) for family in springs), default=0.0)
        energy = 12.0 * stiffest * scene.node_count * reach**2
        if self._is_symplectic:
            # Without damping, what each substep rounds adds up like a random walk.
            energy *= 1.0 + 0.01 * self._substeps
        else:
            # What float32 rounds of a length, a substep of hard edges takes back.
            speed = reach * self._run.substeps / scene['dt']
            energy += 0.5 * scene.node_mass * scene.node_count * speed**2
        return energy + 1e-6 * abs(self.begin.gravitational_energy)
