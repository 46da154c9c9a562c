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

"""Constraint enforcement: edges keep their length by tensions solved for in each substep."""

from dataclasses import replace
import math

from cloth_sim_ros.gl.buffer import Buffer
from cloth_sim_ros.sim.forcing import Forcing
from cloth_sim_ros.sim.layout import Layout
from cloth_sim_ros.sim.modes.free_motion import FreeMotion
from cloth_sim_ros.sim.modes.hardening import Hardening
from cloth_sim_ros.sim.modes.mode import Pieces
from cloth_sim_ros.sim.modes.rest_offsets import RestOffsets
from cloth_sim_ros.sim.modes.turn_watch import TurnWatch
from cloth_sim_ros.sim.push_field import PushField
from cloth_sim_ros.sim.scene import FAMILIES
from cloth_sim_ros.sim.scene import Scene
from cloth_sim_ros.sim.solver.edge_law import edge_law
from cloth_sim_ros.sim.solver.edge_law import EdgeLaw
from cloth_sim_ros.sim.solver.solver import Solver
from cloth_sim_ros.sim.state import State
import numpy as np

# Of a substep: rounding that is no reason for another one.
_NOTHING = 1e-9
# Of the stable substep: when it shrinks below the first from one dt to the next, edges are being
# caught, and it is taken to shrink as much again, but not below the second.
_CAUGHT, _LEAST_SHARE = 0.8, 0.6
# Iterations submitted in a dt, for each that a solve of the last dt has needed, and besides.
_MORE, _AT_LEAST = 3, 15


class Constraint:
    """
    The linearised step of docs/numerics_implicit.md; ``substeps`` are those of the last dt.

    ``stability_limit`` [s] follows from the tensions of the last dt; it is a bound on the safe
    side, infinite without any.
    """

    name = 'constraint'

    def __init__(self, scene: Scene, layout: Layout, *, check_stability: bool = True) -> None:
        """Compile the solver for the edges the scene asks for."""
        self._scene = scene
        self._dt: float = scene['dt']
        self._most_iterations: int = scene['solver.max_iterations']
        self._solves: int = scene['constraint.newton_iterations']
        self.spring_families = tuple(
            family for family in scene.families if family in scene['constraint.springs'])
        families = tuple(
            family for family in FAMILIES
            if family in scene['constraint.hard'] or family in self.spring_families)
        self._solver = Solver(
            scene, layout, families=families, preconditioner=scene['solver.preconditioner'],
            tolerance=scene['solver.tolerance'],
            max_iterations=self._most_iterations,
            foresees_turn=self._solves > 1, keeps_tension=True,
            has_damping=any(
                scene.damping(family) > 0.0 for family in scene['constraint.springs']))
        self._watch = TurnWatch(scene, layout, families, self._solver.tensions)
        self._free_motion = FreeMotion(scene, layout)
        self._hardening = Hardening(scene['constraint.hardening_time'])
        self._offsets = RestOffsets(
            scene, layout, scene['constraint.hard'], scene['constraint.hardening_time'],
            self._solver.tensions)
        self.forget()

    @staticmethod
    def check(scene: Scene, *, check_stability: bool = True) -> None:
        """Raise nothing: there is no dt that is too long."""

    def step(self, state: State, begin: float, pushes: PushField) -> Pieces:
        """Step ``state`` on by one dt."""
        self._submit_enough()
        misfit = self._choose_substeps(state, pushes.forcing(begin, begin + self._dt))
        length = self._dt / self.substeps
        self._hardening.see(misfit / length, misfit)
        law = self._law(length)
        self._solver.set_law(law)
        self._offsets.take_up(state, law)
        is_held = bool(state.pinned.any())
        for substep in range(self.substeps):
            start = begin + substep * length
            forcing = pushes.forcing(start, start + length)
            if is_held:
                yield from self._substep(state, forcing)
            else:
                self._free_motion.aim_at(state, forcing, pushes.still, length)
                yield from self._substep(state, *_split(forcing, length))
                self._free_motion.restore(state, pushes.still, length)
            self._offsets.spend(length)
        self._hardening.spend(self._dt)

    def run_all_passes(self, state: State, pushes: PushField) -> Pieces:
        """Make a substep of a ``state`` that nobody needs, held and free."""
        still = pushes.still
        self._watch.look(state, still, self._dt)
        yield
        # Offsets are made when edges become stiffer.
        for length in (self._dt, 0.5 * self._dt):
            self._offsets.take_up(state, self._law(length))
        yield
        self._solver.set_law(self._law(self._dt))
        self._free_motion.aim_at(state, still, still, self._dt)
        yield
        yield from self._substep(state, still)
        self._free_motion.restore(state, still, self._dt)
        self.forget()

    def forget(self) -> None:
        """Take the next state as it comes, stretched or not."""
        self.substeps = 1 if self._scene['auto_substeps'] else self._scene['substeps']
        self.stability_limit = math.inf
        self._limit_before = math.inf
        self._solver.forget()
        self._free_motion.forget()
        self._hardening.forget()
        self._offsets.forget()
        self._solver.submit(self._most_iterations)

    def report(self) -> dict[str, float]:
        """Return how the solves of the last dt ended."""
        tally = self._solver.tally()
        return {
            'solver_iterations': tally.most_iterations,
            'solver_residual': tally.worst_residual,
            'solver_reached': tally.unreached == 0,
        }

    def limit_marks(self) -> Buffer | None:
        """Return None: an edge has no limit to come to, it is a constraint always."""

    def tension(
            self, positions: np.ndarray, velocities: np.ndarray,
            nodes: np.ndarray | None = None) -> np.ndarray:
        """Return what holds each edge in the last substep [N], the Lagrange multipliers."""
        return self._solver.tensions.read()

    def delete(self) -> None:
        """Give everything back."""
        self._solver.delete()
        self._watch.delete()
        self._free_motion.delete()

    def _submit_enough(self) -> None:
        # Iterations that the device then leaves out cost the host some time each, so there are
        # not many more of them than the last dt has needed.
        tally = self._solver.tally()
        enough = _MORE * tally.most_iterations + _AT_LEAST
        if tally.unreached or tally.most_iterations == 0:
            enough = self._most_iterations
        self._solver.submit(min(enough, self._most_iterations))
        self._solver.clear_tally()

    def _choose_substeps(self, state: State, forcing: Forcing) -> float:
        turning, self.stability_limit, misfit = self._watch.look(state, forcing, self._dt)
        if self._scene['auto_substeps']:
            longest = min(turning, self._foresee_limit())
            # Nodes that are pushed absurdly turn their edges at once.
            wanted = self._dt / longest - _NOTHING if longest > 0.0 else math.inf
            most = self._scene['constraint.max_substeps']
            # What is no number becomes the most, too.
            self.substeps = most
            if wanted < most:
                self.substeps = min(self._scene['refine'] * max(1, math.ceil(wanted)), most)
        return misfit

    def _foresee_limit(self) -> float:
        before, self._limit_before = self._limit_before, self.stability_limit
        if self.stability_limit < _CAUGHT * before < math.inf:
            return self.stability_limit * max(self.stability_limit / before, _LEAST_SHARE)
        return self.stability_limit

    def _law(self, length: float) -> EdgeLaw:
        return edge_law(
            self._scene, length, hard=self._scene['constraint.hard'],
            springs=self._scene['constraint.springs'], delta=self._scene['constraint.delta'],
            hardness=self._hardening.hardness)

    def _substep(
            self, state: State, forcing: Forcing,
            common_change: tuple[float, float, float] = (0.0, 0.0, 0.0)) -> Pieces:
        share = self._offsets.share(self._dt / self.substeps)
        # No piece ends before forces have been read: a look at the state may change their buffer.
        self._solver.assemble(state)
        self._solver.make_right_side(state, forcing, share)
        yield from self._solver.solve_in_pieces()
        self._solver.apply(state, common_change=common_change)
        yield
        for _ in range(self._solves - 1):
            self._solver.assemble(state)
            yield
            self._solver.make_later_right_side(share)
            yield from self._solver.solve_in_pieces()
            self._solver.apply(state, further=True)
            yield


def _split(forcing: Forcing, length: float) -> tuple[Forcing, tuple[float, float, float]]:
    """
    Return what accelerates some nodes only, and what all velocities change by [m/s].

    What moves a free cloth as a whole leaves its edges as they are, so the solver, which stops at
    a residual, need not find it.
    """
    return (
        replace(forcing, everywhere=(0.0, 0.0, 0.0)),
        tuple(length * part for part in forcing.everywhere))
