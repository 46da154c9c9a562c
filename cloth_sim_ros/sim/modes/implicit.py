# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""The implicit step: the tensions that edges have by their law are solved for in each substep."""

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

# Time in which a limit closes in, over the root of the size of the cloth [s / sqrt(m)]: the far
# end of one that comes longer by a tenth has at most 6 x 0.1 size / time^2, 0.7 of gravity.
_SETTLING_TIME = 0.3
# Max. solves of a pass that finds the limits in force [1], beyond which solver_reached is false;
# chosen: same bits from 8 to 64, and 2 do not suffice (constants.py --only _MOST_SOLVES).
_MOST_SOLVES = 32
# Max. solves of a substep that finds what touches colliders [1]; chosen: nodes move by 0.3 % of
# their way from 8 to 64, by 2 % at 4 and 4 % at 2; solves go from -23 % at 2 and -3 % at 4 to
# +0.3 % at 64 (constants.py --only _MOST_CONTACT_SOLVES).
_MOST_CONTACT_SOLVES = 8
# Solves of a substep after which friction only resists, so that turns end [1]; chosen: nodes move
# by 4 to 6 % of their way from 1 to 8, by half the tolerance 3 %; 1 takes 17 % more solves, 8
# takes 8 % more (constants.py --only _MOST_CONTACT_TURNS).
_MOST_CONTACT_TURNS = 4
# Max. substep margin that is reported [1]; a finite number where edges turn at once.
_LARGEST_MARGIN = 1e9
# Fraction of a substep that is taken for rounding [1]: no further substep is made for it.
_NOTHING = 1e-9
_NO_FORCING = Forcing((0.0, 0.0, 0.0))


class Settling:
    """
    The strain within which hard edges are springs yet, for a while.

    ``is_new`` says that no strain has been taken yet.

    A cloth can come stretched from where nothing limited it. Its energy is that of springs: held
    at once, it would have that of hard edges from nothing, and be thrown together.

    :param notable: strain up to which it is held at once
    :param size: of the cloth [m]: the time is that in which a cloth falls a share of its size, so
        that cloths of all sizes move alike
    """

    is_new: bool

    def __init__(self, notable: float, size: float) -> None:
        """Wait for a cloth."""
        self._notable = notable
        self._time = _SETTLING_TIME * math.sqrt(size)
        self.forget()

    @property
    def limit(self) -> float:
        """Return the strain limit that holds now; 0 for hard edges."""
        left = 1.0 - min(self._age / self._time, 1.0)
        return self._first * left * left * (3.0 - 2.0 * left)

    def begin(self, strain: float) -> None:
        """Take the largest ``strain`` of a cloth; only that of a new one counts."""
        if self.is_new:
            self._first = self.first(strain)
        self.is_new = False

    def begin_anew(self, strain: float) -> None:
        """Begin with the largest ``strain`` of a cloth that comes from another integrator."""
        self._first, self._age, self.is_new = strain, 0.0, False

    def first(self, strain: float) -> float:
        """Return the limit that a cloth of the largest ``strain`` begins with; 0 for none."""
        # NaN has no limit to settle from; the check of the state finds it.
        return strain if strain > self._notable else 0.0

    def advance(self, length: float) -> None:
        """Go on by ``length`` [s]."""
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

    :param solves: linear solves, each with the lengths that the one before has found
    :param foresees_turn: whether the first one allows for how much longer edges get by turning
    :param beta: share of the geometric stiffness of an edge [1]
    """

    solves: int
    foresees_turn: bool = True
    beta: float = BETA


class ImplicitStep(ABC):
    """
    The implicit step of docs/explanation/implicit_step.md, for any edge law; a base class.

    ``substeps`` are those of the last dt, ``last_length`` is that of the last one [s], 0 where
    none was, ``settling`` is the strain that a new cloth may have for a while.

    :param families: of edges that there are
    :param notable: as of Settling
    """

    # An implicit step is stable whatever its length.
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
        # In the substep under way: first entry of held.glsl that it writes, below 0 for none; the
        # loads on single nodes; whether the cloth is free, neither pinned nor touched as it
        # begins; and whether colliders ask for another solve.
        self._held_at = -1
        self._forcing = _NO_FORCING
        self._is_free = self._is_due = False
        self.forget()

    @staticmethod
    def newton(scene: Scene) -> Newton:
        """Return how Newton's method is applied."""
        return Newton(scene['constraint.newton_iterations'])

    @staticmethod
    def check(scene: Scene, *, check_stability: bool = True) -> None:
        """Raise nothing: there is no dt that is too long."""

    @abstractmethod
    def law(self, length: float, settling: float) -> EdgeLaw:
        """
        Return the law of the edges in a substep of ``length`` [s].

        :param settling: strain that a cloth which came stretched may have yet; else 0
        """

    def energy_law(self, state: State) -> EdgeLaw:
        """Return the law that holds now, or that the first step of a new ``state`` will have."""
        settling = self.settling.limit
        if self.settling.is_new:
            settling = self.settling.first(self.largest_strain(state))
        # The solver has no row for a pin: an edge between two of them is solved for by neither.
        return replace(self.law(self._dt, settling), acts_between_pins=False)

    def largest_strain(self, state: State) -> float:
        """Return the largest strain of structural and shear edges."""
        return self._watch.look(state, _NO_FORCING, self._dt)[1]

    def step(self, state: State, begin: float, loads: Loads, stop: Stop = never) -> None:
        """Step ``state`` on by one dt."""
        self.clear_tally()
        self.advance(state, begin, self._dt, loads, stop)

    def advance(
            self, state: State, begin: float, seconds: float, loads: Loads,
            stop: Stop = never) -> None:
        """Step ``state`` on by ``seconds``, one dt or what is left of it."""
        self._choose_substeps(
            state, loads.forcing(state, begin, begin + seconds), seconds,
            loads.air_margin(state, begin, begin + seconds, seconds))
        length = seconds / self.substeps
        for substep in range(self.substeps):
            self._make_substep(state, begin + substep * length, length, loads, stop)

    @staticmethod
    def step_ahead(state: State, gravity: Forcing, most: int) -> int:
        """Return 0: each step goes by what the one before has found."""
        return 0

    def run_all_passes(self, state: State, loads: Loads, stop: Stop = never) -> None:
        """Make a substep of a ``state`` that nobody needs, held and free."""
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
        # Hard edges of a cloth that comes stretched have limits for a while, too.
        self._solver.run_search(state)
        leave_if(stop)
        self._free_motion.restore(state, still, self._dt)
        self._stored(state, 0.0)
        self.forget()

    def forget(self) -> None:
        """Drop what was kept from earlier steps; the next state may be stretched."""
        self.substeps = 1 if self._scene['auto_substeps'] else self._scene['substeps']
        self.substep_margin = 0.0
        self.last_length = 0.0
        # Passes of the last dt that have not found the limits in force.
        self._unsettled = 0
        self.settling.forget()
        self._settled_from = self._settling_work = 0.0
        self._began_settling = False
        self._solver.forget()
        self._free_motion.forget()

    def resume(self, last_length: float) -> None:
        """Go on after substeps that another integrator made, the last of ``last_length`` [s]."""
        self.last_length = last_length
        self._solver.expect_nothing()
        self._free_motion.forget()

    def clear_tally(self) -> None:
        """Begin to count solves anew."""
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
        """Return whether a limit has closed in during the last dt, and the work it has done."""
        return {
            'settling': self.is_settling or self._began_settling,
            'settling_work': self._settling_work}

    @property
    def is_settling(self) -> bool:
        """Return whether edges have a wider limit than their own yet."""
        return self.settling.limit > 0.0

    def tension(
            self, positions: np.ndarray, velocities: np.ndarray,
            nodes: np.ndarray | None = None) -> np.ndarray:
        """Return what each edge pulled with in the last substep [N], as it was solved for."""
        return self._solver.tensions()

    def delete(self) -> None:
        """Release everything."""
        self._solver.delete()
        self._watch.delete()
        self._free_motion.delete()
        self._energies.delete()

    def _account_for_settling(self, state: State) -> None:
        """Add the work of a limit that has closed in by the length of the substep before."""
        limit = self.settling.limit
        if limit != self._settled_from:
            # The nodes have not moved since: what edges store changes by the limit alone.
            if self._settled_from:
                self._settling_work += (
                    self._stored(state, limit) - self._stored(state, self._settled_from))
            self._settled_from = limit

    def _stored(self, state: State, settling: float) -> float:
        """Return what the edges of ``state`` store within the limit ``settling`` [J]."""
        law = replace(self.law(self._dt, settling), acts_between_pins=False)
        return self._energies.measure(state, _NO_FORCING, law).elastic_energy

    def _present_law(self, length: float) -> EdgeLaw:
        """Return the law of a substep of ``length`` [s]; most are like the one before."""
        asked = length, self.settling.limit
        if self._law is None or self._law[0] != asked:
            self._law = asked, self.law(*asked)
        return self._law[1]

    def _choose_substeps(
            self, state: State, forcing: Forcing, seconds: float, air_margin: float) -> None:
        longest, strain = self._watch.look(state, forcing, seconds)
        self.settling.begin(strain)
        if self._scene['auto_substeps']:
            # Nodes that are pushed absurdly turn their edges at once.
            wanted = seconds / longest - _NOTHING if longest > 0.0 else math.inf
            wanted = max(wanted, air_margin - _NOTHING)
            most = self._scene['constraint.max_substeps']
            # NaN becomes the maximum, too.
            self.substeps = most
            if wanted < most:
                self.substeps = min(self._scene['refine'] * max(1, math.ceil(wanted)), most)
        self.substep_margin = min(
            seconds / self.substeps / max(longest, 1e-30), _LARGEST_MARGIN)

    def _make_substep(
            self, state: State, start: float, length: float, loads: Loads, stop: Stop) -> None:
        """Step ``state`` on by a substep of ``length`` [s]."""
        kick = self._kick(length)
        forcing = loads.forcing(state, start, start + length, kick)
        self._begin_substep(state, forcing, loads, length, kick, stop)
        self._solve_further(state, kick, stop)
        self._end_substep(state, loads, length)

    def _kick(self, length: float) -> float:
        """Return for how long [s] forces act in a substep of ``length`` [s]."""
        # A velocity belongs to the middle of its substep, so forces act from there to the next.
        return 0.5 * ((self.last_length or length) + length)

    def _begin_substep(
            self, state: State, forcing: Forcing, loads: Loads, length: float, kick: float,
            stop: Stop) -> None:
        """Find what edges and colliders do in a substep, in a first solve."""
        self._account_for_settling(state)
        self._solver.set_law(self._present_law(length))
        self._held_at = state.next_held_entry()
        touch = forcing.touch
        if touch is not None:
            touch.begin_substep()
            self._solver.meet_colliders(state, forcing, kick)
        # What a collider holds has no momentum of its own.
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
        """Go on from a substep that was solved for."""
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
        """Move the nodes by a first solve of the substep, and let colliders act."""
        self._solve(state, self._forcing, stop, kick=kick)
        self._solver.apply(state, common_change=common_change)
        self._is_due = self._resolve_contacts(state, self._forcing, 1)

    def _solve_further(self, state: State, kick: float, stop: Stop) -> None:
        """Correct what the first solve has led to, until no further one is due."""
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
        """Return whether another solve is to follow on so many."""
        return solves < self._newton.solves or (
            self._is_due and solves < _MOST_CONTACT_SOLVES)

    def _resolve_contacts(self, state: State, forcing: Forcing, solves: int) -> bool:
        """Let colliders act on what was solved; return whether another solve is due for it."""
        if forcing.touch is None:
            return False
        self._solver.resolve_contacts(
            state, forcing, ends_turns=solves >= _MOST_CONTACT_TURNS)
        # What began within the tolerance is within it after a solve, unless a node has turned.
        return forcing.touch.is_solve_due(
            is_exact=solves > self._newton.solves and self._solver.had_nothing_to_do())

    def _solve(
            self, state: State, forcing: Forcing, stop: Stop,
            **how: Any) -> bool:
        """Find the solution of a pass, and return whether there was anything to solve for."""
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
    """Return what the velocities of all nodes change by [m/s]."""
    x, y, z = forcing.everywhere
    return kick * x, kick * y, kick * z
