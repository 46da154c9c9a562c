# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""Look at the state: records of all nodes, or only the energies and the largest strain."""

from collections.abc import Callable
from collections.abc import Set

from cloth_sim_ros.gl.buffer import Buffer
from cloth_sim_ros.gl.buffer import shader_writes_visible
from cloth_sim_ros.gl.program import Program
from cloth_sim_ros.gl.read_back import ReadBack
from cloth_sim_ros.sim.device import bindings
from cloth_sim_ros.sim.device.layout import Layout
from cloth_sim_ros.sim.device.scene_program import SceneProgram
from cloth_sim_ros.sim.loads.forcing import Forcing
from cloth_sim_ros.sim.model.edge_kinds import edge_defines
from cloth_sim_ros.sim.scene import Scene
from cloth_sim_ros.sim.snapshot import Measures
from cloth_sim_ros.sim.snapshot import POINT_DTYPE
from cloth_sim_ros.sim.solver.edge_law import EdgeLaw
from cloth_sim_ros.sim.solver.edge_law import set_law
from cloth_sim_ros.sim.state import State
import numpy as np

# Invocations of a workgroup along a row and a column [1], and nodes of a column for each.
_LOCAL = (16, 2)
_STRIP = 16
# Sums of observe.comp for each strip [1].
_SUMS = 5
# Size of the records that are looked at together [bytes]: those of a large cloth outgrow a storage
# block.
_SLAB_BYTES = 32 * 2**20


class Observer:
    """
    Runs observe.comp; compiles and allocates for records only when they are requested.

    :param families: of the edges that there are
    """

    def __init__(self, scene: Scene, layout: Layout, families: Set[str]) -> None:
        """Prepare for ``scene``; nothing is compiled yet."""
        self.families = families
        self._scene = scene
        self._slab_rows = max(
            _STRIP, min(scene.rows, _SLAB_BYTES // (POINT_DTYPE.itemsize * scene.cols)))
        choices = {
            'LOCAL_X': _LOCAL[0], 'LOCAL_Y': _LOCAL[1], 'STRIP': _STRIP, **edge_defines(families)}
        self._programs = {
            wanted: SceneProgram(
                'observe.comp', scene, layout, {**choices, 'RECORDS_WANTED': int(wanted)})
            for wanted in (False, True)}
        strips = -(-self._slab_rows // _STRIP)
        self._partial_sums = np.empty((strips * scene.cols, _SUMS), dtype=np.float32)
        self._sums_buffer = Buffer(self._partial_sums.nbytes, is_polled=True)
        self._records_buffer: Buffer | None = None
        self._read_back = ReadBack()
        self._law: EdgeLaw | None = None
        self._law_in_newtons: EdgeLaw

    def measure(self, state: State, forcing: Forcing, law: EdgeLaw | None) -> Measures:
        """
        Return energies, largest strain and finiteness of ``state``.

        :param law: of the edges, which says what they store; None where nobody asks for energies
        """
        return self._observe(state, forcing, law, None)

    def record(
            self, state: State, forcing: Forcing, law: EdgeLaw | None,
            limit_marks: Buffer | None = None) -> tuple[Measures, np.ndarray]:
        """
        Return the measures and the (rows, cols) records of ``state``.

        :param law: as in ``measure``; does not matter to the records
        :param limit_marks: which edges are at their limit, as limit_mark.comp leaves them
        """
        records = np.empty((self._scene.rows, self._scene.cols), dtype=POINT_DTYPE)
        return self._observe(state, forcing, law, records, limit_marks), records

    def begin_record(
            self, state: State, forcing: Forcing, law: EdgeLaw | None,
            limit_marks: Buffer | None = None, *,
            later: bool = True) -> Callable[[], tuple[Measures, np.ndarray]]:
        """
        Begin to look as ``record`` does; return what waits for the device and returns the same.

        The state may change meanwhile. A cloth of several slabs is recorded at once.

        :param later: False records at once, in no memory besides
        """
        if not later or self._slab_rows < self._scene.rows:
            found = self.record(state, forcing, law, limit_marks)
            return lambda: found
        records = np.empty((self._scene.rows, self._scene.cols), dtype=POINT_DTYPE)
        sums = np.empty_like(self._partial_sums)
        program = self._bind(state, forcing, law, limit_marks, has_records=True)
        self._dispatch(program, 0, self._scene.rows)
        wait = self._read_back.begin(
            [(self._sums_buffer, sums), (self._records(), records)])

        def finish() -> tuple[Measures, np.ndarray]:
            wait()
            return self._measures(_added(np.zeros(_SUMS), sums)), records

        return finish

    def _in_newtons(self, law: EdgeLaw) -> EdgeLaw:
        # Over the mass of a node that weighs nothing, energies would leave float32.
        if law is not self._law:
            self._law, self._law_in_newtons = law, law.times(self._scene.node_mass)
        return self._law_in_newtons

    def delete(self) -> None:
        """Release passes and buffers."""
        for program in self._programs.values():
            program.delete()
        self._read_back.delete()
        self._sums_buffer.delete()
        if self._records_buffer is not None:
            self._records_buffer.delete()

    def _observe(
            self, state: State, forcing: Forcing, law: EdgeLaw | None,
            records: np.ndarray | None, limit_marks: Buffer | None = None) -> Measures:
        program = self._bind(
            state, forcing, law, limit_marks, has_records=records is not None)
        totals = np.zeros(_SUMS)
        for first in range(0, self._scene.rows, self._slab_rows):
            rows = min(self._slab_rows, self._scene.rows - first)
            strips = self._dispatch(program, first, rows)
            sums = self._partial_sums[:strips * self._scene.cols]
            self._sums_buffer.read_into(sums)
            totals = _added(totals, sums)
            if records is not None:
                self._records().read_into(records[first:first + rows])
        return self._measures(totals)

    def _records(self) -> Buffer:
        if self._records_buffer is None:
            self._records_buffer = Buffer(
                self._slab_rows * self._scene.cols * POINT_DTYPE.itemsize)
        return self._records_buffer

    def _bind(
            self, state: State, forcing: Forcing, law: EdgeLaw | None,
            limit_marks: Buffer | None, *, has_records: bool) -> Program:
        program = self._programs[has_records].use()
        forcing.apply(program)
        forcing.bind()
        program.set_int('pushed_everywhere', int(forcing.pushed_everywhere))
        if law is not None:
            set_law(program, self._in_newtons(law))
            program.set_int('acts_between_pins', int(law.acts_between_pins))
        state.bind_in()
        self._sums_buffer.bind_storage(bindings.PARTIAL_SUMS)
        if has_records:
            records = self._records()
            records.bind_storage(bindings.RECORDS)
            # Without marks the shader reads none, but a driver may want something to be bound.
            (limit_marks or records).bind_storage(bindings.AT_LIMIT)
            program.set_int('has_limit_marks', int(limit_marks is not None))
        return program

    def _dispatch(self, program: Program, first: int, rows: int) -> int:
        """Look at a slab; return how many strips it has."""
        program.set_int('first_row', first)
        program.set_int('slab_rows', rows)
        strips = -(-rows // _STRIP)
        program.dispatch(-(-self._scene.cols // _LOCAL[0]), -(-strips // _LOCAL[1]))
        shader_writes_visible()
        return strips

    def _measures(self, totals: np.ndarray) -> Measures:
        mass = self._scene.node_mass
        return Measures(
            kinetic_energy=float(mass * totals[0]), elastic_energy=float(totals[1]),
            gravitational_energy=float(mass * totals[2]), max_strain=float(totals[3]),
            finite=bool(totals[4] == 0))


def _added(totals: np.ndarray, sums: np.ndarray) -> np.ndarray:
    """Return ``totals`` with those of a slab: largest values are not added."""
    added = totals + sums.sum(axis=0, dtype=np.float64)
    added[3] = max(totals[3], float(sums[:, 3].max()))
    return added
