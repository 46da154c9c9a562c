# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""The implicit step: each substep solves for the tensions of the edges."""

from abc import ABC
from abc import abstractmethod
from collections.abc import Collection
from dataclasses import dataclass
from dataclasses import replace
import math
from typing import Any

from cloth_sim_ros.sim.device.layout import Layout
from cloth_sim_ros.sim.device.observer import Observer
from cloth_sim_ros.sim.loads.forcing import Forcing
from cloth_sim_ros.sim.loads.loads import Loads
from cloth_sim_ros.sim.modes.edge_watch import TurnWatch
from cloth_sim_ros.sim.modes.free_motion import FreeMotion
from cloth_sim_ros.sim.modes.mode import CHECKED_SUBSTEPS
from cloth_sim_ros.sim.scene import FAMILIES
from cloth_sim_ros.sim.scene import Scene
from cloth_sim_ros.sim.solver.edge_law import BETA
from cloth_sim_ros.sim.solver.edge_law import EdgeLaw
from cloth_sim_ros.sim.solver.solver import Solver
from cloth_sim_ros.sim.state import State
from cloth_sim_ros.sim.stop import leave_if
from cloth_sim_ros.sim.stop import never
from cloth_sim_ros.sim.stop import Stop
import numpy as np

# Settling time over the square root of the cloth size [s / sqrt(m)]: the far end of a cloth that
# is stretched by a tenth accelerates by at most 6 x 0.1 size / time^2, 0.7 of gravity.
_SETTLING_TIME = 0.3
# Max. solves in the search for the active limits [1], beyond which solver_reached is false;
# chosen: same bits from 8 to 64, and 2 are too few (constants.py --only _MOST_SOLVES).
_MOST_SOLVES = 32
# Max. solves of a substep with contact [1]; chosen: final positions change by 0.3 % of the
# displacement from 8 to 64, by 2 % at 4 and 4 % at 2; the number of solves changes by -23 % at 2,
# -3 % at 4 and +0.3 % at 64 (constants.py --only _MOST_CONTACT_SOLVES).
_MOST_CONTACT_SOLVES = 8
# Solves of a substep after which friction may only slow nodes down, so that the iteration ends
# [1]; chosen: final positions change by 4 to 6 % of the displacement from 1 to 8, and by 3 % with
# half the tolerance; 1 takes 17 % more solves, 8 takes 8 % more
# (constants.py --only _MOST_CONTACT_TURNS).
_MOST_CONTACT_TURNS = 4
# Max. reported substep margin [1]; finite even where edges rotate instantly.
_LARGEST_MARGIN = 1e9
# Fraction of a substep that counts as rounding [1]: it adds no further substep.
_NOTHING = 1e-9
_NO_FORCING = Forcing((0.0, 0.0, 0.0))


class Settling:
    """
    A strain limit that shrinks to zero while a stretched cloth settles.

    A cloth may arrive stretched, for instance from soft springs. Enforcing hard edges at once
    would store a large energy in it from one step to the next and throw it together. Instead,
    edges are springs within the limit, which closes in over the settling time.

    ``is_new`` is True until the first strain is taken.

    :param notable: strain below which hard edges apply at once
    :param size: of the cloth [m]; the settling time is proportional to its square root, as is the
        time of a fall over this length
    """

    is_new: bool

    def __init__(self, notable: float, size: float) -> None:
        """Wait for a cloth."""
        self._notable = notable
        self._time = _SETTLING_TIME * math.sqrt(size)
        self.forget()

    @property
    def limit(self) -> float:
        """Return the present strain limit; 0 for hard edges."""
        left = 1.0 - min(self._age / self._time, 1.0)
        return self._first * left * left * (3.0 - 2.0 * left)

    def begin(self, strain: float) -> None:
        """Take the largest ``strain`` of a cloth; ignored unless it is new."""
        if self.is_new:
            self._first = self.first(strain)
        self.is_new = False

    def begin_anew(self, strain: float) -> None:
        """Restart from the largest ``strain`` of a cloth that another integrator has stepped."""
        self._first, self._age, self.is_new = strain, 0.0, False

    def first(self, strain: float) -> float:
        """Return the initial limit of a cloth with the largest ``strain``; 0 for none."""
        # NaN has no limit to settle from; the check of the state finds it.
        return strain if strain > self._notable else 0.0

    def advance(self, length: float) -> None:
        """Advance by ``length`` [s]."""
        if self._first:
            self._age += length
            if self._age >= self._time:
                self._first = 0.0

    def forget(self) -> None:
        """Wait for another cloth."""
        self._first = self._age = 0.0
        self.is_new = True


@dataclass(frozen=True)
class Newton:
    """
    How Newton's method is applied in a substep (docs/explanation/implicit_step.md).

    :param solves: linear solves, each linearised at the lengths found by the previous one
    :param foresees_turn: whether the first one accounts for the lengthening of rotating edges
    :param beta: fraction of the geometric stiffness of an edge [1]
    """

    solves: int
    foresees_turn: bool = True
    beta: float = BETA


class ImplicitStep(ABC):
    """
    The implicit step of docs/explanation/implicit_step.md, for any edge law; a base class.

    ``substeps`` is the number of substeps of the last dt, ``last_length`` the length of the last
    substep [s] or 0 before the first, ``settling`` the strain limit of a cloth that is settling.

    :param families: of edges in the scene
    :param notable: strain, as in Settling
    """

    # An implicit step is stable for any length.
    stability_limit = math.inf
    checked_substeps = CHECKED_SUBSTEPS
    last_length: float

    def __init__(
            self, scene: Scene, layout: Layout, families: Collection[str],
            notable: float) -> None:
        """Compile the solver."""
        families = tuple(family for family in FAMILIES if family in families)
        self._scene = scene
        self._dt: float = scene['dt']
        self._newton = self.newton(scene)
        self._solver = Solver(
            scene, layout, families=families, preconditioner=scene['solver.preconditioner'],
            tolerance=scene['solver.tolerance'], max_iterations=scene['solver.max_iterations'],
            foresees_turn=self._newton.foresees_turn)
        self._watch = TurnWatch(scene, layout, families)
        self._free_motion = FreeMotion(scene, layout)
        self.settling = Settling(notable, max(scene['width'], scene['height']))
        self._energies = Observer(scene, layout, set(families))
        # The law of the last substep, with its arguments.
        self._law: tuple[tuple[float, float], EdgeLaw] | None = None
        # First entry of held.glsl that the current substep writes; -1 for none.
        self._held_at = -1
        # Loads on single nodes in the current substep.
        self._forcing = _NO_FORCING
        # Whether the cloth is neither pinned nor touched at the beginning of the current substep,
        # and whether contact requires another solve.
        self._is_free = self._is_due = False
        self.forget()

    @staticmethod
    def newton(scene: Scene) -> Newton:
        """Return how Newton's method is applied."""
        return Newton(scene['constraint.newton_iterations'])

    @staticmethod
    def check(scene: Scene, *, check_stability: bool = True) -> None:
        """Accept every dt: an implicit step is always stable."""

    @abstractmethod
    def law(self, length: float, settling: float) -> EdgeLaw:
        """
        Return the law of the edges in a substep of ``length`` [s].

        :param settling: present strain limit of a cloth that is settling; otherwise 0
        """

    def energy_law(self, state: State) -> EdgeLaw:
        """Return the present law, or that of the first step of a new ``state``."""
        settling = self.settling.limit
        if self.settling.is_new:
            settling = self.settling.first(self.largest_strain(state))
        # The solver has no rows for pins, so edges between two pins are not solved for.
        return replace(self.law(self._dt, settling), acts_between_pins=False)

    def largest_strain(self, state: State) -> float:
        """Return the largest strain of structural and shear edges."""
        return self._watch.look(state, _NO_FORCING, self._dt)[1]

    def step(self, state: State, begin: float, loads: Loads, stop: Stop = never) -> None:
        """Advance ``state`` by one dt."""
        self.clear_tally()
        self.advance(state, begin, self._dt, loads, stop)

    def advance(
            self, state: State, begin: float, seconds: float, loads: Loads,
            stop: Stop = never) -> None:
        """Advance ``state`` by ``seconds``, one dt or the rest of it."""
        self._choose_substeps(
            state, loads.forcing(state, begin, begin + seconds), seconds,
            loads.air_margin(state, begin, begin + seconds, seconds))
        length = seconds / self.substeps
        for substep in range(self.substeps):
            self._make_substep(state, begin + substep * length, length, loads, stop)

    @staticmethod
    def step_ahead(state: State, gravity: Forcing, most: int) -> int:
        """Return 0: each step depends on the result of the previous one."""
        return 0

    def run_all_passes(self, state: State, loads: Loads, stop: Stop = never) -> None:
        """Run every pass once on a ``state`` that is discarded, held and free."""
        still = loads.still
        self._watch.look(state, still, self._dt)
        leave_if(stop)
        self._solver.set_law(self._present_law(self._dt))
        if still.touch is not None:
            self._solver.meet_colliders(state, still, self._dt)
            leave_if(stop)
        self._free_motion.aim_at(state, still, still, self._dt)
        leave_if(stop)
        self._held_at = state.next_held_entry()
        self._forcing = still
        self._solve_first(state, self._dt, stop)
        self._solve_further(state, self._dt, stop)
        # Hard edges have limits too, while a stretched cloth settles.
        self._solver.run_search(state)
        leave_if(stop)
        self._free_motion.restore(state, still, self._dt)
        self._stored(state, 0.0)
        self.forget()

    def forget(self) -> None:
        """Drop the memory of earlier steps; the next state may be stretched."""
        self.substeps = 1 if self._scene['auto_substeps'] else self._scene['substeps']
        self.substep_margin = 0.0
        self.last_length = 0.0
        # Passes of the last dt that did not find the active limits.
        self._unsettled = 0
        self.settling.forget()
        self._settled_from = self._settling_work = 0.0
        self._began_settling = False
        self._solver.forget()
        self._free_motion.forget()

    def resume(self, last_length: float) -> None:
        """Continue after another integrator whose last substep had ``last_length`` [s]."""
        self.last_length = last_length
        self._solver.expect_nothing()
        self._free_motion.forget()

    def clear_tally(self) -> None:
        """Reset the count of solves."""
        self._solver.clear_tally()
        self._unsettled = 0
        self._began_settling = self.is_settling

    def report(self) -> dict[str, Any]:
        """Return how the solves of the last dt ended."""
        tally = self._solver.tally()
        return {
            'solver_iterations': tally.most_iterations,
            'solver_residual': tally.worst_residual,
            'solver_reached': tally.unreached == 0 and self._unsettled == 0,
            'solves': tally.solves,
            'mean_iterations': tally.iterations / max(tally.solves, 1),
            **self.settling_report(),
        }

    def settling_report(self) -> dict[str, Any]:
        """Return whether the cloth was settling in the last dt, and the work of the limit."""
        return {
            'settling': self.is_settling or self._began_settling,
            'settling_work': self._settling_work}

    @property
    def is_settling(self) -> bool:
        """Return whether edges still have a wider limit than their own."""
        return self.settling.limit > 0.0

    def tension(
            self, positions: np.ndarray, velocities: np.ndarray,
            nodes: np.ndarray | None = None) -> np.ndarray:
        """Return the tension of each edge in the last substep [N], as solved for."""
        return self._solver.tensions()

    def delete(self) -> None:
        """Release everything."""
        self._solver.delete()
        self._watch.delete()
        self._free_motion.delete()
        self._energies.delete()

    def _account_for_settling(self, state: State) -> None:
        """Add the work of the limit while it closed in over the previous substep."""
        limit = self.settling.limit
        if limit != self._settled_from:
            # Nodes have not moved since, so the elastic energy changes by the limit alone.
            if self._settled_from:
                self._settling_work += (
                    self._stored(state, limit) - self._stored(state, self._settled_from))
            self._settled_from = limit

    def _stored(self, state: State, settling: float) -> float:
        """Return the elastic energy of ``state`` with the limit ``settling`` [J]."""
        law = replace(self.law(self._dt, settling), acts_between_pins=False)
        return self._energies.measure(state, _NO_FORCING, law).elastic_energy

    def _present_law(self, length: float) -> EdgeLaw:
        """Return the law of a substep of ``length`` [s]; mostly that of the previous one."""
        asked = length, self.settling.limit
        if self._law is None or self._law[0] != asked:
            self._law = asked, self.law(*asked)
        return self._law[1]

    def _choose_substeps(
            self, state: State, forcing: Forcing, seconds: float, air_margin: float) -> None:
        longest, strain = self._watch.look(state, forcing, seconds)
        self.settling.begin(strain)
        if self._scene['auto_substeps']:
            # An extreme push rotates edges instantly.
            wanted = seconds / longest - _NOTHING if longest > 0.0 else math.inf
            wanted = max(wanted, air_margin - _NOTHING)
            most = self._scene['constraint.max_substeps']
            # NaN gives the maximum as well.
            self.substeps = most
            if wanted < most:
                self.substeps = min(self._scene['refine'] * max(1, math.ceil(wanted)), most)
        self.substep_margin = min(
            seconds / self.substeps / max(longest, 1e-30), _LARGEST_MARGIN)

    def _make_substep(
            self, state: State, start: float, length: float, loads: Loads, stop: Stop) -> None:
        """Advance ``state`` by a substep of ``length`` [s]."""
        kick = self._kick(length)
        forcing = loads.forcing(state, start, start + length, kick)
        self._begin_substep(state, forcing, loads, length, kick, stop)
        self._solve_further(state, kick, stop)
        self._end_substep(state, loads, length)

    def _kick(self, length: float) -> float:
        """Return the time [s] for which forces act in a substep of ``length`` [s]."""
        # A velocity belongs to the middle of its substep, so forces act from there to the next.
        return 0.5 * ((self.last_length or length) + length)

    def _begin_substep(
            self, state: State, forcing: Forcing, loads: Loads, length: float, kick: float,
            stop: Stop) -> None:
        """Make the first solve of a substep, for edges and colliders."""
        self._account_for_settling(state)
        self._solver.set_law(self._present_law(length))
        self._held_at = state.next_held_entry()
        touch = forcing.touch
        if touch is not None:
            touch.begin_substep()
            self._solver.meet_colliders(state, forcing, kick)
        # A node held by a collider has no momentum of its own.
        self._is_free = not (
            state.pinned.any() or (touch is not None and touch.is_touched()))
        self._forcing = _uneven(forcing) if self._is_free else forcing
        if self._is_free:
            self._free_motion.aim_at(state, forcing, loads.still, kick)
            self._solve_first(state, kick, stop, _common(forcing, kick))
        else:
            self._free_motion.forget()
            self._solve_first(state, kick, stop)

    def _end_substep(self, state: State, loads: Loads, length: float) -> None:
        """Finish a substep that has been solved."""
        touch = self._forcing.touch
        if self._is_free:
            if touch is not None and touch.is_touched():
                self._free_motion.forget()
            else:
                self._free_motion.restore(state, loads.still, length)
        self.last_length = length
        self.settling.advance(length)

    def _solve_first(
            self, state: State, kick: float, stop: Stop,
            common_change: tuple[float, float, float] = (0.0, 0.0, 0.0)) -> None:
        """Move the nodes by the first solve of the substep, and apply contact."""
        self._solve(state, self._forcing, stop, kick=kick)
        self._solver.apply(state, common_change=common_change)
        self._is_due = self._resolve_contacts(state, self._forcing, 1)

    def _solve_further(self, state: State, kick: float, stop: Stop) -> None:
        """Correct the result of the first solve, until no further solve is required."""
        solves = 1
        while self._is_solve_due(state, solves):
            if not self._solve(state, self._forcing, stop, kick=kick, is_further=True):
                break
            self._solver.apply(state, further=True)
            solves += 1
            self._is_due = self._resolve_contacts(state, self._forcing, solves)
        if self._forcing.touch is not None:
            self._solver.resolve_contacts(
                state, self._forcing, is_last=True, held_at=self._held_at)

    def _is_solve_due(self, state: State, solves: int) -> bool:
        """Return whether another solve is required after this many."""
        return solves < self._newton.solves or (
            self._is_due and solves < _MOST_CONTACT_SOLVES)

    def _resolve_contacts(self, state: State, forcing: Forcing, solves: int) -> bool:
        """Apply contact to the solution; return whether that requires another solve."""
        if forcing.touch is None:
            return False
        self._solver.resolve_contacts(
            state, forcing, ends_turns=solves >= _MOST_CONTACT_TURNS)
        # A start within the tolerance stays within it after a solve, unless a contact changed.
        return forcing.touch.is_solve_due(
            is_exact=solves > self._newton.solves and self._solver.had_nothing_to_do())

    def _solve(
            self, state: State, forcing: Forcing, stop: Stop,
            **how: Any) -> bool:
        """Solve once; return whether there was anything to solve for."""
        for count in range(_MOST_SOLVES):
            leave_if(stop)
            if not self._solver.prepare(
                    state, forcing, is_again=count > 0, may_stop_early=True, **how):
                return False
            self._solver.iterate(stop)
            is_last = count == _MOST_SOLVES - 1
            if not self._solver.move_start(state, is_last=is_last):
                break
            self._unsettled += is_last
        self._solver.record_held(
            state, forcing, how['kick'], self._held_at,
            is_further=how.get('is_further', False))
        self._solver.find_tensions()
        return True


def _uneven(forcing: Forcing) -> Forcing:
    """
    Return what accelerates some nodes only.

    What moves a free cloth as a whole leaves its edges as they are, so the solver, which stops at
    a residual, need not find it.
    """
    return replace(forcing, everywhere=(0.0, 0.0, 0.0))


def _common(forcing: Forcing, kick: float) -> tuple[float, float, float]:
    """Return the change of velocity that all nodes have in common [m/s]."""
    x, y, z = forcing.everywhere
    return kick * x, kick * y, kick * z
