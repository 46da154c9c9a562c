# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""Mass-spring: explicit springs to 12 neighbours, symplectic Euler (paper, section 4.1)."""

from collections.abc import Collection
import math
from typing import Any
from typing import Protocol

from cloth_sim_ros.gl.buffer import Buffer
from cloth_sim_ros.gl.buffer import shader_writes_visible
from cloth_sim_ros.gl.buffer import writes_visible_call
from cloth_sim_ros.gl.program import Program
from cloth_sim_ros.gl.quick_calls import Call
from cloth_sim_ros.sim.device.layout import Layout
from cloth_sim_ros.sim.device.scene_program import SceneProgram
from cloth_sim_ros.sim.held.pin_forces import spring_tension
from cloth_sim_ros.sim.loads.forcing import Forcing
from cloth_sim_ros.sim.loads.forcing import Layers
from cloth_sim_ros.sim.loads.loads import Loads
from cloth_sim_ros.sim.model.stability import spring_substeps
from cloth_sim_ros.sim.model.stability import stability_limit
from cloth_sim_ros.sim.modes.mode import CHECKED_SUBSTEPS
from cloth_sim_ros.sim.modes.spring_tiles import SpringTiles
from cloth_sim_ros.sim.scene import Scene
from cloth_sim_ros.sim.solver.edge_law import EdgeLaw
from cloth_sim_ros.sim.solver.edge_law import spring_law
from cloth_sim_ros.sim.state import State
from cloth_sim_ros.sim.stop import leave_if
from cloth_sim_ros.sim.stop import never
from cloth_sim_ros.sim.stop import Stop
import numpy as np

# Max. nodes times substeps that are submitted between two interrupts on software [1]: a few
# milliseconds on one core.
_NODES_AT_ONCE = 2**18
# Max. substeps that are submitted between two interrupts on a GPU [1]: all up to the next check.
_SUBMITTED_AT_ONCE = CHECKED_SUBSTEPS
# Max. substeps of a tile between two checks [1]: one dispatch of 0.4 to 1 ms on a GPU, where a
# check takes some 0.1 ms.
_TILED_AT_ONCE = 256
# Fraction of a substep that counts as rounding [1].
_ROUNDING = 1e-6


class OnePass:
    """
    The fused layout: mass_spring_step.comp.

    :param acts_on_surface: whether thin colliders act on edges and faces as well as on nodes
    """

    shader = 'mass_spring_step.comp'

    def __init__(self, scene: Scene, layout: Layout, *, acts_on_surface: bool = False) -> None:
        """Compile the pass."""
        self._acts_on_surface = acts_on_surface
        self._step = SceneProgram(self.shader, scene, layout)
        # Leaves entries of held.glsl, and costs more. Both make the same state, to the bit.
        self._recording_step = SceneProgram(self.shader, scene, layout, {'HAS_HELD': 1})
        self._groups = layout.groups
        # Whether what acts on colliders reads the state that is written through textures.
        self._reads_next = layout.texture_loads
        # First entry of held.glsl that the last substep wrote; below 0: none.
        self.held_at = -1
        self._held_set: int | None = None
        self._step.use()

    def substep(
            self, state: State, forcing: Forcing, length: float,
            kick: float | None = None) -> None:
        """
        Step ``state`` on by ``length`` [s].

        :param kick: what forces act for [s], where the previous substep had another length
        """
        self.run(state, forcing, length, kick)
        state.swap()

    def substeps(self, state: State, forcing: Forcing, length: float, count: int) -> None:
        """Step ``state`` on ``count`` times by ``length`` [s], under the same forcing."""
        made = 0
        while made < count:
            entries = state.next_held_entries(count - made)
            step = self._begin(forcing, length, length, records=entries[0] >= 0)
            for entry in entries:
                self._make(state, step, forcing, entry)
                state.swap()
            made += len(entries)

    def run(
            self, state: State, forcing: Forcing, length: float,
            kick: float | None = None, *, acts: bool = True, is_kept: bool = True) -> None:
        """
        Write the state after ``length`` [s], without making it the present one.

        :param acts: False if the caller applies contact itself
        :param is_kept: False for a state that will not be the present one
        """
        self.held_at = state.next_held_entry() if is_kept else -1
        step = self._begin(
            forcing, length, length if kick is None else kick, records=self.held_at >= 0)
        self._make(state, step, forcing, self.held_at, acts=acts and is_kept)

    def act(self, forcing: Forcing, layers: Layers | None) -> None:
        """
        Let colliders, and layers of the cloth, act on what ``run`` wrote without them.

        :param layers: of the cloth that touch; None where none do
        """
        touch = forcing.touch
        if layers is None:
            if touch is not None:
                touch.act(self.held_at, on_surface=self._acts_on_surface)
        elif touch is not None:
            touch.act_beside(layers, self.held_at)
        else:
            layers.let_act()
            layers.give(self.held_at)

    def begin(self, forcing: Forcing, length: float, *, records: bool) -> Program:
        """Return the pass of substeps of ``length`` [s] in which no collider acts, set to them."""
        # Whoever makes the calls sets it, and may leave before ``made``.
        self._held_set = None
        return self._begin(forcing, length, length, records=records)

    def calls(self, state: State, step: Program) -> list[Call]:
        """Return the calls that make a substep with what ``begin`` has returned."""
        return [*state.step_calls(), *step.calls(*self._groups), writes_visible_call()]

    def made(self, step: Program, count: int, last_entry: int) -> None:
        """Count ``count`` times that ``calls`` were made, at last with ``last_entry`` held."""
        step.submitted(count)
        self.held_at = last_entry
        if last_entry >= 0:
            self._held_set = last_entry

    def _begin(
            self, forcing: Forcing, length: float, kick: float, *, records: bool) -> Program:
        program = self._recording_step if records else self._step
        step = program.use_for_step(forcing, length, kick)
        if forcing.touch is not None:
            forcing.touch.begin_explicit(step, length, on_surface=self._acts_on_surface)
            step.use()
        return step

    def _make(
            self, state: State, step: Program, forcing: Forcing, held_at: int, *,
            acts: bool = True) -> None:
        state.bind_in()
        state.bind_out()
        touch = forcing.touch
        if touch is not None:
            if self._reads_next:
                state.bind_out_textures()
            touch.list_none()
            step.use()
        # A uniform costs as much as a small dispatch.
        if held_at not in (-1, self._held_set):
            step.set_int('held_at', held_at)
            self._held_set = held_at
        step.dispatch(*self._groups)
        if touch is None or not acts:
            shader_writes_visible()
        else:
            touch.act(held_at, on_surface=self._acts_on_surface)

    def delete(self) -> None:
        """Release the pass."""
        self._step.delete()
        self._recording_step.delete()
        self._held_set = None


class SubstepPasses(Protocol):
    """Makes substeps of springs."""

    def substep(self, state: State, forcing: Forcing, length: float) -> None:
        """Step ``state`` on by ``length`` [s]."""

    def substeps(self, state: State, forcing: Forcing, length: float, count: int) -> None:
        """Step ``state`` on ``count`` times by ``length`` [s], under the same forcing."""

    def delete(self) -> None:
        """Release the passes."""


class MassSpring:
    """Forces and update in one pass."""

    name = 'mass_spring'
    is_implicit = False
    has_memory = False
    strain_bound = math.inf

    def __init__(self, scene: Scene, layout: Layout, *, check_stability: bool = True) -> None:
        """Choose the substeps and compile the passes."""
        self._scene = scene
        self.stability_limit = stability_limit(scene)
        self.substeps = spring_substeps(scene, self.name, check_stability=check_stability)
        self.last_length = self._length = scene['dt'] / self.substeps
        self.substep_margin = self._length / self.stability_limit
        self._passes = self.make_passes(scene, layout)
        self._tiles: SpringTiles | None = None
        self.checked_substeps = CHECKED_SUBSTEPS
        # Max. substeps that are made at once.
        self.most_at_once = max(1, _NODES_AT_ONCE // scene.node_count)
        if layout.is_asynchronous:
            self.most_at_once = _SUBMITTED_AT_ONCE
            if SpringTiles.can_run(scene, layout):
                self._tiles = SpringTiles(scene, layout)
                self.most_at_once = self.checked_substeps = _TILED_AT_ONCE

    @staticmethod
    def make_passes(scene: Scene, layout: Layout) -> SubstepPasses:
        """Compile and return the passes of substeps."""
        return OnePass(scene, layout, acts_on_surface=True)

    @staticmethod
    def edge_model(scene: Scene) -> str:
        """Return that edges are springs."""
        return 'springs'

    @staticmethod
    def edge_families(scene: Scene) -> Collection[str]:
        """Return those that have springs."""
        return scene.families

    def energy_law(self, state: State) -> EdgeLaw:
        """Return that of the springs."""
        return spring_law(self._scene, self._length)

    @staticmethod
    def check(scene: Scene, *, check_stability: bool = True) -> None:
        """Raise ClothSimError when dt is too long for the springs of ``scene``."""
        spring_substeps(scene, MassSpring.name, check_stability=check_stability)

    def step(self, state: State, begin: float, loads: Loads, stop: Stop = never) -> None:
        """Step ``state`` on by one dt, in substeps of equal length."""
        made = 0
        while made < self.substeps:
            leave_if(stop)
            start = begin + made * self._length
            forcing = loads.forcing(state, start, start + self._length)
            count = min(self.substeps - made, self._alike(start, loads))
            if count > 1:
                self._substeps(state, forcing, count)
            else:
                self._passes.substep(state, forcing, self._length)
            made += count

    def step_ahead(self, state: State, gravity: Forcing, most: int) -> int:
        """Make up to ``most`` steps at once under gravity alone; return how many."""
        count = min(most, self.most_at_once // self.substeps)
        if state.impulses is not None and count:
            state.impulses.expect_steps((count - 1) * self.substeps)
        self._substeps(state, gravity, count * self.substeps)
        return count

    def _substeps(self, state: State, forcing: Forcing, count: int) -> None:
        """Step ``state`` on ``count`` times by a substep, under the same forcing."""
        acts_by_node = forcing.has_regions or forcing.touch is not None
        is_recorded = state.impulses is not None and state.impulses.is_recording
        tiles = None if acts_by_node or is_recorded else self._tiles
        passes = self._passes if tiles is None else tiles
        passes.substeps(state, forcing, self._length, count)

    def _alike(self, start: float, loads: Loads) -> int:
        """Return how many substeps from ``start`` [s] on are made at once, under equal loads."""
        quiet = loads.quiet_until(start) - start
        return max(1, int(min(self.most_at_once, quiet / self._length + _ROUNDING)))

    def run_all_passes(self, state: State, loads: Loads, stop: Stop = never) -> None:
        """Make a substep of a scratch ``state``."""
        self._passes.substep(state, loads.still, self._length)
        leave_if(stop)
        if self._tiles is not None:
            self._tiles.substeps(state, loads.still, self._length, 1)

    def forget(self) -> None:
        """Forget nothing: a step depends on the state alone."""

    def report(self) -> dict[str, Any]:
        """Return nothing: there is no solver."""
        return {}

    def limit_marks(self, state: State) -> Buffer | None:
        """Return None: springs have no limit."""

    def tension(
            self, positions: np.ndarray, velocities: np.ndarray,
            nodes: np.ndarray | None = None) -> np.ndarray:
        """Return the present tension of every spring [N]."""
        return spring_tension(self._scene, positions, velocities, nodes)

    def delete(self) -> None:
        """Release the passes and their buffers."""
        self._passes.delete()
        if self._tiles is not None:
            self._tiles.delete()
