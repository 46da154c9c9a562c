# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""The engines of a cloth, one for each mode that was asked for, and which of them is in use."""

from dataclasses import replace

from cloth_sim_ros.files.errors import shown
from cloth_sim_ros.gl.context import Context
from cloth_sim_ros.sim import modes
from cloth_sim_ros.sim.engine import Engine
from cloth_sim_ros.sim.engine import observed_families
from cloth_sim_ros.sim.engine import Preparation
from cloth_sim_ros.sim.errors import ClothSimError
from cloth_sim_ros.sim.layout import Layout
from cloth_sim_ros.sim.scene import Scene
from cloth_sim_ros.sim.scene_fields import MODES
from cloth_sim_ros.sim.solver.edge_law import EdgeLaw
from cloth_sim_ros.sim.state import State


class Engines:
    """
    Engines by mode, compiled when a mode is first asked for, and kept.

    :param state: what they advance
    :param context: in which engines are made that nobody has prepared
    """

    def __init__(
            self, scene: Scene, layout: Layout, state: State, context: Context, *,
            check_stability: bool, stop_at_non_finite: bool) -> None:
        """Begin without an engine."""
        self._scene = scene
        self._layout = layout
        self._state = state
        self._first_context = context
        self._check_stability = check_stability
        self._stop_at_non_finite = stop_at_non_finite
        self._by_mode: dict[str, Engine] = {}
        self.current: Engine | None = None

    @property
    def in_use(self) -> Engine:
        """Return the engine of the mode in use; ClothSimError before there is one."""
        if self.current is None:
            raise ClothSimError(
                'no mode is compiled yet: compile one with set_mode, or activate a prepared one')
        return self.current

    @property
    def context(self) -> Context:
        """Return the context of the engine in use."""
        return self.current.context if self.current else self._first_context

    @property
    def mode(self) -> str:
        """Return the mode in use, or the one the scene begins with."""
        return self.current.mode.name if self.current else self._scene['mode']

    def has(self, mode: str) -> bool:
        """Tell whether nothing is left to compile for ``mode``."""
        return mode in self._by_mode

    def check(self, mode: str) -> None:
        """Raise ClothSimError when ``mode`` can't step this scene."""
        if mode not in MODES:
            raise ClothSimError(
                f'there is no mode {shown(mode)}: choose one of {", ".join(MODES)}')
        modes.AVAILABLE[mode].check(self._scene, check_stability=self._check_stability)

    def use(self, mode: str) -> None:
        """Use the engine of ``mode``, which takes the state as it comes."""
        self.check(mode)
        self.context.make_current()
        if mode not in self._by_mode:
            self._by_mode[mode] = self._make(mode, self.context)
        engine = self._by_mode[mode]
        if engine is not self.current:
            self.context.finish()
            self.current = engine
            engine.context.make_current()
            engine.mode.forget()

    def compile_all(self) -> None:
        """Compile all that the mode in use can need, not each part when it is first used."""
        self.context.make_current()
        modes.finish(self.in_use.run_all_passes())

    def preparation(self, mode: str) -> Preparation:
        """Return what compiles the engine of ``mode`` on another thread."""
        self.check(mode)
        return Preparation(
            mode, lambda context: self._make(mode, context), self._first_context)

    def add(self, prepared: Preparation) -> None:
        """Have the engine that was prepared, if there is none of its mode yet."""
        assert prepared.engine is not None  # it has run, without an error
        self._by_mode.setdefault(prepared.mode, prepared.engine)

    def energy_law(self) -> EdgeLaw:
        """Return the law by which edges store energy now, in the mode that advances the state."""
        return self.in_use.mode.energy_law(self._state)

    def forget(self) -> None:
        """Let the mode in use take the next state as it comes."""
        if self.current is not None:
            self.current.mode.forget()

    def delete(self) -> None:
        """Give everything on the device back but the first context, which is current then."""
        self._first_context.make_current()
        engines = self._by_mode.values()
        # Engines of one context can have observer and guard in common.
        parts = {id(part): part for engine in engines
                 for part in (engine.observer, engine.guard, engine.mode)}
        for part in parts.values():
            part.delete()
        for context in {engine.context for engine in engines} - {self._first_context}:
            context.close()
        self._first_context.make_current()

    def _make(self, mode: str, context: Context) -> Engine:
        current = self.current
        if (current is not None and context is current.context
                and observed_families(mode, self._scene) == current.observer.families):
            return replace(current, mode=modes.AVAILABLE[mode](
                self._scene, self._layout, check_stability=self._check_stability))
        return Engine.make(
            mode, self._scene, self._layout, self._state, context,
            check_stability=self._check_stability,
            stop_at_non_finite=self._stop_at_non_finite)
