# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""Contacts of thin colliders with nodes, edges and faces, in the solves of the implicit step."""

from cloth_sim_ros.gl.buffer import Buffer
from cloth_sim_ros.gl.buffer import shader_writes_visible
from cloth_sim_ros.gl.program import Program
from cloth_sim_ros.sim.device import bindings
from cloth_sim_ros.sim.device.layout import Layout
from cloth_sim_ros.sim.device.scene_program import SceneProgram
from cloth_sim_ros.sim.loads.forcing import Forcing
from cloth_sim_ros.sim.loads.forcing import touch_of
from cloth_sim_ros.sim.model.colliders import rows_of
from cloth_sim_ros.sim.model.colliders import surface_defines
from cloth_sim_ros.sim.scene import Scene
from cloth_sim_ros.sim.solver.edge_law import EdgeLaw
from cloth_sim_ros.sim.solver.solver_buffers import Levels
from cloth_sim_ros.sim.solver.solver_programs import SolverPass
from cloth_sim_ros.sim.solver.solver_programs import SolverPrograms
from cloth_sim_ros.sim.solver.start import Start
from cloth_sim_ros.sim.state import State
import numpy as np

# Invocations of the workgroup [1].
_LOCAL_ON_SOFTWARE = 16
_LOCAL_ON_GPU = 256
# Way by which a point may enter a collider without another solve [m].
_MOST_UNSOLVED = 1e-6
# Size of a contact and of a node in surface_contacts.glsl [bytes].
_CONTACT_BYTES, _NODE_BYTES = 96, 32
# Nodes of a contact [1].
_NODES = 3
# What surface_product.comp adds to.
RESIDUAL, SMOOTHED, DEFECT, PRODUCT = range(4)


class SolverSurface:
    """
    Contacts as terms of the system, by augmented Lagrangians (docs/explanation/contact.md).

    The solver's buffers have to be bound.

    :param levels: of the solver
    :param sum_at: entry of the sums where the product of contacts is left
    """

    def __init__(
            self, scene: Scene, state: Layout, programs: SolverPrograms, levels: Levels,
            sum_at: int) -> None:
        """Allocate; what each iteration needs is compiled."""
        thin = scene.thin_colliders
        local = _LOCAL_ON_GPU if state.is_asynchronous else _LOCAL_ON_SOFTWARE
        defines: dict[str, object] = {
            'SURFACE_LOCAL': local, **surface_defines(scene.colliders, thin)}
        cloth = levels.cloth
        contacts = (
            cloth.stored * len(thin)
            * (1 + max(rows_of(scene.colliders[number]) for number in thin)))
        self._programs = programs
        self._groups = cloth.node_groups
        self._contacts = Buffer(np.zeros(contacts * _CONTACT_BYTES // 4, dtype=np.float32))
        self._nodes = Buffer(np.zeros(cloth.stored * _NODE_BYTES // 4, dtype=np.float32))
        self._lists = Buffer(np.zeros(
            cloth.stored * (len(thin) + 1) + contacts * (1 + _NODES), dtype=np.uint32))
        self._counts = Buffer(np.zeros(4, dtype=np.uint32), is_polled=True)
        self._buffers = self._contacts, self._nodes, self._lists, self._counts
        self._product = programs.make('surface_product.comp', **defines)
        self._product.set_int('sum_at', sum_at)
        self._sum_at = sum_at
        self._find = {
            stage: SceneProgram('solver/surface_find.comp', scene, state, {
                **programs.defines, **defines, 'STAGE': stage}) for stage in ('BEGIN', 'AGAIN')}
        self._list, self._weigh, self._search, self._give, self._record = (
            SceneProgram(f'solver/surface_{name}.comp', scene, state, {
                **programs.defines, **defines, 'HELD_BINDING': bindings.SURFACE_HELD})
            for name in ('list', 'weigh', 'search', 'give', 'record'))
        # Forcing and length of the solve that was weighed last.
        self._touch: tuple[Forcing, float] | None = None
        # The thin colliders, as bits.
        self.bits = sum(1 << number for number in thin)
        # Whether anything is in contact, or may be.
        self.has_contacts = False

    def adds_to(self, kind: int, field: int, into: int = 0, **uniforms: int) -> SolverPass:
        """
        Return the pass that adds what contacts add to a pass over the cloth.

        :param kind: of those above
        :param field: of SolverBuffers, that is multiplied
        :param into: the field that it is added to
        """
        return SolverPass(
            self._product, (1, 1), into=kind, field=field, into_field=into, **uniforms)

    def begin(
            self, state: State, forcing: Forcing, length: float, kick: float,
            guess: float) -> None:
        """Find what may touch in a substep, as SolverContacts.begin and after it."""
        self._counts.write(np.zeros(2, dtype=np.uint32))
        program = self._use(self._find['BEGIN'], forcing, length, kick)
        program.set_float('guess', guess)
        self._run_find(program, state)

    def weigh(self, state: State, forcing: Forcing, law: EdgeLaw, start: Start) -> None:
        """
        Choose what acts in a solve, and add it to the right side.

        :param start: change of velocity to expect
        """
        if not self.has_contacts:
            return
        self._touch = forcing, law.length
        program = self._use(self._weigh, forcing, law.length, law.length)
        start.set_in(program)
        program.set_floats('bending_bound', law.bending_bounds)
        self._run(program, state)

    def look(self, state: State, share: float, start: Start) -> None:
        """
        Leave the sums of limit_search.comp, of contacts, of the last solve.

        :param share: of the way from start to solution
        """
        assert self._touch is not None
        forcing, length = self._touch
        program = self._use(self._search, forcing, length, length)
        start.set_in(program)
        program.set_float('share', share)
        program.set_int('sum_at', self._sum_at)
        self._run(program, state)

    def give(self, state: State, forcing: Forcing, length: float) -> None:
        """Take the impulses from a solution that was applied, and ask whether they suffice."""
        if self.has_contacts:
            self._run(self._use(self._give, forcing, length, length), state)

    def find_again(self, state: State, forcing: Forcing, length: float) -> None:
        """Find what else is entered by the velocities that a solve has led to."""
        self._run_find(self._use(self._find['AGAIN'], forcing, length, length), state)

    def record(self, state: State, forcing: Forcing, length: float, held_at: int) -> None:
        """
        Record the impulses of a substep that ends.

        :param held_at: where its entries of held.glsl are; below 0: nowhere
        """
        program = self._use(self._record, forcing, length, length)
        program.set_int('held_at', held_at)
        if held_at >= 0:
            assert state.impulses is not None  # it has given held_at
            state.impulses.bind(bindings.SURFACE_HELD)
        self._run(program, state)

    def forget(self) -> None:
        """Drop all impulses."""
        for buffer in self._buffers:
            buffer.clear()
        self.has_contacts = False

    def delete(self) -> None:
        """Release everything but what each iteration needs, which SolverPrograms does."""
        for program in (
                *self._find.values(), self._list, self._weigh, self._search, self._give,
                self._record):
            program.delete()
        for buffer in self._buffers:
            buffer.delete()

    def bind(self) -> None:
        """Let the passes of the solver reach contacts."""
        self._contacts.bind_storage(bindings.SURFACE_ROWS)
        self._nodes.bind_storage(bindings.SURFACE_NODES)
        self._lists.bind_storage(bindings.SURFACE_LISTS)
        self._counts.bind_storage(bindings.SURFACE_COUNTS)

    def _use(
            self, program: SceneProgram, forcing: Forcing, length: float,
            kick: float) -> Program:
        used = program.use_for_step(forcing, length, kick)
        self._programs.set_sizes(used)
        used.set_float('most_unsolved', _MOST_UNSOLVED)
        touch_of(forcing).set_in(used, length)
        self.bind()
        return used

    def _run(self, program: Program, state: State) -> None:
        state.bind_in()
        program.dispatch(1)
        shader_writes_visible()

    def _run_find(self, program: Program, state: State) -> None:
        state.bind_in()
        program.dispatch(*self._groups)
        shader_writes_visible()
        counts = np.empty(2, dtype=np.uint32)
        self._counts.read_into(counts)
        if counts[1]:
            program = self._list.use()
            self._programs.set_sizes(program)
            program.dispatch(1)
            shader_writes_visible()
        self.has_contacts = bool(counts[0])
