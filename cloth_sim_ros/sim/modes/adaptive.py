# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""Adaptive: springs within a strain limit, constraints at it (paper, section 4.3)."""

from collections.abc import Collection
from dataclasses import dataclass
import math
from typing import Any

from cloth_sim_ros.gl.buffer import Buffer
from cloth_sim_ros.sim.device import bindings
from cloth_sim_ros.sim.device.layout import Layout
from cloth_sim_ros.sim.held.pin_forces import filled
from cloth_sim_ros.sim.held.pin_forces import spring_tension
from cloth_sim_ros.sim.limits.active_limits import ActiveLimits
from cloth_sim_ros.sim.limits.limit_marks import LimitMarks
from cloth_sim_ros.sim.limits.limit_program import Limits
from cloth_sim_ros.sim.limits.limit_program import NEAR
from cloth_sim_ros.sim.loads.forcing import Forcing
from cloth_sim_ros.sim.loads.forcing import Layers
from cloth_sim_ros.sim.loads.loads import Loads
from cloth_sim_ros.sim.model.stability import spring_substeps
from cloth_sim_ros.sim.model.stability import stability_limit
from cloth_sim_ros.sim.modes.edge_watch import StrainWatch
from cloth_sim_ros.sim.modes.edge_watch import TurnWatch
from cloth_sim_ros.sim.modes.free_motion import FreeMotion
from cloth_sim_ros.sim.modes.implicit import Settling
from cloth_sim_ros.sim.modes.limited_springs import LimitedSprings
from cloth_sim_ros.sim.modes.listed_substeps import ListedSubsteps
from cloth_sim_ros.sim.modes.mass_spring import OnePass
from cloth_sim_ros.sim.modes.mode import CHECKED_SUBSTEPS
from cloth_sim_ros.sim.scene import FAMILIES
from cloth_sim_ros.sim.scene import Scene
from cloth_sim_ros.sim.solver.edge_law import EdgeLaw
from cloth_sim_ros.sim.solver.edge_law import spring_law
from cloth_sim_ros.sim.state import State
from cloth_sim_ros.sim.stop import leave_if
from cloth_sim_ros.sim.stop import never
from cloth_sim_ros.sim.stop import Stop
import numpy as np

# Max. substeps between two looks at how fast edges turn [1], and substeps after which it is chosen
# how to go on [1]: a cloth without a listed edge in them counts as calm.
_LOOK = 16
_REVIEW = 8
# Time of a substep with listed edges, and of a round over one edge, over that of a pass of springs
# and over that for a node; time of an implicit substep over that of such a pass [1]; measured on
# llvmpipe with one thread (docs/explanation/adaptive.md).
_LISTED_COST = 1.9
_ROUND_COST = 3.0
_WHOLE_COST = 150.0
# Listed edges over those for which the whole cloth was solved for first, below which it is no more
# [1].
_RETURN = 0.5
# Substeps between two looks at whether edges are listed, while none has been [1].
_FIRST = 1
# Parts that a substep of springs is divided into over those before, below which they become fewer
# [1], and substeps after which they do [1]: an undamped cloth gains 0.25 of its energy with 0
# (random_limits.py --first 101 --count 1).
_LONGER = 0.5
_KEPT_FOR = 256
# Listed edges over nodes [1], up to which they have no say in the length of a substep: springs
# near their stability limit gain energy where that changes time and again.
_SOME = 0.03
# Way that a node is accelerated by in a substep over the limit of the shortest edge [1], above
# which a solve throws further edges past their limit, so that more solves are needed.
_ROUGH = 0.02
# Substeps that count as rough [1] after a pin, a push or a collider has thrown nodes, or an
# edge was found far beyond its limit.
_ROUGH_FOR = 32
# Max. rough substeps in a row that put off the whole-cloth step [1]: pins that are shaken throw
# the cloth all the time; 128 let edges reach 1.76 times their limit, not 1.36 (limits.py).
_ROUGH_MOST = 512
# Cost of lists over that of the whole cloth [1], above which rough substeps do not put it off,
# either: a shaken towel takes 0.8 of the time (shaken_towel.py --seconds 4); with 3, edges reach
# 1.68 times their limit, not 1.35 (limits.py).
_DEAR = 6.0
# Strain over the limit above which a new cloth is brought back gradually [1].
_NOTABLE = 1.05
# Substeps that still count as settling after a limit has closed in [1]: they reduce the strain
# beyond it to 1e-3.
_CLOSING_FOR = 64
# Max. substep margin that is reported [1]; a finite number where edges turn at once.
_LARGEST_MARGIN = 1e9
# Fraction of a dt that counts as rounding [1].
_NOTHING = 1e-9


@dataclass
class Made:
    """
    The substeps of a dt, by how they were made.

    :param calm: of springs alone
    :param listed: with the edges that came near their limit solved for
    :param whole: implicit ones of the whole cloth
    """

    calm: int = 0
    listed: int = 0
    whole: int = 0


class Adaptive:
    """
    Substeps of springs, after which the edges that come to their limit are held there.

    While no edge is foreseen near its limit, springs are all (calm). Where the edges at their
    limit take longer than the whole cloth would take, it is solved for by the implicit step
    (whole). ``substeps`` are those of the last step, ``last_length`` is that of the last of them
    [s], 0 where none was.
    """

    name = 'adaptive'
    is_implicit = False
    has_memory = True
    checked_substeps = CHECKED_SUBSTEPS
    # Whether the whole cloth is solved for where that is faster than the edges at their limit.
    may_solve_whole = True

    def __init__(self, scene: Scene, layout: Layout, *, check_stability: bool = True) -> None:
        """Choose the substeps and compile the passes."""
        self._spring_limit = stability_limit(scene)
        self._fewest = self.substeps = spring_substeps(
            scene, self.name, check_stability=check_stability)
        self.strain_bound: float = scene['adaptive.threshold']
        self._scene = scene
        self._layout = layout
        self._dt: float = scene['dt']
        self._length = self._dt / self.substeps
        self._springs = OnePass(scene, layout, acts_on_surface=True)
        self._watch = StrainWatch(scene, layout, NEAR * self.strain_bound)
        self._turns = TurnWatch(
            scene, layout, tuple(family for family in FAMILIES if family in scene.families))
        self._scheme: str = scene['adaptive.scheme']
        self._limits = ActiveLimits(
            scene, layout, are_many={'list': False, 'lattice': True}.get(self._scheme))
        self._alike = ListedSubsteps(self._springs, self._limits)
        self._marks = LimitMarks(scene, layout)
        self._free_motion = FreeMotion(scene, layout)
        self._limits_now = Limits(self._length, self.strain_bound)
        self._settling = Settling(
            _NOTABLE * self.strain_bound, max(scene['width'], scene['height']))
        # Compiled when it is first needed.
        self._whole: LimitedSprings | None = None
        self.forget()

    @staticmethod
    def edge_model(scene: Scene) -> str:
        """Return that edges are springs within a limit."""
        return 'limited'

    @staticmethod
    def edge_families(scene: Scene) -> Collection[str]:
        """Return those that have springs."""
        return scene.families

    @staticmethod
    def check(scene: Scene, *, check_stability: bool = True) -> None:
        """Raise ClothSimError when dt is too long for the springs of ``scene``."""
        spring_substeps(scene, Adaptive.name, check_stability=check_stability)

    def energy_law(self, state: State) -> EdgeLaw:
        """Return that of the springs, and of their limits where the whole cloth is solved for."""
        if self._is_whole and self._whole is not None:
            return self._whole.energy_law(state)
        return spring_law(self._scene, self._length)

    @property
    def stability_limit(self) -> float:
        """Return the longest stable substep of the kind that the last step has made [s]."""
        return math.inf if self._is_whole else self._spring_limit

    @property
    def substep_margin(self) -> float:
        """Return the longest substep over its upper bound."""
        if self._is_whole and self._whole is not None:
            return self._whole.substep_margin
        return max(self._longest / self._spring_limit, self._turn_margin)

    def step(self, state: State, begin: float, loads: Loads, stop: Stop = never) -> None:
        """Step ``state`` on by one dt."""
        self._made = Made()
        self._limits.begin_step()
        self._is_marked, self._longest, self._turn_margin = False, 0.0, 0.0
        if self._whole is not None:
            self._whole.clear_tally()
        self._was_settling = self._is_settling
        if self._is_whole and self._are_fewer(state, begin, loads):
            self._leave_whole()
        done = 0.0
        while self._dt - done > _NOTHING * self._dt:
            leave_if(stop)
            now, left = begin + done, self._dt - done
            if self._is_whole:
                done += self._step_whole(state, now, left, loads, stop)
            elif self._is_listed:
                done += self._step_listed(state, now, left, loads, stop)
            else:
                done += self._step_calm(state, now, left, loads, stop)
        self.substeps = self._made.calm + self._made.listed + self._made.whole

    @staticmethod
    def step_ahead(state: State, gravity: Forcing, most: int) -> int:
        """Return 0: each step depends on the previous one."""
        return 0

    def run_all_passes(self, state: State, loads: Loads, stop: Stop = never) -> None:
        """Make substeps of all kinds of a scratch ``state``."""
        still = loads.still
        self._watch.strains(state, still, self._length)
        leave_if(stop)
        self._turns.look(state, still, self._length)
        leave_if(stop)
        self._springs.substep(state, still, self._length, self._length)
        limits = Limits(self._length, self.strain_bound)
        for are_many in (False, True):
            leave_if(stop)
            self._springs.run(state, still, self._length, acts=False)
            self._limits.run_all_passes(
                state, limits, still.touch, self._springs.held_at, are_many=are_many)
            self._act_on_touch(state, still, self._length)
            state.swap()
        leave_if(stop)
        self._free_motion.aim_at(state, still, still, self._length)
        self._free_motion.restore(state, still, self._length)
        leave_if(stop)
        self._marks.update(state, self.strain_bound, self._limits.changes)
        if self.may_solve_whole:
            self._compiled_whole().run_all_passes(state, loads, stop)
        self.forget()

    def forget(self) -> None:
        """Hold no edge and expect nothing of the state."""
        self.substeps = self._fewest
        self._made = Made()
        self._longest = self._length
        self.last_length = 0.0
        self._is_listed = self._is_whole = self._was_settling = False
        # Whether edges were listed in the substeps before the last review, and not just one or
        # two.
        self._has_held = self._are_some = False
        self._is_marked = True
        # Edges that were listed when the whole cloth was solved for first.
        self._listed_then = 0
        # Listed substeps since their tally was read, and until the next look at the edges.
        self._unreviewed = self._until_look = 0
        self._look_edits = -1
        # Substeps that still count as rough.
        self._rough_left = 0
        # Such substeps in a row that were made.
        self._rough_made = 0
        # Into how many a substep of springs is divided where edges turn, and for how many yet.
        self._parts = 1
        self._kept_left = 0
        self._turn_length = self._length
        # A substep over the longest in which edges at their limit turn little.
        self._turn_margin = 0.0
        # Substeps after settling in which the rest of an excess is taken away.
        self._closing_left = 0
        self._settling_work = 0.0
        self._settling.forget()
        self._watch.forget()
        self._limits.release()
        self._alike.forget()
        self._marks.forget()
        self._free_motion.forget()
        if self._whole is not None:
            self._whole.forget()

    def report(self) -> dict[str, Any]:
        """Return how edges were held in the last step, and how many are or changed."""
        solves, work = {}, self._settling_work
        if self._whole is not None:
            work += self._whole.settling_report()['settling_work']
            if self._made.whole:
                solves = self._whole.report()
        tally = self._limits.tally_of_step()
        found = {
            **solves, **self._marks.report(),
            'settling': self._was_settling or self._is_settling, 'settling_work': work,
            'calm_substeps': self._made.calm, 'listed_substeps': self._made.listed,
            'whole_substeps': self._made.whole, 'listed_edges': tally.most_listed,
            'limit_rounds': tally.most_rounds, 'limit_unreached': tally.unreached}
        if tally.unreached:
            found['solver_reached'] = False
        return found

    def limit_marks(self, state: State) -> Buffer | None:
        """Return which edges are at their limit; None if none are."""
        if not self._is_marked:
            self._is_marked = True
            if self._is_whole:
                self._marks.update(state, self._limit, None)
            elif self._is_listed:
                self._marks.update(state, self._limit, self._limits.changes)
            else:
                self._marks.clear()
        return self._marks.buffer

    def tension(
            self, positions: np.ndarray, velocities: np.ndarray,
            nodes: np.ndarray | None = None) -> np.ndarray:
        """Return the tension of every edge, of its spring and of what holds it [N]."""
        if self._is_whole and self._whole is not None:
            return self._whole.tension(positions, velocities, nodes)
        springs = spring_tension(self._scene, positions, velocities, nodes)
        if not (self._is_listed and self.last_length):
            return springs
        pulls = self._limits.pulls(filled(self._scene, positions))
        return (springs + self._scene.node_mass / self.last_length * pulls).astype(np.float32)

    def delete(self) -> None:
        """Release everything."""
        self._alike.forget()
        for part in (
                self._springs, self._watch, self._turns, self._limits, self._marks,
                self._free_motion, self._whole):
            if part is not None:
                part.delete()
        self._whole = None

    @property
    def _limit(self) -> float:
        """Return the strain limit that holds now."""
        return max(self.strain_bound, self._settling.limit)

    @property
    def _is_settling(self) -> bool:
        return self._settling.limit > self.strain_bound or self._closing_left > 0

    # Springs alone.

    def _step_calm(
            self, state: State, now: float, left: float, loads: Loads, stop: Stop) -> float:
        """Make substeps of springs while no edge comes near its limit; return their time [s]."""
        if self._kept_left == 0:
            self._parts = 1
        count = math.ceil(left * self._parts / self._length - _NOTHING)
        length = left / count
        calm = 0
        if self._can_be_calm():
            calm = min(count, self._watch.calm_substeps(state, now, length, loads))
        if calm == 0:
            self._free_motion.forget()
            self._is_listed, self._unreviewed, self._until_look = True, 0, 0
            self._has_held = self._are_some = False
            if self._scheme == 'whole':
                self._listed_then = 1
                self._begin_whole(state, loads.still)
            return 0.0
        for index in range(calm):
            leave_if(stop)
            self._make_calm(state, now + index * length, length, loads)
        self._watch.advance(calm)
        self._look_edits = state.edits
        self._settling.is_new = False
        self._settling.advance(calm * length)
        self._closing_left = 0
        self._kept_left = max(self._kept_left - calm, 0)
        self._made.calm += calm
        self._longest = max(self._longest, length)
        return calm * length

    def _can_be_calm(self) -> bool:
        """Return whether edges can be foreseen: what acts on them is known."""
        return True

    def _make_calm(self, state: State, start: float, length: float, loads: Loads) -> None:
        """Make a substep of springs alone."""
        self._springs.substep(
            state, self._forcing(state, start, length, loads), length, self._kick(length))
        self.last_length = length

    # Springs, and the edges that come near their limit.

    def _step_listed(
            self, state: State, now: float, left: float, loads: Loads, stop: Stop) -> float:
        """Make some substeps in which edges are held; return their time [s]."""
        count = math.ceil(left / self._turned_length(state, now, left, loads) - _NOTHING)
        length = left / count
        if abs(length - self._limits_now.length) <= _NOTHING * length:
            # Each other length would be set again in all passes.
            length = self._limits_now.length
        some = min(count, max(self._until_look, 1), _REVIEW if self._has_held else _FIRST)
        made = 0
        while made < some:
            leave_if(stop)
            start = now + made * length
            alike = self._make_alike(state, start, length, some - made, loads, stop)
            if alike == 0:
                self._make_listed(state, start, length, loads)
            made += alike or 1
        self._until_look -= some
        self._kept_left = max(self._kept_left - some, 0)
        self._rough_made = self._rough_made + some if self._rough_left > 0 else 0
        self._rough_left = max(self._rough_left - some, 0)
        self._made.listed += some
        self._longest = max(self._longest, length)
        self._unreviewed += some
        if not self._has_held and self._unreviewed < _REVIEW:
            listed = self._limits.listed()
            if listed:
                self._has_held, self._are_some, self._until_look = True, self._is_some(listed), 0
        if self._unreviewed >= _REVIEW or self._is_settling:
            self._review(length, state, loads)
        return some * length

    def _make_alike(
            self, state: State, start: float, length: float, most: int, loads: Loads,
            stop: Stop) -> int:
        """Make up to ``most`` substeps under the same loads at once; return how many."""
        if self._kick(length) != length or self._is_settling or not state.pinned.any():
            return 0
        count = int(min(most, (loads.quiet_until(start) - start) / length + _NOTHING))
        if count == 0:
            return 0
        forcing = self._forcing(state, start, length, loads)
        self._set_limits(length, forcing)
        if not self._alike.can_make(state, forcing, self._limits_now):
            return 0
        made = self._alike.make(state, forcing, self._limits_now, count, stop)
        self.last_length = length
        return made

    def _make_listed(self, state: State, start: float, length: float, loads: Loads) -> None:
        """Make a substep in which edges are held."""
        forcing = self._forcing(state, start, length, loads)
        self._write_listed(state, forcing, loads, length)
        self._act_on_touch(state, forcing, length)
        state.swap()
        self._end_listed(state, forcing, loads, length)

    def _write_listed(
            self, state: State, forcing: Forcing, loads: Loads, length: float) -> None:
        """Write a substep in which edges are held, before anything touches the cloth."""
        kick = self._kick(length)
        if not state.pinned.any():
            self._free_motion.aim_at(state, forcing, loads.still, kick)
        self._springs.run(state, forcing, length, kick, acts=False)
        self._set_limits(length, forcing)
        self._limits.act(state, self._limits_now, forcing.touch, self._springs.held_at)

    def _end_listed(self, state: State, forcing: Forcing, loads: Loads, length: float) -> None:
        """Go on from a substep in which edges were held."""
        self.last_length = length
        if not state.pinned.any():
            self._keep_momentum(state, forcing, loads.still, length)
        self._advance_settling(length)

    def _advance_settling(self, length: float) -> None:
        """Go on by a listed substep of ``length`` [s]."""
        if self._settling.limit > self.strain_bound:
            self._closing_left = _CLOSING_FOR
        else:
            self._closing_left = max(self._closing_left - 1, 0)
        self._settling.advance(length)

    def _set_limits(self, length: float, forcing: Forcing) -> None:
        """Set the limits of a substep of ``length`` [s]; most are like the one before."""
        strain, now = self._limit, self._limits_now
        way = math.hypot(*forcing.everywhere) * length**2
        is_rough = self._rough_left > 0 or way > _ROUGH * strain * min(self._scene.spacing)
        if (now.length, now.strain, now.is_rough) != (length, strain, is_rough):
            self._limits_now = Limits(length, strain, is_rough)

    def _turned_length(self, state: State, now: float, left: float, loads: Loads) -> float:
        """Return the longest substep [s] that springs take and in which edges turn little."""
        is_quiet = loads.quiet_until(now) > now
        if self._until_look <= 0 or state.edits != self._look_edits or not is_quiet:
            is_edited = self._look_edits not in (-1, state.edits)
            # A pin that sets off, a push, or a collider that moves throws nodes.
            if is_edited or not is_quiet:
                self._limits.look_anew()
                self._rough_left = _ROUGH_FOR
            self._until_look, self._look_edits = _LOOK, state.edits
            parts, turned = 1, math.inf
            matters = self._are_some or self._rough_left > 0
            if matters or self._settling.is_new:
                ahead = min(left, _LOOK * self._length)
                turned, strain = self._turns.look(
                    state, loads.forcing(state, now, now + ahead), ahead)
                self._settling.begin(strain)
            if matters and self._scene['auto_substeps']:
                shortest = self._dt / self._scene['constraint.max_substeps']
                longest = max(turned / self._scene['refine'], shortest)
                parts = max(1, math.ceil(self._length / longest))
            # Springs keep their energy in substeps of equal length.
            if parts > self._parts or (parts <= _LONGER * self._parts and self._kept_left == 0):
                self._parts = parts
            if parts > _LONGER * self._parts:
                self._kept_left = _KEPT_FOR
            self._turn_length = self._length / self._parts
            if matters:
                margin = min(self._turn_length / max(turned, 1e-30), _LARGEST_MARGIN)
                self._turn_margin = max(self._turn_margin, margin)
        return self._turn_length

    def _review(self, length: float, state: State, loads: Loads) -> None:
        """Choose the kind of the next substeps by the cost of the last, of ``length`` [s]."""
        substeps, self._unreviewed = self._unreviewed, 0
        tally = self._limits.tally()
        if self._was_settling or self._is_settling:
            self._settling_work += self._scene.node_mass * tally.energy
        if tally.missed:
            self._rough_left = _ROUGH_FOR
        self._has_held = tally.substeps > 0
        self._are_some = self._is_some(tally.most_listed)
        if not self._has_held:
            self._is_listed = False
            self._limits.forget()
            return
        rounds = tally.edge_rounds / (substeps * self._scene.node_count)
        whole_length = min(self._dt, max(self._turn_length, length))
        if self._scheme != 'constraint' or not self.may_solve_whole:
            return
        listed_cost = _LISTED_COST + _ROUND_COST * rounds
        whole_cost = _WHOLE_COST * length / whole_length
        # In violent motion, which is mostly short, a list holds the limits better.
        is_put_off = 0 < self._rough_made < _ROUGH_MOST and listed_cost < _DEAR * whole_cost
        if listed_cost > whole_cost and not is_put_off:
            self._listed_then = tally.most_listed
            self._begin_whole(state, loads.still)

    def _is_some(self, listed: int) -> bool:
        """Return whether so many listed edges matter to how the cloth moves."""
        return listed > _SOME * self._scene.node_count

    # The whole cloth.

    def _compiled_whole(self) -> LimitedSprings:
        if self._whole is None:
            self._whole = LimitedSprings(self._scene, self._layout, self._settling)
        return self._whole

    def _begin_whole(self, state: State, still: Forcing) -> None:
        whole = self._compiled_whole()
        _, strain = self._turns.look(state, still, self._length)
        if strain > _NOTABLE * self._limit:
            # What an edge is beyond its limit has no energy yet.
            self._settling.begin_anew(strain)
        self._closing_left = 0
        self._is_whole = True
        whole.clear_tally()
        whole.take_over(self.last_length)

    def _step_whole(
            self, state: State, now: float, left: float, loads: Loads, stop: Stop) -> float:
        """Make implicit substeps for ``left`` [s], and return that."""
        assert self._whole is not None
        self._whole.advance(state, now, left, loads, stop)
        self.last_length = self._whole.last_length
        self._made.whole += self._whole.substeps
        self._longest = max(self._longest, self.last_length)
        return left

    def _are_fewer(self, state: State, now: float, loads: Loads) -> bool:
        """Return whether far fewer edges come near their limit than when this was begun."""
        limits = Limits(self._length, self._limit)
        self._springs.run(
            state, loads.forcing(state, now, now + self._length), self._length, is_kept=False)
        return self._limits.count(state, limits) < _RETURN * self._listed_then

    def _leave_whole(self) -> None:
        self._is_whole, self._is_listed = False, self._scheme != 'whole'
        self._has_held = self._are_some = self._is_listed
        self._unreviewed = self._until_look = 0
        self._limits.forget()
        self._free_motion.forget()

    def _kick(self, length: float) -> float:
        """Return for how long [s] forces act in a substep of ``length`` [s]."""
        # A velocity belongs to the middle of its substep, so forces act from there to the next.
        if self.last_length and abs(self.last_length - length) > _NOTHING * length:
            return 0.5 * (self.last_length + length)
        return length

    def _forcing(self, state: State, start: float, length: float, loads: Loads) -> Forcing:
        return loads.forcing(state, start, start + length, self._kick(length))

    def _keep_momentum(
            self, state: State, forcing: Forcing, still: Forcing, length: float) -> None:
        """Give a cloth that nothing holds or touches the momenta that it must have."""
        if forcing.touch is not None and forcing.touch.has_acted():
            self._free_motion.forget()
        else:
            self._free_motion.restore(state, still, length)

    def _act_on_touch(
            self, state: State, forcing: Forcing, length: float,
            layers: Layers | None = None) -> None:
        """Let colliders, and layers that touch, end a substep in which edges were held."""
        changes, held_at = self._limits.changes, self._springs.held_at
        assert changes is not None  # limits have acted
        if forcing.touch is not None:
            forcing.touch.act_after_limits(state, length, changes, held_at, layers)
        elif layers is not None:
            changes.bind_storage(bindings.LIMIT_CHANGES)
            layers.let_act()
            layers.give(held_at, notes_changes=True)
