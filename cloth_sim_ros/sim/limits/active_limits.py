# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""Hold the edges that come to their limit in explicit substeps, and solve for no others."""

from dataclasses import dataclass
from dataclasses import replace

from cloth_sim_ros.gl.buffer import Buffer
from cloth_sim_ros.gl.buffer import dispatches_visible_call
from cloth_sim_ros.gl.buffer import shader_dispatches_visible
from cloth_sim_ros.gl.buffer import shader_writes_visible
from cloth_sim_ros.gl.buffer import writes_visible_call
from cloth_sim_ros.gl.program import Program
from cloth_sim_ros.gl.quick_calls import Call
from cloth_sim_ros.sim.device.layout import Layout
from cloth_sim_ros.sim.device.scene_program import Strips
from cloth_sim_ros.sim.limits.lattice_rounds import LatticeRounds
from cloth_sim_ros.sim.limits.limit_buffers import EDGES
from cloth_sim_ros.sim.limits.limit_buffers import LimitBuffers
from cloth_sim_ros.sim.limits.limit_buffers import TALLY
from cloth_sim_ros.sim.limits.limit_program import LimitProgram
from cloth_sim_ros.sim.limits.limit_program import Limits
from cloth_sim_ros.sim.loads.forcing import Touch
from cloth_sim_ros.sim.model.edge_kinds import EDGE_KINDS
from cloth_sim_ros.sim.scene import Scene
from cloth_sim_ros.sim.state import State
import numpy as np

# Invocations of the workgroup of limit/solve.comp [1]: 16 take 3 us more on software, and 64
# a tenth longer.
_SOFTWARE_LOCAL = 8
_GPU_LOCAL = 256
# Max. nodes [1] of a cloth whose edges are listed by that workgroup, too, on software.
_FEW_NODES = 4096
# Max. solves of a substep [1], after each of which the edges are listed that it throws too far.
_MOST_PASSES = 16
# Invocations of a workgroup of limit/list.comp [1].
_LIST_LOCAL = 8
# Max. edges of an invocation times rounds of limit/solve.comp [1]: llvmpipe ends all loops of an
# invocation after 65,535 turns. With contact there are loops within them.
_MOST_WORK = 12_000
_MOST_WORK_IN_CONTACT = 3_000
# Listed edges over nodes from which on passes over the lattice are faster than a list [1],
# measured on llvmpipe with one thread, where they take 0.09 us a node and 0.075 us an edge; and
# below which a list is taken again.
_MANY = 1.2
_FEWER = 0.8
_NO_TALLY = np.zeros(TALLY, dtype=np.uint32)


@dataclass
class LimitTally:
    """
    What was solved for in some substeps.

    :param substeps: in which edges were listed
    :param most_listed: edges in a substep
    :param most_active: edges that had an impulse in a substep
    :param most_rounds: of a substep
    :param unreached: substeps in which the rounds did not suffice
    :param edge_rounds: listed edges times rounds, of all substeps
    :param energy: that impulses have given to the nodes, over their mass [m2/s2]
    :param missed: edges far beyond their limit that had no impulse before
    """

    substeps: int = 0
    most_listed: int = 0
    most_active: int = 0
    most_rounds: int = 0
    unreached: int = 0
    edge_rounds: float = 0.0
    energy: float = 0.0
    missed: int = 0

    def add(self, other: 'LimitTally') -> None:
        """Add what was solved for in other substeps."""
        self.substeps += other.substeps
        self.most_listed = max(self.most_listed, other.most_listed)
        self.most_active = max(self.most_active, other.most_active)
        self.most_rounds = max(self.most_rounds, other.most_rounds)
        self.unreached += other.unreached
        self.edge_rounds += other.edge_rounds
        self.energy += other.energy
        self.missed += other.missed


class ActiveLimits:
    """
    The passes of shaders/limit/ and the impulses they find, docs/explanation/adaptive.md.

    limit/list.comp lists the edges that come near their limit. Few of them are solved for by one
    workgroup, limit/solve.comp, without waiting for the device; many in passes over the lattice.
    Nothing is compiled or allocated before it is needed.

    :param are_many: whether passes always, or never, go over the lattice; None: where it is faster
    """

    def __init__(self, scene: Scene, layout: Layout, are_many: bool | None = None) -> None:
        """Prepare."""
        self._scene = scene
        self._layout = layout
        # Whether others change velocities as well, and note it.
        self._has_others = scene.has_contact or scene['self_contact.enabled']
        # Whether limit/solve.comp lists the edges, too: not where changes of velocity by others
        # are to be dropped between the two.
        self._is_one_pass = not (
            layout.is_asynchronous or self._has_others or scene.node_count > _FEW_NODES)
        defines = {
            'LOCAL': _GPU_LOCAL if layout.is_asynchronous else _SOFTWARE_LOCAL,
            'LISTS': int(self._is_one_pass)}
        self._look = LimitProgram(
            'limit/look.comp', scene, layout,
            {**Strips.defines(), 'LIST_LOCAL': f'{_LIST_LOCAL}u'})
        self._list = LimitProgram(
            'limit/list.comp', scene, layout, {'LIST_LOCAL': _LIST_LOCAL})
        self._strips = Strips.groups(layout)
        # Substeps until all edges are to be looked at.
        self._until_look = 0
        self._solve = LimitProgram('limit/solve.comp', scene, layout, defines)
        self._work_limit = _MOST_WORK_IN_CONTACT if scene.has_contact else _MOST_WORK
        self._buffers: LimitBuffers | None = None
        self._lattice: LatticeRounds | None = None
        # Counts of the passes over the lattice since ``tally`` was asked last, and in this step.
        self._tally, self._tally_of_step = LimitTally(), LimitTally()
        # Whether limit/solve.comp has yet to begin its tally of the present step.
        self._begins_step = True
        self._solve_set: tuple[bool, bool, bool] | None = None
        # Whether edges are yet to be listed by limit/solve.comp.
        self._lists_first = False
        self._are_many = are_many
        # Whether passes go over the lattice.
        self.are_many = bool(are_many)

    def act(self, state: State, limits: Limits, touch: Touch | None, held_at: int) -> None:
        """
        Hold the edges of a substep that is written but is not the present state yet.

        :param touch: the colliders that will act on it
        :param held_at: where its entries of held.glsl are, bound by now; below 0: nowhere
        """
        if limits.is_rough:
            self.look_anew()
        self._list_edges(state, limits, in_own_pass=self.are_many)
        if not limits.is_rough:
            self._forget_contacts()
            self._solve_for_listed(limits, touch, held_at, gives=True)
            return
        # Each solve throws some further edges past their limit: those that were not listed.
        for _ in range(_MOST_PASSES):
            self._solve_for_listed(limits, touch, held_at, gives=False)
            self._add_edges(limits)
            if self._lists.take_newly_listed() == 0:
                break
        self._forget_contacts()
        active, energy = self._on_lattice().give(limits, held_at)
        if active:
            self._count(LimitTally(substeps=1, most_active=active, energy=energy))

    def begin_alike(self, limits: Limits) -> Program:
        """
        Set what ``look_calls`` and ``calls`` run, and bind what they need in any state.

        :return: limit/solve.comp, which asks for ``held_at`` as ``act`` does
        """
        self._look.use(limits)
        if not self._is_one_pass:
            self._list.use(limits)
        self._lists_first = self._is_one_pass
        program = self._solve.use(limits)
        program.set_int('held_at', -1)
        self._set_solve(program, gives=True)
        self._lists.bind_what_stays()
        return program

    def take_look(self) -> bool:
        """Return whether ``look_calls`` come before ``calls`` in the substep that begins."""
        is_due = self._until_look == 0
        self._until_look = (self._layout.block if is_due else self._until_look) - 1
        return is_due

    def look_calls(self, state: State) -> list[Call]:
        """Return the calls that mark blocks again, in a substep that was written."""
        return [
            *self._out_calls(state), *self._lists.mark_none_calls(),
            *self._look.made.calls(*self._strips), dispatches_visible_call()]

    def calls(self, state: State) -> list[Call]:
        """Return the calls that hold edges in a substep that was written."""
        listing = [] if self._is_one_pass else [
            *self._list.made.indirect_calls(0), writes_visible_call()]
        return [
            *self._out_calls(state), *listing, *self._solve.made.calls(1, 1),
            writes_visible_call()]

    def end_first(self) -> None:
        """Add to the tally of the step from now on; the first of the ``calls`` have begun it."""
        if self._begins_step:
            self._begins_step = False
            self._set_solve(self._solve.made, gives=True)

    def made(self, count: int) -> None:
        """Count ``count`` times that ``calls`` were made."""
        self._lists_first = False
        if not self._is_one_pass:
            self._list.made.submitted(count)
        self._solve.made.submitted(count)

    def count(self, state: State, limits: Limits) -> int:
        """Return how many edges of a substep that is written come near their limit."""
        self.look_anew()
        self._list_edges(state, limits, in_own_pass=True)
        self.look_anew()
        return self._on_lattice().count()

    def tally(self) -> LimitTally:
        """Wait for the device, and return what was solved for since this was asked last."""
        found, self._tally = self._tally, LimitTally()
        if self._buffers is not None:
            found.add(self._read_tally(0))
            self._buffers.tally.write(_NO_TALLY)
        if found.substeps and self._are_many is None:
            share = found.most_listed / self._scene.node_count
            self.are_many = share > (_FEWER if self.are_many else _MANY)
        return found

    def listed(self) -> int:
        """Wait for the device; return the most edges in a substep since ``tally`` was asked."""
        listed = self._tally.most_listed
        if self._buffers is not None:
            listed = max(listed, self._read_tally(0).most_listed)
        return listed

    def look_anew(self) -> None:
        """Look at all edges in the next substep: the prediction does not hold any more."""
        self._until_look = 0

    def begin_step(self) -> None:
        """Restart the counts of ``tally_of_step``."""
        self._begins_step = True
        self._tally_of_step = LimitTally()

    def tally_of_step(self) -> LimitTally:
        """Wait for the device, and return what was solved for since ``begin_step``."""
        found = replace(self._tally_of_step)
        if self._buffers is not None and not self._begins_step:
            found.add(self._read_tally(1))
        return found

    def pulls(self, positions: np.ndarray) -> np.ndarray:
        """
        Return the impulse of each edge along it over the mass of a node [m/s].

        :param positions: of the present state, (rows, cols, 3) [m]
        :return: (rows, cols, 6); what pulls the ends together is positive
        """
        rows, cols = positions.shape[:2]
        pulls = np.zeros((rows, cols, len(EDGE_KINDS)))
        if self._buffers is None:
            return pulls
        stored = np.empty((self._layout.stored, EDGES, 3), dtype=np.float32)
        self._buffers.impulses.read_into(stored)
        impulses = self._layout.load(stored)
        for kind in EDGE_KINDS[:EDGES]:
            starts, ends = kind.everywhere(rows, cols)
            along = positions[ends].astype(float) - positions[starts]
            given = impulses[starts][..., kind.number, :].astype(float)
            length = np.maximum(np.linalg.norm(along, axis=-1), 1e-30)
            pulls[starts][..., kind.number] = np.sum(given * along, axis=-1) / length
        return pulls

    def run_all_passes(
            self, state: State, limits: Limits, touch: Touch | None, held_at: int, *,
            are_many: bool) -> None:
        """Hold edges of a scratch substep, in a list or on the lattice."""
        self.look_anew()
        self._list_edges(state, limits, in_own_pass=True)
        self._add_edges(limits)
        if are_many:
            self._on_lattice().run_all_passes(limits, touch, held_at)
        else:
            self._act_on_list(limits, touch, held_at, gives=True)

    @property
    def changes(self) -> Buffer | None:
        """Return the changes of velocity of limit_give.glsl; None before there are any."""
        return None if self._buffers is None else self._buffers.changes

    def forget(self) -> None:
        """Drop the impulses of earlier substeps."""
        if self._buffers is not None:
            self._buffers.clear()
        self._tally, self._tally_of_step = LimitTally(), LimitTally()
        self._begins_step = True
        self.are_many = bool(self._are_many)
        self.look_anew()

    def release(self) -> None:
        """Drop the impulses, and release the memory: the next cloth may never need it."""
        self.forget()
        if self._lattice is not None:
            self._lattice.delete()
        if self._buffers is not None:
            self._buffers.delete()
        self._lattice = self._buffers = None

    def delete(self) -> None:
        """Release passes and memory."""
        for part in (
                self._list, self._look, self._solve, self._lattice, self._buffers):
            if part is not None:
                part.delete()
        self._buffers = self._lattice = self._solve_set = None

    def _read_tally(self, number: int) -> LimitTally:
        assert self._buffers is not None
        values = np.empty(TALLY, dtype=np.uint32)
        self._buffers.tally.read_into(values, number * values.nbytes)
        edge_rounds, energy = values[5:7].view(np.float32).tolist()
        substeps, listed, active, rounds, unreached = values[:5].tolist()
        return LimitTally(
            substeps, listed, active, rounds, unreached, edge_rounds, energy, int(values[7]))

    @property
    def _lists(self) -> LimitBuffers:
        if self._buffers is None:
            self._buffers = LimitBuffers(self._layout)
        return self._buffers

    def _list_edges(self, state: State, limits: Limits, *, in_own_pass: bool) -> None:
        """
        List the edges that come near their limit in a substep that is written.

        :param in_own_pass: False leaves it to limit/solve.comp where that can do it
        """
        self._lists.bind(state)
        if self._until_look == 0:
            self._until_look = self._layout.block
            self._lists.mark_none()
            self._look.use(limits).dispatch(*self._strips)
            shader_dispatches_visible()
        self._until_look -= 1
        self._lists_first = self._is_one_pass and not in_own_pass
        if not self._lists_first:
            self._lists.lists.bind_dispatches()
            self._list.use(limits).dispatch_indirect(0)
            shader_writes_visible()

    def _forget_contacts(self) -> None:
        """Forget what others did to nodes in the previous substep: edges are listed by now."""
        if self._has_others:
            self._lists.clear_changes()

    def _add_edges(self, limits: Limits) -> None:
        """List those, too, that pass their limit by the impulses that were found."""
        self._lists.lists.bind_dispatches()
        self._list.use(limits, adds=True).dispatch_indirect(0)
        shader_writes_visible()

    def _solve_for_listed(
            self, limits: Limits, touch: Touch | None, held_at: int, *, gives: bool) -> None:
        if self.are_many:
            done = self._on_lattice().solve(limits, touch, held_at, gives=gives)
            if done.listed:
                self._count(LimitTally(
                    int(gives), done.listed, done.active, done.rounds,
                    int(not done.is_reached), done.listed * done.rounds,
                    done.energy if gives else 0.0, done.missed))
        else:
            self._act_on_list(limits, touch, held_at, gives=gives)

    def _count(self, tally: LimitTally) -> None:
        self._tally.add(tally)
        self._tally_of_step.add(tally)

    def _act_on_list(
            self, limits: Limits, touch: Touch | None, held_at: int, *, gives: bool) -> None:
        program = self._solve.use(limits, touch)
        program.set_int('held_at', held_at)
        self._set_solve(program, gives=gives)
        self._begins_step = self._lists_first = False
        program.dispatch(1)
        shader_writes_visible()

    def _set_solve(self, program: Program, *, gives: bool) -> None:
        """Set what limit/solve.comp, which is in use, does besides finding impulses."""
        how = self._begins_step, self._lists_first, gives
        if how != self._solve_set:
            program.set_int('lists_first', int(self._lists_first))
            program.set_int('work_limit', self._work_limit)
            program.set_int('begins_step', int(self._begins_step))
            program.set_int('gives', int(gives))
            self._solve_set = how

    def _out_calls(self, state: State) -> list[Call]:
        """Return the calls that let dispatches read a substep that was written."""
        return state.out_texture_calls() if self._layout.texture_loads else []

    def _on_lattice(self) -> LatticeRounds:
        if self._lattice is None:
            self._lattice = LatticeRounds(self._scene, self._layout, self._lists)
        return self._lattice
