# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""Adaptive: springs within a strain limit, constraints at it (paper, section 4.3)."""

from collections.abc import Collection
import math
from typing import Any
from typing import Protocol

from cloth_sim_ros.gl.buffer import Buffer
from cloth_sim_ros.gl.buffer import shader_writes_visible
from cloth_sim_ros.sim.device import bindings
from cloth_sim_ros.sim.device.layout import Layout
from cloth_sim_ros.sim.device.scene_program import SceneProgram
from cloth_sim_ros.sim.held.pin_forces import spring_tension
from cloth_sim_ros.sim.loads.forcing import Forcing
from cloth_sim_ros.sim.loads.loads import Loads
from cloth_sim_ros.sim.model.edge_kinds import EDGE_KINDS
from cloth_sim_ros.sim.model.stability import spring_substeps
from cloth_sim_ros.sim.model.stability import stability_limit
from cloth_sim_ros.sim.modes.edge_watch import StrainWatch
from cloth_sim_ros.sim.modes.implicit import ImplicitStep
from cloth_sim_ros.sim.modes.mass_spring import OnePass
from cloth_sim_ros.sim.modes.mode import CHECKED_SUBSTEPS
from cloth_sim_ros.sim.scene import Scene
from cloth_sim_ros.sim.solver.edge_law import edge_law
from cloth_sim_ros.sim.solver.edge_law import EdgeLaw
from cloth_sim_ros.sim.solver.edge_law import spring_law
from cloth_sim_ros.sim.state import State
from cloth_sim_ros.sim.stop import leave_if
from cloth_sim_ros.sim.stop import never
from cloth_sim_ros.sim.stop import Stop
import numpy as np

# Families with a strain limit. The length of a bend spring is not a strain of the cloth.
LIMITED = ('structural', 'shear')
# Strain past its limit of an edge that carries the whole cloth, over the limit, and at most [1];
# chosen: half of it holds a thrown cloth to 1.29 of its limit instead of 1.51, with 6 % more
# solves; a quarter to 1.17, with 22 % more (constants.py --only _SHARE _MOST).
_SHARE = 0.1
_MOST = 0.002
# Strain before its limit at which it begins to pull, over that past it [1]; chosen: solves change
# by +7 % at 0 (a kink) and by 0 % at 2 (constants.py --only _TRANSITION).
_TRANSITION = 1.0
# Predicted strain at which an edge is near its limit, over the limit [1], or that at which the
# limit begins to pull if it is lower; chosen: same bits from 0.9 to 1 where springs come to their
# limit at once; a cloth that swings takes 8 % fewer solves at 1 (constants.py --only _NEAR).
_NEAR = 0.9
# Predicted strain below which edges are left to their springs again, over that at which the limit
# begins to pull [1]; chosen: same strain from 0.5 to 1, solves change by +3 to -4 %, and by 5 % at
# 0, where limited substeps have no end (constants.py --only _FAR).
_FAR = 8.0 / 9.0
# Strain at which an edge that was at its limit counts as let go, over the limit [1], and steps
# without any edge at its limit after which all count so [1]: definitions of a count, no results.
_RELEASE = 0.5
_FADING_STEPS = 8
# Fraction of a dt that is taken for rounding [1].
_NOTHING = 1e-9
# Invocations of a workgroup of limit_mark.comp along a row and a column [1], as in Strips.
_LOCAL = (16, 2)
# First bit in a mark of the edges that are held, engaged, and were engaged one step before.
_HELD = 0
_ENGAGED = 4
_BEFORE = 8
# Bits of the edges of one cell [1]: four.
_EDGES = 0xF


def strain_past_limit(scene: Scene) -> float:
    """Return the strain by which an edge that carries the whole cloth passes its limit."""
    return min(_SHARE * scene['adaptive.threshold'], _MOST)


def transition_of(scene: Scene) -> float:
    """Return the strain before a limit from which on it comes into force."""
    return _TRANSITION * strain_past_limit(scene)


def onset_of(scene: Scene) -> float:
    """Return the strain from which on the limit pulls."""
    return float(scene['adaptive.threshold'] - transition_of(scene))


class LimitedSprings(ImplicitStep):
    """
    Springs of ``families`` with the scene's ``adaptive.threshold``.

    A cloth that comes with more strain than the limit leaves it under its weight is held to that,
    which closes in. Nothing pulls at first, as its energy is that of springs.
    """

    def __init__(self, scene: Scene, layout: Layout, families: Collection[str]) -> None:
        """Compile the solver."""
        self._families = families
        super().__init__(
            scene, layout, families,
            notable=scene['adaptive.threshold'] + strain_past_limit(scene))

    @property
    def strain_bound(self) -> float:
        """Return the strain limit."""
        return float(self._scene['adaptive.threshold'])

    @property
    def is_settling(self) -> bool:
        """Return whether the limit that holds now is a wider one."""
        return self._limit(self.settling.limit) > self.strain_bound

    def law(self, length: float, settling: float) -> EdgeLaw:
        """Return the law of springs with their limit, or what is left of the strain they had."""
        return edge_law(
            self._scene, length, springs=self._families, limited=LIMITED,
            limit=self._limit(settling),
            strain=strain_past_limit(self._scene), transition=transition_of(self._scene),
            geometric=self._newton.beta)

    def spend_calm(self, seconds: float) -> None:
        """Go on by ``seconds`` in which no edge came near its limit."""
        self.settling.advance(seconds)
        # It has closed in on nothing.
        self._settled_from = self.settling.limit

    def pulls_in(self, state: State) -> bool:
        """Return whether the limit pulls at some edge of a new ``state``."""
        return self.largest_strain(state) > onset_of(self._scene)

    def _limit(self, settling: float) -> float:
        return max(
            self._scene['adaptive.threshold'],
            settling + transition_of(self._scene) if settling else 0.0)


# Which edges are at their limit at the end of a step, and which were one step before.


class LimitMarks:
    """
    The marks of limit_mark.comp; nothing is done for a cloth that has none.

    :param onset: strain from which on the limit pulls
    """

    def __init__(self, scene: Scene, layout: Layout, onset: float) -> None:
        """Allocate the marks; the pass is compiled when it is first needed."""
        self._layout = layout
        self._onset = onset
        self._program = SceneProgram('limit_mark.comp', scene, layout, {
            'LOCAL_X': _LOCAL[0], 'LOCAL_Y': _LOCAL[1]})
        self._groups = -(-layout.cols // _LOCAL[0]), -(-layout.rows // _LOCAL[1])
        self._edges = sum(
            max(scene.rows - abs(kind.drow), 0) * max(scene.cols - abs(kind.dcol), 0)
            for kind in EDGE_KINDS
            if kind.family in LIMITED and scene.models(kind.family))
        self._marks = np.zeros(layout.stored, dtype=np.uint32)
        self.buffer = Buffer(self._marks)
        # Steps until the marks are all zero again. In the last but one all edges are let go.
        self._fading = 0

    @property
    def are_empty(self) -> bool:
        """Return whether no edge is engaged, nor was one a step before."""
        return self._fading == 0

    def update(self, state: State, *, some: bool) -> None:
        """Mark the edges of ``state``; ``some`` is False when none can be at its limit."""
        if self.are_empty and not some:
            return
        self._fading = _FADING_STEPS if some else self._fading - 1
        if self.are_empty:
            self._clear()
        else:
            state.bind_in()
            self.buffer.bind_storage(bindings.AT_LIMIT)
            program = self._program.use()
            program.set_float('onset', self._onset)
            program.set_float('release', _RELEASE if self._fading > 1 else math.inf)
            program.dispatch(*self._groups)
            shader_writes_visible()

    def count(self) -> dict[str, float]:
        """Return the Snapshot's figures of constraints."""
        if self.are_empty:
            return {}
        self.buffer.read_into(self._marks)
        held, now, before = (
            self._marks >> first & _EDGES for first in (_HELD, _ENGAGED, _BEFORE))
        active = _count_bits(held)
        return {
            'active_constraints': active,
            'active_fraction': active / max(self._edges, 1),
            'constraint_switches': _count_bits(now ^ before),
        }

    def forget(self) -> None:
        """Mark nothing, as at the start."""
        self._fading = 0
        self._clear()

    def delete(self) -> None:
        """Release pass and marks."""
        self.buffer.delete()
        self._program.delete()

    def _clear(self) -> None:
        self.buffer.write(np.zeros_like(self._marks))


def _count_bits(values: np.ndarray) -> int:
    return int(np.unpackbits(values.astype(np.uint8)).sum())


class LimitedSubsteps(Protocol):
    """
    What makes substeps while edges are at their limit; see ImplicitStep and LimitedSprings.

    ``substeps`` are those of the last ``advance``, ``last_length`` is that of the last one [s].
    """

    substeps: int
    last_length: float
    stability_limit: float
    substep_margin: float

    @property
    def strain_bound(self) -> float:
        """Get the strain limit."""

    def energy_law(self, state: State) -> EdgeLaw:
        """Return the law by which the edges of ``state`` store energy."""

    def pulls_in(self, state: State) -> bool:
        """Return whether the limit pulls at some edge of a new ``state``."""

    def advance(
            self, state: State, begin: float, seconds: float, loads: Loads,
            stop: Stop = never) -> None:
        """Step ``state`` on by ``seconds``."""

    def run_all_passes(self, state: State, loads: Loads, stop: Stop = never) -> None:
        """Make a substep of a ``state`` that nobody needs."""

    def resume(self, last_length: float) -> None:
        """Go on after explicit substeps, the last of ``last_length`` [s]."""

    def spend_calm(self, seconds: float) -> None:
        """Go on by ``seconds`` in which no edge came near its limit."""

    def clear_tally(self) -> None:
        """Begin to count solves anew."""

    def report(self) -> dict[str, Any]:
        """Return how the solves of the last dt ended."""

    def settling_report(self) -> dict[str, Any]:
        """Return whether a limit has closed in during the last dt, and the work it has done."""

    def tension(
            self, positions: np.ndarray, velocities: np.ndarray,
            nodes: np.ndarray | None = None) -> np.ndarray:
        """Return the tension of every edge [N]."""

    def forget(self) -> None:
        """Drop what was kept from earlier steps."""

    def delete(self) -> None:
        """Release everything."""


class Adaptive:
    """
    Explicit mass-spring substeps while no edge comes near its limit, implicit ones while some do.

    ``substeps`` are those of the last step.
    """

    name = 'adaptive'
    is_implicit = False
    has_memory = True
    checked_substeps = CHECKED_SUBSTEPS

    def __init__(self, scene: Scene, layout: Layout, *, check_stability: bool = True) -> None:
        """Choose the substeps and compile the passes."""
        self._spring_limit = stability_limit(scene)
        self.substeps = spring_substeps(scene, self.name, check_stability=check_stability)
        self._scene = scene
        self._dt: float = scene['dt']
        self._length = self._dt / self.substeps
        self._fewest_substeps = self.substeps
        self._springs = OnePass(scene, layout)
        onset = self.onset(scene)
        self._near = min(_NEAR * scene['adaptive.threshold'], onset)
        self._watch = StrainWatch(scene, layout, self._near)
        self._limit = self.make_limit(scene, layout, self._length)
        self._marks = LimitMarks(scene, layout, onset)
        # The last substep was a limited one; some of the last step were.
        self._is_limited = self._made_limited = False
        # Length of the last substep [s]; 0 where none was.
        self._before = 0.0

    @staticmethod
    def onset(scene: Scene) -> float:
        """Return the strain from which on the limit pulls."""
        return onset_of(scene)

    @staticmethod
    def make_limit(scene: Scene, layout: Layout, length: float) -> LimitedSubsteps:
        """
        Compile and return what makes the limited substeps.

        :param length: of an explicit substep [s]
        """
        return LimitedSprings(scene, layout, scene.families)

    @staticmethod
    def edge_model(scene: Scene) -> str:
        """Return that edges are springs within a limit."""
        return 'limited'

    @staticmethod
    def edge_families(scene: Scene) -> Collection[str]:
        """Return those that have springs."""
        return scene.families

    def energy_law(self, state: State) -> EdgeLaw:
        """Return that of the springs, and of their limit where it holds, or will at once."""
        is_new = self._before == 0.0
        if self._is_limited or (is_new and self._limit.pulls_in(state)):
            return self._limit.energy_law(state)
        return spring_law(self._scene, self._length)

    @staticmethod
    def check(scene: Scene, *, check_stability: bool = True) -> None:
        """Raise ClothSimError when dt is too long for the springs of ``scene``."""
        spring_substeps(scene, Adaptive.name, check_stability=check_stability)

    @property
    def stability_limit(self) -> float:
        """Return the longest stable substep of the kind that the last step has made [s]."""
        return self._limit.stability_limit if self._made_limited else self._spring_limit

    @property
    def substep_margin(self) -> float:
        """Return the longest substep over what it should be."""
        if self._made_limited:
            return self._limit.substep_margin
        return self._length / self._spring_limit

    @property
    def strain_bound(self) -> float:
        """Return the strain limit."""
        return self._limit.strain_bound

    def step(self, state: State, begin: float, loads: Loads, stop: Stop = never) -> None:
        """Step ``state`` on by one dt."""
        self._limit.clear_tally()
        self._made_limited = False
        done, substeps = 0.0, 0
        while self._dt - done > _NOTHING * self._dt:
            now, left = begin + done, self._dt - done
            count = math.ceil(left / self._length - _NOTHING)
            length = left / count
            calm = 0
            if not self._is_limited or self._is_far_from_limit(state, now, left, loads):
                calm = min(count, self._watch.calm_substeps(state, now, length, loads))
            if calm:
                self._is_limited = False
                self._spring_substeps(state, now, length, calm, loads, stop)
                self._watch.advance(calm)
                self._limit.spend_calm(calm * length)
                done += calm * length
                substeps += calm
            else:
                self._limited_substeps(state, now, left, loads, stop)
                done += left
                substeps += self._limit.substeps
        self.substeps = substeps
        self._marks.update(state, some=self._made_limited)

    @staticmethod
    def step_ahead(state: State, gravity: Forcing, most: int) -> int:
        """Return 0: each step goes by what the one before has found."""
        return 0

    def run_all_passes(self, state: State, loads: Loads, stop: Stop = never) -> None:
        """Make substeps with and without limit of a ``state`` that nobody needs."""
        self._watch.strains(state, loads.still, self._length)
        leave_if(stop)
        self._springs.substep(state, loads.still, self._length, self._length)
        leave_if(stop)
        self._limit.run_all_passes(state, loads, stop)
        self._marks.update(state, some=True)
        self.forget()

    def forget(self) -> None:
        """Hold no edge and expect nothing of the state."""
        self.substeps = self._fewest_substeps
        self._before = 0.0
        self._is_limited = self._made_limited = False
        self._watch.forget()
        self._limit.forget()
        self._marks.forget()

    def report(self) -> dict[str, Any]:
        """Return how the solves ended, and how many edges are at their limit or changed."""
        solves = self._limit.report() if self._made_limited else {}
        return {**self._limit.settling_report(), **solves, **self._marks.count()}

    def limit_marks(self) -> Buffer | None:
        """Return which edges are at their limit; None if none are."""
        return None if self._marks.are_empty else self._marks.buffer

    def tension(
            self, positions: np.ndarray, velocities: np.ndarray,
            nodes: np.ndarray | None = None) -> np.ndarray:
        """Return the tension of every edge, of its spring and of what holds it [N]."""
        if self._is_limited:
            return self._limit.tension(positions, velocities, nodes)
        return spring_tension(self._scene, positions, velocities, nodes)

    def delete(self) -> None:
        """Release everything."""
        for part in (self._springs, self._watch, self._limit, self._marks):
            part.delete()

    def _is_far_from_limit(
            self, state: State, now: float, left: float, loads: Loads) -> bool:
        """Return whether edges that were near their limit stay away from it for ``left`` [s]."""
        strains = self._watch.strains(state, loads.forcing(state, now, now + left), left)
        # Written so that NaN is not far.
        return max(strains) < _FAR * self._near

    def _spring_substeps(
            self, state: State, now: float, length: float, count: int,
            loads: Loads, stop: Stop) -> None:
        for index in range(count):
            leave_if(stop)
            start = now + index * length
            # A velocity belongs to the middle of its substep, so forces act from there to the
            # next.
            kick = length
            if self._before and abs(self._before - length) > _NOTHING * length:
                kick = 0.5 * (self._before + length)
            self._springs.substep(
                state, loads.forcing(state, start, start + length, kick), length, kick)
            self._before = length

    def _limited_substeps(
            self, state: State, now: float, left: float, loads: Loads, stop: Stop) -> None:
        if not self._is_limited:
            self._limit.resume(self._before)
        self._is_limited = self._made_limited = True
        self._limit.advance(state, now, left, loads, stop)
        self._before = self._limit.last_length
