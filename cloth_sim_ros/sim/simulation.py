# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""A running cloth: owns the state on the device and steps it."""

from collections.abc import Callable
from collections.abc import Generator
from collections.abc import Iterator
from collections.abc import Sequence
from contextlib import AbstractContextManager
from contextlib import closing
from contextlib import contextmanager
import math

from cloth_sim_ros.gl.context import Context
from cloth_sim_ros.sim import modes
from cloth_sim_ros.sim.engine import Preparation
from cloth_sim_ros.sim.engines import Engines
from cloth_sim_ros.sim.errors import ClothSimError
from cloth_sim_ros.sim.forces import pulled_too_hard
from cloth_sim_ros.sim.forces import with_forces
from cloth_sim_ros.sim.input_listener import CLEAR_PUSHES
from cloth_sim_ros.sim.input_listener import InputListener
from cloth_sim_ros.sim.input_listener import RESET
from cloth_sim_ros.sim.layout import choose_layout
from cloth_sim_ros.sim.loads import Loads
from cloth_sim_ros.sim.near_node import NearNode
from cloth_sim_ros.sim.nearest import nearest
from cloth_sim_ros.sim.pin_forces import PinForces
from cloth_sim_ros.sim.pin_motion import PinMotion
from cloth_sim_ros.sim.pin_motion import PinRequests
from cloth_sim_ros.sim.pin_path import PinMove
from cloth_sim_ros.sim.pin_path import PinPath
from cloth_sim_ros.sim.push import Push
from cloth_sim_ros.sim.push_field import AppliedPush
from cloth_sim_ros.sim.scene import Scene
from cloth_sim_ros.sim.snapshot import Measures
from cloth_sim_ros.sim.snapshot import Snapshot
from cloth_sim_ros.sim.state import State
from cloth_sim_ros.sim.stepping import RunStatus
from cloth_sim_ros.sim.stepping import Stepping
import numpy as np

# Below this many nodes llvmpipe is faster without its worker threads (docs/notes/performance.md).
SINGLE_THREAD_NODES = 128 * 128


class Simulation(RunStatus, AbstractContextManager['Simulation']):
    """
    A simulated cloth. Use it only on the thread that created it.

    As a context manager it is closed at the end of the block.

    ``advance`` and ``step`` return when all is done. A caller who must not wait so long gives
    ``stepping`` an aim, and does the ``work`` in pieces. Between pieces a step can be under way:
    what is read then is the state before it, and what is changed is checked at once and changed
    at its end, at ``stepping.edit_time``. What modes need is compiled beforehand by ``engines``.

    :param scene: what to model
    :param context: GL context to use; by default one of its own
    :param check_stability: False allows a dt above the stability limit, for studies
    :param stop_at_non_finite: False continues with a non-finite state, for studies
    :param compiles: False leaves it to ``engines``, without which nothing can be advanced or
        measured
    :raises ClothSimError: when the scene can't be run as it asks
    :raises DeviceError: when there is no device for it
    """

    def __init__(
            self, scene: Scene, *, context: Context | None = None,
            check_stability: bool = True, stop_at_non_finite: bool = True,
            compiles: bool = True) -> None:
        """Compile, allocate and take up the start pose."""
        self.scene = scene
        self.dt: float = scene['dt']
        self._owns_context = context is None
        context = context or Context(single_thread=scene.node_count < SINGLE_THREAD_NODES)
        context.make_current()
        self._first_context = context
        self.device = context.device
        self.layout = choose_layout(scene, context)
        self._state = State(self.layout, scene.start_positions(), scene.pinned_nodes())
        self.engines = Engines(
            scene, self.layout, self._state, context, check_stability=check_stability,
            stop_at_non_finite=stop_at_non_finite)
        self.engines.check(scene['mode'])
        if compiles:
            self.engines.use(scene['mode'])
        self.listener = InputListener()
        self._is_closed = False
        self.loads = Loads(scene, self.layout, self._state)
        self._begin_run()

    def __exit__(self, *_: object) -> None:
        """Close, however the block has ended."""
        self.close()

    @property
    def pushes(self) -> tuple[AppliedPush, ...]:
        """Return the pushes that act or will act."""
        return self.loads.pushes.applied

    def warm_up(self) -> None:
        """Compile all that the present mode can need, not each part when it is first used."""
        self.engines.compile_all()

    def advance(self, seconds: float) -> int:
        """
        Simulate ``seconds`` more; a remainder below dt is carried over to the next call.

        :return: steps of dt made
        :raises NonFiniteStateError: when the state is lost; the last finite one is kept
        """
        first = self.steps
        self.stepping.aim(seconds)
        self._finish_work()
        return self.steps - first

    def step(self, count: int = 1) -> None:
        """Make ``count`` steps of dt; as advance, stop at the last finite state."""
        self.stepping.aim_steps(count)
        self._finish_work()

    def work(self, is_due: Callable[[], bool]) -> modes.Pieces:
        """
        Make steps towards the aim; whenever ``is_due`` asks for it, end them, or yield within one.

        Closed while a step is under way, it undoes that step, and drops changes that waited.

        :raises NonFiniteStateError: when the state is lost; the last finite one is kept
        """
        engine, stepping = self.engines.in_use, self.stepping
        engine.context.make_current()

        def make_steps(first: int, count: int) -> Generator[None, None, None]:
            return engine.guard.make(
                first, count, self._make_step, engine.mode, self.loads, [self._pin_motion],
                is_due=lambda: stepping.has_edits or is_due(), settle=stepping.settle)

        with closing(stepping.run(make_steps)) as pieces:
            for _ in pieces:
                yield
                engine.context.make_current()

    def push(
            self, force: Sequence[float], *, duration: float, region: str = 'all',
            center: Sequence[float] = (0.0, 0.0, 0.0), radius: float = 0.0,
            start: float | None = None) -> AppliedPush:
        """
        Push the cloth with a total ``force`` [N] for ``duration`` [s] of simulated time.

        :param region: all, or sphere: the free nodes within ``radius`` of ``center`` [m]
            when the push begins; one to come that finds none does nothing
        :param start: simulated time at which it begins [s]; now by default
        :raises ClothSimError: when a value is wrong or no free node is in the region
        """
        begin = self.stepping.edit_time if start is None else start
        push = Push.checked(
            force=force, start=begin, duration=duration, region=region, center=center,
            radius=radius)
        if begin < self.time:
            raise ClothSimError(
                f'the start of the push, {begin:g} s, is in the past, the time is {self.time:g} '
                's: give a later one, or none for now')
        with self._settled_state():
            if self.stepping.is_mid_step and begin <= self.stepping.edit_time:
                applied = self.loads.pushes.foresee(push, self.pinned_nodes())
                self.stepping.at_rest(lambda: self.loads.pushes.begin(push))
            else:
                applied = self.loads.pushes.add(push, self.time)
        self.listener.push(push)
        return applied

    def clear_pushes(self) -> int:
        """Cancel all active and scheduled pushes; return how many."""
        self.listener.command(CLEAR_PUSHES)
        pushes = [applied.push for applied in self.pushes]
        self.stepping.at_rest(lambda: self.loads.pushes.drop(pushes))
        return len(pushes)

    def set_wind(self, velocity: Sequence[float]) -> None:
        """Replace the steady wind by ``velocity`` [m/s]; gusts of the scene stay."""
        wind = self.loads.checked_wind(velocity)
        self.stepping.at_rest(lambda: self.loads.set_wind(wind))
        self.listener.wind(wind)

    def pin(self, row: int, col: int) -> None:
        """Pin the node (row, col) where it is; a moving pin stops."""
        self.engines.context.make_current()
        self._pins.hold(row, col)
        self.listener.pin(row, col, True)

    def release(self, row: int, col: int) -> None:
        """Release the node (row, col), with the velocity of its pin."""
        self.engines.context.make_current()
        self._pins.release(row, col)
        self.listener.pin(row, col, False)

    def move_pin(
            self, row: int, col: int, target: Sequence[float],
            speed: float | None = None) -> PinPath:
        """
        Move the pinned node (row, col) in a straight line to ``target`` [m], where it rests.

        A new target replaces the previous one, from the pin's position at that time.

        :param speed: [m/s] in simulated time; the scene's pin_speed by default
        :return: its path, with the time of arrival
        :raises ClothSimError: when the node is not pinned or a value is wrong
        """
        self.engines.context.make_current()
        path = self._pins.move(row, col, target, speed)
        self.listener.pin_target(path.move)
        return path

    @property
    def pin_moves(self) -> tuple[PinMove, ...]:
        """Return the moves of pins that are under way."""
        return self._pin_motion.under_way

    def pinned_nodes(self) -> np.ndarray:
        """Return which nodes are held, (rows, cols) bool, with changes yet to be made."""
        return self._pins.pinned_nodes()

    def nearest_node(
            self, point: Sequence[float], max_distance: float | None = None) -> NearNode:
        """Return the node nearest to ``point`` [m]."""
        return nearest(self.scene, self.positions(), point, max_distance)

    def nearest_pin(
            self, point: Sequence[float], max_distance: float | None = None) -> NearNode:
        """Return the pinned node nearest to ``point`` [m]."""
        return nearest(self.scene, self.positions(), point, max_distance, self.pinned_nodes())

    def positions(self) -> np.ndarray:
        """Return all positions [m], (rows, cols, 3) float32."""
        with self._settled_state():
            return self._state.read_positions()

    def velocities(self) -> np.ndarray:
        """Return all velocities [m/s], (rows, cols, 3) float32; a pinned node has its pin's."""
        with self._settled_state():
            return self._state.read_velocities()

    def set_mode(self, name: str) -> str:
        """Step with the mode ``name`` from now on, keeping the state; return the one before."""
        self.stepping.refuse_mid_step('set_mode')
        previous = self.mode
        self.engines.use(name)
        if name != previous:
            self.listener.mode(name, previous)
        return previous

    def take_over(self, prepared: Preparation) -> str:
        """Step with a mode that ``engines.preparation`` has compiled; return the one before."""
        self.engines.add(prepared)
        return self.set_mode(prepared.mode)

    def set_state(self, positions: np.ndarray, velocities: np.ndarray) -> None:
        """
        Replace positions [m] and velocities [m/s], both (rows, cols, 3).

        Pins are at rest then: moves under way end, those of the scene that are to come don't.
        """
        self.stepping.refuse_mid_step('set_state')
        self._state.check(positions, velocities)
        self.listener.new_state()
        self.engines.context.make_current()
        self._state.write(np.asarray(positions), np.asarray(velocities))
        self._pin_motion.drop()
        self.loads.forget()
        self.engines.forget()

    def go_on_from(
            self, steps: int, positions: np.ndarray, velocities: np.ndarray, *,
            pinned: np.ndarray, pushes: Sequence[Push] = ()) -> None:
        """
        Go on from the middle of a run, as far as that is known.

        Moves of pins under way are not: call ``move_pin`` for them. What the mode kept from
        earlier steps is dropped, and pushes under way act on the free nodes in their region now.

        :param steps: of dt made before
        :param positions: (rows, cols, 3) [m]
        :param velocities: (rows, cols, 3) [m/s]; pins are at rest
        :param pinned: (rows, cols) bool
        :param pushes: all that act or will act, those of the scene as well
        """
        self.stepping.refuse_mid_step('go_on_from')
        self._state.check(positions, velocities)
        self.listener.new_state()
        self.engines.context.make_current()
        self._state.pinned[:] = pinned
        self._state.write(np.asarray(positions), np.asarray(velocities))
        self.engines.forget()
        self._begin_run(steps)
        self.loads.pushes.take_up(pushes, self.time)
        self._pin_motion.leave_out_before(self.time)

    def reset(self) -> None:
        """Go back to the start: pose, pins, time, the scene's pushes and moves of pins."""
        self.stepping.refuse_mid_step('reset')
        self.listener.command(RESET)
        self.engines.context.make_current()
        self._state.pinned[:] = self.scene.pinned_nodes()
        start = self.scene.start_positions()
        self._state.write(start, np.zeros_like(start))
        self.engines.forget()
        self._begin_run()

    def measure(self) -> Measures:
        """Return energies and largest strain, which is cheaper than a snapshot."""
        engine = self.engines.in_use
        with self._settled_state():
            return engine.measure(self._state, self.loads.acting(self.time))

    def snapshot(self, *, tension: bool = False, pin_forces: bool = False) -> Snapshot:
        """
        Return the complete state at this time.

        :param tension: True to have the tension of every edge in it, and the forces at the pins
        :param pin_forces: True to have these forces alone, which costs less on a large cloth
        """
        engine = self.engines.in_use
        with self._settled_state():
            snapshot = engine.snapshot(
                self._state, self.loads.acting(self.time), time=self.time, steps=self.steps,
                dt=self.dt, stalled_pins=self._pin_motion.stalled)
        if tension or pin_forces:
            self.stepping.refuse_mid_step('forces')
            return with_forces(
                snapshot, self.scene, engine.mode, self._pin_motion, self.loads,
                every_edge=tension)
        return snapshot

    def pin_forces(self) -> PinForces:
        """Return the present reaction force at each pinned node."""
        forces = self.snapshot(pin_forces=True).pin_forces
        assert forces is not None
        return forces

    def finish(self) -> None:
        """Wait until the device has finished all work; for timing."""
        self.engines.context.finish()

    def close(self) -> None:
        """Free all memory on the device; does nothing when called again."""
        if self._is_closed:
            return
        self._is_closed = True
        self.engines.delete()
        self._state.delete()
        self.loads.delete()
        if self._owns_context:
            self._first_context.close()

    def _begin_run(self, steps: int = 0) -> None:
        self.stepping = Stepping(self.dt, steps)
        self.loads.begin_run()
        for push in self.scene.timed_pushes():
            self.loads.pushes.add(push, -math.inf)
        self._pin_motion = PinMotion(self.scene, self._state)
        self._pins = PinRequests(self._pin_motion, self._state, self.stepping)

    def _make_step(self, number: int) -> modes.Pieces:
        self.stepping.step_under_way = number
        begin, end = number * self.dt, (number + 1) * self.dt
        mode, pins = self.engines.in_use.mode, self._pin_motion
        pins.begin_step(begin, end, pulled_too_hard(self.scene, self._state, mode, pins))
        self.loads.begin_step(begin, end)
        yield from mode.step(self._state, begin, self.loads)
        pins.end_step(begin, end)

    def _finish_work(self) -> None:
        self.stepping.refuse_mid_step('advance')
        if self.stepping.is_behind:
            modes.finish(self.work(lambda: False))

    @contextmanager
    def _settled_state(self) -> Iterator[None]:
        self.engines.context.make_current()
        if self.stepping.is_mid_step:
            with self._state.at_kept():
                yield
        else:
            yield
