# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""The paper's adaptive scheme (Tab. 9): an edge beyond the limit is pulled to its rest length."""

from collections.abc import Collection
from typing import Any

from cloth_sim_ros.gl.buffer import Buffer
from cloth_sim_ros.gl.buffer import shader_writes_visible
from cloth_sim_ros.sim.device import bindings
from cloth_sim_ros.sim.device.layout import Layout
from cloth_sim_ros.sim.device.scene_program import SceneProgram
from cloth_sim_ros.sim.held.pin_forces import spring_tension
from cloth_sim_ros.sim.limits.limit_marks import LimitMarks
from cloth_sim_ros.sim.loads.forcing import Forcing
from cloth_sim_ros.sim.loads.loads import Loads
from cloth_sim_ros.sim.model.edge_kinds import EDGE_KINDS
from cloth_sim_ros.sim.model.stability import spring_substeps
from cloth_sim_ros.sim.model.stability import stability_limit
from cloth_sim_ros.sim.modes.edge_watch import StrainWatch
from cloth_sim_ros.sim.modes.mass_spring import OnePass
from cloth_sim_ros.sim.modes.mode import CHECKED_SUBSTEPS
from cloth_sim_ros.sim.scene import Scene
from cloth_sim_ros.sim.solver.edge_law import EdgeLaw
from cloth_sim_ros.sim.solver.edge_law import spring_law
from cloth_sim_ros.sim.state import State
from cloth_sim_ros.sim.stop import leave_if
from cloth_sim_ros.sim.stop import never
from cloth_sim_ros.sim.stop import Stop
import numpy as np

_COLOURS = 4
_TENSION_BYTES = 16
_LOCAL = (8, 2)
_DEFINES = {'LOCAL_X': _LOCAL[0], 'LOCAL_Y': _LOCAL[1]}
# The edge of a cell that starts at its second corner.
_CROSSING = next(kind.number for kind in EDGE_KINDS if kind.name == 'crossing')
# Enough for the linear system of a small cloth; the error falls by some 10 % a sweep.
_SWEEPS = 60
# Strain over the limit from which on an edge is near it [1].
_NEAR = 0.9


class PaperSweeps:
    """The passes paper/sweep.comp and paper/finish.comp, and the tensions they work on."""

    def __init__(self, scene: Scene, layout: Layout) -> None:
        """Compile the passes and allocate the tensions."""
        self._layout = layout
        self._sweep = SceneProgram('paper/sweep.comp', scene, layout, _DEFINES)
        self._finish = SceneProgram('paper/finish.comp', scene, layout, _DEFINES)
        self._recording_finish = SceneProgram(
            'paper/finish.comp', scene, layout, {**_DEFINES, 'HAS_HELD': 1})
        # Cells of a colour lie in every other column and row.
        self._groups = tuple(
            -(-nodes // (2 * local)) for nodes, local in zip((layout.cols, layout.rows), _LOCAL))
        self._node_groups = tuple(
            -(-nodes // local) for nodes, local in zip((layout.cols, layout.rows), _LOCAL))
        self.tensions = Buffer(layout.stored * _TENSION_BYTES)
        self._sweep.use()
        self._finish.use()

    def run(self, state: State, count: int, length: float, kick: float) -> None:
        """
        Sweep ``count`` times over velocities that a pass has written but not made present.

        :param length: of the substep [s]
        :param kick: what tensions act for in it [s]
        """
        self.tensions.bind_storage(bindings.TENSION)
        if self._layout.texture_loads:
            self.tensions.bind_texture(bindings.TENSION)
            state.bind_out_for_reading()
        sweep = self._sweep.use()
        sweep.set_float('substep', length)
        sweep.set_float('kick', kick)
        for _ in range(count):
            for colour in range(_COLOURS):
                sweep.set_int('colour', colour)
                sweep.dispatch(*self._groups)
                shader_writes_visible()

    def finish(self, state: State, length: float, kick: float, held_at: int) -> None:
        """
        Move the nodes of the substep of ``length`` [s] that ``run`` was given.

        :param held_at: where its entries of held.glsl are; below 0: nowhere
        """
        if self._layout.texture_loads:
            state.bind_in()
        finish = (self._finish if held_at < 0 else self._recording_finish).use()
        finish.set_float('substep', length)
        if held_at >= 0:
            finish.set_float('kick', kick)
            finish.set_int('held_at', held_at)
        finish.dispatch(*self._node_groups)
        shader_writes_visible()
        state.swap()

    def read_tensions(self) -> np.ndarray:
        """Return what holds each edge [N], (rows, cols, 6) float32 as in Snapshot."""
        rows, cols = self._layout.rows, self._layout.cols
        stored = np.empty((self._layout.stored, 4), dtype=np.float32)
        self.tensions.read_into(stored)
        cells = self._layout.load(stored)
        held = np.zeros((rows, cols, len(EDGE_KINDS)), dtype=np.float32)
        held[..., :_CROSSING] = cells[..., :_CROSSING]
        held[:, 1:, _CROSSING] = cells[:, :-1, _CROSSING]
        return held

    def clear(self) -> None:
        """Make all tensions zero."""
        self.tensions.write(np.zeros(self.tensions.bytes, dtype=np.uint8))

    def delete(self) -> None:
        """Release passes and tensions."""
        self.tensions.delete()
        self._sweep.delete()
        self._finish.delete()
        self._recording_finish.delete()


class _Springs(OnePass):
    """Springs within the limit; the sweeps have the last word on the velocities."""

    shader = 'paper/spring_velocity.comp'


class PaperLimit:
    """
    Explicit springs within the limit, constraints to rest length beyond it.

    Kept for comparison: it fails at steps that other schemes take (docs/explanation/adaptive.md).

    :param length: of each substep [s]
    """

    def __init__(
            self, scene: Scene, layout: Layout, length: float) -> None:
        """Compile the passes."""
        self._length = length
        self._springs = _Springs(scene, layout)
        self._sweeps = PaperSweeps(scene, layout)

    def advance(
            self, state: State, begin: float, seconds: float, loads: Loads,
            stop: Stop = never) -> None:
        """Step ``state`` on by ``seconds``, some substeps."""
        for substep in range(round(seconds / self._length)):
            leave_if(stop)
            start = begin + substep * self._length
            self._substep(state, loads.forcing(state, start, start + self._length))

    def run_all_passes(self, state: State, loads: Loads) -> None:
        """Make a substep of a scratch ``state``."""
        self._substep(state, loads.still)

    def tensions(self) -> np.ndarray:
        """Return what each edge was pulled back with in the last substep [N], 0 if it was not."""
        return self._sweeps.read_tensions()

    def delete(self) -> None:
        """Release passes and buffers."""
        self._springs.delete()
        self._sweeps.delete()

    def _substep(self, state: State, forcing: Forcing) -> None:
        self._sweeps.clear()
        self._springs.run(state, forcing, self._length)
        self._sweeps.run(state, _SWEEPS, self._length, self._length)
        self._sweeps.finish(state, self._length, self._length, self._springs.held_at)


class PaperAdaptive:
    """
    Mode adaptive with the limit of the paper, ``adaptive.scheme: paper``.

    Springs alone while no edge comes near its limit, the paper's substeps while some do.
    """

    name = 'adaptive'
    is_implicit = False
    has_memory = True
    checked_substeps = CHECKED_SUBSTEPS

    def __init__(self, scene: Scene, layout: Layout, *, check_stability: bool = True) -> None:
        """Choose the substeps and compile the passes."""
        self.stability_limit = stability_limit(scene)
        self.substeps = spring_substeps(scene, self.name, check_stability=check_stability)
        self.strain_bound: float = scene['adaptive.threshold']
        self._scene = scene
        self._dt: float = scene['dt']
        self.last_length = self._length = self._dt / self.substeps
        self.substep_margin = self._length / self.stability_limit
        self._springs = OnePass(scene, layout)
        self._watch = StrainWatch(scene, layout, _NEAR * self.strain_bound)
        self._limit = PaperLimit(scene, layout, self._length)
        self._marks = LimitMarks(scene, layout)
        self._is_limited = self._is_marked = False

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
        spring_substeps(scene, PaperAdaptive.name, check_stability=check_stability)

    def energy_law(self, state: State) -> EdgeLaw:
        """Return that of the springs: what holds an edge at its limit stores nothing."""
        return spring_law(self._scene, self._length)

    def step(self, state: State, begin: float, loads: Loads, stop: Stop = never) -> None:
        """Step ``state`` on by one dt."""
        self._is_marked = False
        made = 0
        while made < self.substeps:
            leave_if(stop)
            now = begin + made * self._length
            left = self.substeps - made
            calm = min(left, self._watch.calm_substeps(state, now, self._length, loads))
            self._is_limited = calm == 0
            for index in range(calm):
                start = now + index * self._length
                self._springs.substep(
                    state, loads.forcing(state, start, start + self._length), self._length)
            if calm:
                self._watch.advance(calm)
            else:
                self._limit.advance(state, now, left * self._length, loads, stop)
            made += calm or left

    @staticmethod
    def step_ahead(state: State, gravity: Forcing, most: int) -> int:
        """Return 0: each step depends on the previous one."""
        return 0

    def run_all_passes(self, state: State, loads: Loads, stop: Stop = never) -> None:
        """Make substeps with and without limit of a scratch ``state``."""
        self._watch.strains(state, loads.still, self._length)
        leave_if(stop)
        self._springs.substep(state, loads.still, self._length)
        leave_if(stop)
        self._limit.run_all_passes(state, loads)
        self._marks.update(state, self.strain_bound, None)
        self.forget()

    def forget(self) -> None:
        """Hold no edge and expect nothing of the state."""
        self._is_limited = self._is_marked = False
        self._watch.forget()
        self._marks.forget()

    def report(self) -> dict[str, Any]:
        """Return how many edges are at their limit or changed."""
        return self._marks.report()

    def limit_marks(self, state: State) -> Buffer | None:
        """Return which edges are at their limit; None if none are."""
        if not self._is_marked:
            self._is_marked = True
            if self._is_limited:
                self._marks.update(state, self.strain_bound, None)
            else:
                self._marks.clear()
        return self._marks.buffer

    def tension(
            self, positions: np.ndarray, velocities: np.ndarray,
            nodes: np.ndarray | None = None) -> np.ndarray:
        """Return what each edge was pulled back with in the last substep, or its spring's [N]."""
        springs = spring_tension(self._scene, positions, velocities, nodes)
        if not self._is_limited:
            return springs
        held = self._limit.tensions()
        return np.where(held == 0.0, springs, held)

    def delete(self) -> None:
        """Release everything."""
        for part in (self._springs, self._watch, self._limit, self._marks):
            part.delete()
