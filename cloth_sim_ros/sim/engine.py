# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""What advances and observes a state by one mode, and the engines of a cloth."""

from collections.abc import Callable
from dataclasses import dataclass
from dataclasses import replace

from cloth_sim_ros.files.errors import shown
from cloth_sim_ros.gl.context import Context
from cloth_sim_ros.gl.inventory import Inventory
from cloth_sim_ros.gl.inventory import take_inventory
from cloth_sim_ros.sim import modes
from cloth_sim_ros.sim.arguments import instance
from cloth_sim_ros.sim.device.layout import Layout
from cloth_sim_ros.sim.device.observer import Observer
from cloth_sim_ros.sim.errors import ClothSimError
from cloth_sim_ros.sim.guarded_steps import GuardedSteps
from cloth_sim_ros.sim.held.held_impulses import HeldImpulses
from cloth_sim_ros.sim.loads.forcing import Forcing
from cloth_sim_ros.sim.loads.loads import Loads
from cloth_sim_ros.sim.model.scene_fields import MODES
from cloth_sim_ros.sim.modes.mode import Mode
from cloth_sim_ros.sim.scene import Scene
from cloth_sim_ros.sim.snapshot import Measures
from cloth_sim_ros.sim.snapshot import Snapshot
from cloth_sim_ros.sim.solver.edge_law import EdgeLaw
from cloth_sim_ros.sim.state import start_state
from cloth_sim_ros.sim.state import State
from cloth_sim_ros.sim.stop import leave_if
from cloth_sim_ros.sim.stop import never
from cloth_sim_ros.sim.stop import StepAbandoned
from cloth_sim_ros.sim.stop import Stop


@dataclass(frozen=True)
class Engine:
    """
    A mode with its observer and its guard, all compiled in one context.

    :param scene: what they model
    :param layout: of the lattice they run on
    """

    scene: Scene
    layout: Layout
    context: Context
    observer: Observer
    guard: GuardedSteps
    mode: Mode

    @classmethod
    def make(
            cls, mode: str, scene: Scene, layout: Layout, state: State, context: Context, *,
            check_stability: bool, stop_at_non_finite: bool) -> 'Engine':
        """Make the engine that advances ``state``, in ``context``, which is current."""
        observer = Observer(scene, layout, observed_families(mode, scene))
        return cls(
            scene, layout, context, observer,
            GuardedSteps(scene, layout, observer, state, stop_at_non_finite),
            modes.mode_for(mode, scene)(scene, layout, check_stability=check_stability))

    def measure(self, state: State, forcing: Forcing) -> Measures:
        """Return energies and largest strain of ``state``."""
        return self.observer.measure(state, forcing, self.mode.energy_law(state))

    def snapshot(
            self, state: State, loads: Loads, *, time: float, steps: int, dt: float,
            stalled_pins: int, later: bool) -> Callable[[], Snapshot]:
        """
        Look at ``state``, which is that at ``time`` [s]; return what makes a Snapshot of it.

        :param later: True leaves it to that to wait for the device; the state may change before
        """
        mode = self.mode
        law, marks = mode.energy_law(state), mode.limit_marks(state)
        known = {
            **mode.report(), 'mode': mode.name, 'time': time, 'steps': steps, 'dt': dt,
            'substeps': mode.substeps, 'stability_margin': mode.substep_margin,
            'strain_bound': mode.strain_bound, 'stalled_pins': stalled_pins,
            'air_margin': loads.air_margin(state, time, time + dt, dt / mode.substeps)}
        find = self.observer.begin_record(
            state, loads.acting(time), law, marks, later=later)

        def make() -> Snapshot:
            measures, records = find()
            return Snapshot(**vars(measures), **known, records=records)

        return make

    def delete(self) -> None:
        """Release its buffers and programs; its context, or one beside it, has to be current."""
        for part in (self.observer, self.guard, self.mode):
            part.delete()

    def run_all_passes(self, stop: Stop = never) -> None:
        """
        Run every pass once, on a scratch cloth.

        Drivers compile a program in part when it first runs.

        :param stop: asked between passes
        :raises StepAbandoned: when ``stop`` has returned True
        """
        scene, layout = self.scene, self.layout
        state = start_state(scene, layout)
        loads = Loads(scene, layout, state)
        impulses = state.impulses = HeldImpulses(scene, layout)
        try:
            still = loads.still
            self.observer.measure(state, still, None)
            leave_if(stop)
            self.observer.record(state, still, None)
            leave_if(stop)
            self.guard.check.passes(state)
            leave_if(stop)
            loads.forcing(state, 0.0, scene['dt'])
            leave_if(stop)
            if loads.air is not None:
                loads.air.fastest_rate(state, 0.0, scene['dt'])
                leave_if(stop)
            self.mode.run_all_passes(state, loads, stop)
            if state.pinned.any():
                impulses.begin_step(state.pinned, (), {}, {})
                self.mode.run_all_passes(state, loads, stop)
                impulses.end_step({})
        finally:
            impulses.delete()
            loads.delete()
            state.delete()


def observed_families(mode: str, scene: Scene) -> frozenset[str]:
    """Return the families whose strain is looked at: those of the scene and those of ``mode``."""
    return frozenset((*scene.families, *modes.AVAILABLE[mode].edge_families(scene)))


class Preparation:
    """
    Compiles an engine on another thread, beside the context that advances the cloth meanwhile.

    Once ``run`` has returned, there is an ``engine``, or an ``error``, or it was cancelled.

    :param make: returns the engine for a context that is current
    :param beside: the context of the thread that will use the engine
    """

    def __init__(self, mode: str, make: Callable[[Context], Engine], beside: Context) -> None:
        """Prepare for ``run``."""
        self.mode = mode
        self.engine: Engine | None = None
        self.error: Exception | None = None
        self._make = make
        self._beside = beside
        self._is_cancelled = False
        self._inventory = Inventory()

    @property
    def compiled(self) -> int:
        """Return how many programs are ready by now."""
        return sum(count > 0 for count in self._inventory.dispatches())

    def cancel(self) -> None:
        """Let ``run`` return soon, after the program that is being compiled."""
        self._is_cancelled = True

    def run(self) -> None:
        """Compile; leaves no context current on this thread."""
        try:
            context = Context(beside=self._beside)
            try:
                self.engine = self._compile(context)
            finally:
                if self.engine is None:
                    context.close()
                else:
                    context.release()
        # Passed on to the thread that waits for the engine, whatever it is.
        except Exception as error:
            self.error = error

    def _compile(self, context: Context) -> Engine | None:
        with take_inventory() as self._inventory:
            engine = self._make(context)
            try:
                engine.run_all_passes(lambda: self._is_cancelled)
            except StepAbandoned:
                engine.delete()
                return None
        return engine


class Engines:
    """
    Engines by mode, compiled when a mode is first requested, and kept.

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
        """Return whether nothing is left to compile for ``mode``."""
        return mode in self._by_mode

    def check(self, mode: str) -> None:
        """Raise ClothSimError when ``mode`` can't step this scene."""
        if not isinstance(mode, str) or mode not in MODES:
            raise ClothSimError(
                f'there is no mode {shown(mode)}: choose one of {", ".join(MODES)}')
        modes.mode_for(mode, self._scene).check(self._scene, check_stability=self._check_stability)

    def use(self, mode: str) -> None:
        """Use the engine of ``mode``, without anything kept from its earlier steps."""
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
        self.in_use.run_all_passes()

    def preparation(self, mode: str) -> Preparation:
        """Return what compiles the engine of ``mode`` on another thread."""
        self.check(mode)
        return Preparation(
            mode, lambda context: self._make(mode, context), self._first_context)

    def add(self, prepared: Preparation) -> None:
        """Keep the prepared engine, unless its mode has one."""
        instance(
            prepared, Preparation, 'what is taken over', 'give what engines.preparation returns')
        if prepared.engine is None:
            raise ClothSimError(
                f'mode {prepared.mode} has not been compiled by its preparation: call run() of it '
                'and look at its error')
        self._by_mode.setdefault(prepared.mode, prepared.engine)

    def energy_law(self) -> EdgeLaw:
        """Return the law by which edges store energy now, in the mode that advances the state."""
        return self.in_use.mode.energy_law(self._state)

    def last_length(self) -> float:
        """Return the length of the last substep [s], or of the first one where none was."""
        mode = self.in_use.mode
        return mode.last_length or self._scene['dt'] / mode.substeps

    def forget(self) -> None:
        """Drop what the current mode carries over from earlier steps."""
        if self.current is not None:
            self.current.mode.forget()

    def delete(self) -> None:
        """Release everything on the device but the first context, which is current then."""
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
            return replace(current, mode=modes.mode_for(mode, self._scene)(
                self._scene, self._layout, check_stability=self._check_stability))
        return Engine.make(
            mode, self._scene, self._layout, self._state, context,
            check_stability=self._check_stability,
            stop_at_non_finite=self._stop_at_non_finite)
