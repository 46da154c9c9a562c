# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""A running cloth: owns the state on the device and steps it."""

from collections.abc import Callable
from collections.abc import Generator
from collections.abc import Iterator
from collections.abc import Mapping
from collections.abc import Sequence
from contextlib import AbstractContextManager
from contextlib import closing
from contextlib import contextmanager
from functools import partial
import math

from cloth_sim_ros.gl.context import Context
from cloth_sim_ros.sim import modes
from cloth_sim_ros.sim.engine import Engines
from cloth_sim_ros.sim.engine import Preparation
from cloth_sim_ros.sim.force_readings import ForceReadings
from cloth_sim_ros.sim.force_window import ForceWindows
from cloth_sim_ros.sim.forces import lost_grasps
from cloth_sim_ros.sim.forces import pulled_too_hard
from cloth_sim_ros.sim.forces import with_forces
from cloth_sim_ros.sim.grasps import GraspRequests
from cloth_sim_ros.sim.grasps import Grasps
from cloth_sim_ros.sim.handling import Handling
from cloth_sim_ros.sim.handling import InputListener
from cloth_sim_ros.sim.handling import RESET
from cloth_sim_ros.sim.handling import usual_reach
from cloth_sim_ros.sim.held_impulses import HeldImpulses
from cloth_sim_ros.sim.layout import choose_layout
from cloth_sim_ros.sim.loads import Loads
from cloth_sim_ros.sim.pin_motion import PinMotion
from cloth_sim_ros.sim.pin_motion import PinRequests
from cloth_sim_ros.sim.pose import Pose
from cloth_sim_ros.sim.push import Push
from cloth_sim_ros.sim.scene import Scene
from cloth_sim_ros.sim.simulation_arguments import check_callable
from cloth_sim_ros.sim.simulation_arguments import check_creation
from cloth_sim_ros.sim.simulation_arguments import check_flags
from cloth_sim_ros.sim.simulation_arguments import checked_run
from cloth_sim_ros.sim.snapshot import Measures
from cloth_sim_ros.sim.snapshot import Snapshot
from cloth_sim_ros.sim.state import start_state
from cloth_sim_ros.sim.stepping import Stepping
import numpy as np

# Below this many nodes llvmpipe is faster without its worker threads (docs/notes/performance.md).
SINGLE_THREAD_NODES = 128 * 128
# Of a step: what is short of it by less is a whole one.
_ROUNDING = 1e-6
_NONE_MOVED: Mapping[str, Pose] = {}


class Simulation(Handling, ForceReadings, AbstractContextManager['Simulation']):
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
    :param tuned: False leaves out what `cloth_sim tune` has found for the device
    :param records_forces: False leaves out the forces on pins and grasps, which take time in the
        last step of each call, except while a force window is open
    :raises ClothSimError: when the scene can't be run as it asks
    :raises DeviceError: when there is no device for it
    """

    def __init__(
            self, scene: Scene, *, context: Context | None = None,
            check_stability: bool = True, stop_at_non_finite: bool = True,
            compiles: bool = True, tuned: bool = True, records_forces: bool = True) -> None:
        """Compile, allocate and take up the start pose."""
        check_creation(
            scene, context, check_stability=check_stability, compiles=compiles, tuned=tuned,
            stop_at_non_finite=stop_at_non_finite)
        self.scene = scene
        self.dt: float = scene['dt']
        self._owns_context = context is None
        context = context or Context(single_thread=scene.node_count < SINGLE_THREAD_NODES)
        context.make_current()
        self._first_context = context
        self.device = context.device
        self.layout = choose_layout(scene, context, tuned=tuned)
        self._state = start_state(scene, self.layout)
        self._impulses = self._state.impulses = HeldImpulses(
            scene, self.layout, compiles=records_forces)
        self._windows = ForceWindows()
        self._records_forces = records_forces
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
        check_callable(is_due=is_due)
        engine, stepping = self.engines.in_use, self.stepping
        engine.context.make_current()

        def make_steps(first: int, count: int) -> Generator[None, None, None]:
            return engine.guard.make(
                first, count, self._make_steps, engine.mode, self.loads,
                [self._pin_motion, self._impulses, self._windows],
                is_due=lambda: stepping.has_edits or is_due(), settle=stepping.settle)

        with closing(stepping.run(make_steps)) as pieces:
            for _ in pieces:
                yield
                engine.context.make_current()

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
        positions, velocities = self._state.checked(positions, velocities)
        self.listener.new_state()
        self.engines.context.make_current()
        self._settle_windows()
        self._impulses.forget()
        self._state.write(positions, velocities)
        self._held.stop(self.time)
        self._pin_motion.drop()
        self.loads.forget()
        self.engines.forget()

    def go_on_from(
            self, steps: int, positions: np.ndarray, velocities: np.ndarray, *,
            pinned: np.ndarray, pushes: Sequence[Push] = (),
            colliders: Mapping[str, Pose] = _NONE_MOVED) -> None:
        """
        Go on from the middle of a run, as far as that is known.

        Grasps and moves under way are not: call ``grasp``, ``move_pin``, ``move_grasp`` and
        ``move_collider`` for them. What the mode kept from earlier steps is dropped, and pushes
        under way act on the free nodes in their region now.

        :param steps: of dt made before
        :param positions: (rows, cols, 3) [m]
        :param velocities: (rows, cols, 3) [m/s]; pins are at rest
        :param pinned: (rows, cols) bool
        :param pushes: all that act or will act, those of the scene as well
        :param colliders: where those are, by name, that are not where the scene has them
        """
        self.stepping.refuse_mid_step('go_on_from')
        positions, velocities = self._state.checked(positions, velocities)
        steps, pinned, pushes = checked_run(self.scene, steps, pinned, pushes, colliders)
        self.listener.new_state()
        self.engines.context.make_current()
        self._state.pinned[:] = pinned
        self._state.write(positions, velocities)
        self.engines.forget()
        self._begin_run(steps)
        self.loads.pushes.take_up(pushes, self.time)
        if self.loads.contacts is not None:
            for name, pose in colliders.items():
                self.loads.contacts.place(name, pose, self.time)
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
            if they are known
        :param pin_forces: True to have these forces alone, which costs less on a large cloth
        """
        check_flags(tension=tension, pin_forces=pin_forces)
        snapshot = self._look(later=False)()
        self._held.mark(snapshot.records['flags'])
        if self.loads.contacts is not None and not self.stepping.is_mid_step:
            snapshot = self.loads.contacts.with_contacts(snapshot)
        if tension or pin_forces:
            self.stepping.refuse_mid_step('forces')
            impulses = self._last_impulses() if pin_forces else self._impulses.of_last_step()
            return with_forces(
                snapshot, self.engines.in_use.mode, impulses, self.scene.node_mass,
                every_edge=tension, has_forces=self.knows_forces)
        return snapshot

    def begin_snapshot(self) -> Callable[[], Snapshot]:
        """
        Have the device make a snapshot, and return what waits for it and returns it.

        Whatever is done to the cloth in between, it is that of now, to the bit. It saves time
        where ``layout.is_asynchronous``, if there is something to submit in between; with
        colliders, or while a grasp holds nodes, it is made at once.
        """
        if self._held.present(self.time) or self.loads.contacts is not None:
            snapshot = self.snapshot()
            return lambda: snapshot
        make = self._look(later=True)

        def finish() -> Snapshot:
            # Closed, the cloth has read what was pending.
            if not self._is_closed:
                self.engines.context.make_current()
            return make()

        return finish

    def finish(self) -> None:
        """Wait until the device has finished all work; for timing."""
        self.engines.context.finish()

    def close(self) -> None:
        """Free all memory on the device; does nothing when called again, or in a forked child."""
        if self._is_closed or self._first_context.is_of_parent:
            return
        self._is_closed = True
        self.engines.delete()
        self._impulses.delete()
        self._state.delete()
        self.loads.delete()
        if self._owns_context:
            self._first_context.close()

    def _begin_run(self, steps: int = 0) -> None:
        self.stepping = Stepping(self.dt, steps)
        self._impulses.forget()
        self._windows.clear()
        self._furthest = steps
        self.loads.begin_run()
        for push in self.scene.timed_pushes():
            self.loads.pushes.add(push, -math.inf)
        self._pin_motion = PinMotion(self.scene, self._state)
        self._pins = PinRequests(self._pin_motion, self._state, self.stepping)
        self._held = Grasps(self._state, self._pin_motion)
        self._grasps = GraspRequests(
            self._held, self._pins, self.stepping, usual_reach(self.scene))
        self.stepping.at_times(
            self._grasps.timed_edits(self.scene, self._state.read_positions))

    def _make_steps(self, number: int, most: int) -> modes.Steps:
        count = int(min(most, self._quiet_steps(number))) if most > 1 else 1
        if count > 1 and not self._windows.open and self._records(number + count - 1):
            count -= 1  # the last one by itself, with its forces
        if count > 1:
            begin = number * self.dt
            gravity = self.loads.forcing(self._state, begin, begin + self.dt)
            self._begin_impulses(begin, records=self._records(number))
            made = self.engines.in_use.mode.step_ahead(self._state, gravity, count)
            if made:
                self._end_impulses(number, made)
                self.stepping.step_under_way = number + made - 1
                self._pin_motion.rest()
                yield
                return made
        yield from self._make_step(number)
        return 1

    def _quiet_steps(self, number: int) -> float:
        """Return how many steps there are before anything but gravity acts."""
        now, stepping = number * self.dt, self.stepping
        if self._held.can_be_lost:
            return 0
        until = min(self.loads.still_until(now), self._pin_motion.rests_until(now))
        # By its number from the start, the last of them is the same wherever they begin.
        last = math.floor(until / self.dt + _ROUNDING) if math.isfinite(until) else math.inf
        return min(last, stepping.next_timed_edit) - number

    def _make_step(self, number: int) -> modes.Pieces:
        self.stepping.step_under_way = number
        begin, end = number * self.dt, (number + 1) * self.dt
        mode, pins = self.engines.in_use.mode, self._pin_motion
        pins.begin_step(begin, end, pulled_too_hard(self.scene, self._state, mode, pins))
        for name in lost_grasps(self.scene, self._state, mode, self._held, begin):
            self.stepping.at_end_of_step(partial(self._lose_grasp, name))
        self._begin_impulses(begin, records=self._records(number))
        self.loads.begin_step(begin, end)
        yield from mode.step(self._state, begin, self.loads)
        pins.end_step(begin, end)
        self._end_impulses(number, 1)

    def _lose_grasp(self, name: str) -> None:
        if name in self._grasps.present():
            self._held.end(name)
            self.listener.grasp_release(name, True)

    def _finish_work(self) -> None:
        self.stepping.refuse_mid_step('advance')
        # Changes at their times end the work before the aim is reached.
        while self.stepping.is_behind:
            modes.finish(self.work(lambda: False))

    def _look(self, *, later: bool) -> Callable[[], Snapshot]:
        with self._settled_state():
            return self.engines.in_use.snapshot(
                self._state, self.loads, time=self.time, steps=self.steps, dt=self.dt,
                stalled_pins=self._pin_motion.stalled, later=later)

    @contextmanager
    def _settled_state(self) -> Iterator[None]:
        self.engines.context.make_current()
        if self.stepping.is_mid_step:
            with self._state.at_kept():
                yield
        else:
            yield
