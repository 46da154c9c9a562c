# Copyright 2026 the cloth_sim_ros authors
#
# Licensed under the Apache License, Version 2.0 (the "License");
# you may not use this file except in compliance with the License.
# You may obtain a copy of the License at
#
#     http://www.apache.org/licenses/LICENSE-2.0
#
# Unless required by applicable law or agreed to in writing, software
# distributed under the License is distributed on an "AS IS" BASIS,
# WITHOUT WARRANTIES OR CONDITIONS OF ANY KIND, either express or implied.
# See the License for the specific language governing permissions and
# limitations under the License.

"""A running cloth: owns the state on the device and steps it."""

from collections.abc import Sequence
import math

from cloth_sim_ros.gl.context import Context
from cloth_sim_ros.sim import modes
from cloth_sim_ros.sim.errors import ClothSimError
from cloth_sim_ros.sim.errors import NonFiniteStateError
from cloth_sim_ros.sim.forces import with_forces
from cloth_sim_ros.sim.forcing import Forcing
from cloth_sim_ros.sim.guarded_steps import GuardedSteps
from cloth_sim_ros.sim.layout import choose_layout
from cloth_sim_ros.sim.nearest import nearest
from cloth_sim_ros.sim.nearest import NearNode
from cloth_sim_ros.sim.observer import Observer
from cloth_sim_ros.sim.pin_motion import PinMotion
from cloth_sim_ros.sim.pin_move import PinMove
from cloth_sim_ros.sim.pin_path import PinPath
from cloth_sim_ros.sim.push import Push
from cloth_sim_ros.sim.push_field import AppliedPush
from cloth_sim_ros.sim.push_field import PushField
from cloth_sim_ros.sim.scene import Scene
from cloth_sim_ros.sim.scene_fields import MODES
from cloth_sim_ros.sim.snapshot import Measures
from cloth_sim_ros.sim.snapshot import Snapshot
from cloth_sim_ros.sim.state import State
import numpy as np

# Below this many nodes llvmpipe is faster without its worker threads (docs/performance.md).
SINGLE_THREAD_NODES = 128 * 128


class Simulation:
    """
    A cloth that moves. To be used on one thread, the one it was made on.

    :param scene: what to model
    :param context: GL context to use; by default one of its own
    :param check_stability: False lets dt pass the stability limit, to study what happens
    :param stop_at_non_finite: False steps on whatever becomes of the state, to study that
    :raises ClothSimError: when the scene can't be run as it asks
    :raises DeviceError: when there is no device for it
    """

    def __init__(
            self, scene: Scene, *, context: Context | None = None,
            check_stability: bool = True, stop_at_non_finite: bool = True) -> None:
        """Compile, allocate and take up the start pose."""
        self.scene = scene
        self.dt: float = scene['dt']
        self._check_stability = check_stability
        _check_mode(scene['mode'])
        self._owns_context = context is None
        self._context = context or Context(
            single_thread=scene.node_count < SINGLE_THREAD_NODES)
        self._context.make_current()
        self.device = self._context.device
        self.layout = choose_layout(scene, self._context)
        self._state = State(self.layout, scene.start_positions(), scene.pinned_nodes())
        self._observer = Observer(scene, self.layout)
        self._guard = GuardedSteps(
            scene, self.layout, self._observer, self._state, stop_at_non_finite)
        self._modes: dict[str, modes.Mode] = {}
        self._mode = self._get_mode(scene['mode'])
        self._pushes: PushField | None = None
        self._begin_run()

    @property
    def mode(self) -> str:
        """Return the name of the mode that steps now."""
        return self._mode.name

    @property
    def available_modes(self) -> tuple[str, ...]:
        """Return the modes ``set_mode`` takes."""
        return tuple(modes.AVAILABLE)

    @property
    def time(self) -> float:
        """Return the simulated time since the start or the last reset [s]."""
        return self.steps * self.dt

    @property
    def substeps(self) -> int:
        """Return the substeps in a step of dt."""
        return self._mode.substeps

    @property
    def stability_limit(self) -> float:
        """Return the longest stable substep of the present mode [s]."""
        return self._mode.stability_limit

    @property
    def stability_margin(self) -> float:
        """Return the substep over the stability limit: 1 and above blows up."""
        return self.dt / self.substeps / self.stability_limit

    @property
    def pushes(self) -> tuple[AppliedPush, ...]:
        """Return the pushes that act or will act."""
        return self._pushes.applied

    def advance(self, seconds: float) -> int:
        """
        Simulate ``seconds`` more; what is no whole dt is carried over to the next call.

        :return: steps of dt made
        :raises NonFiniteStateError: when the state is lost; the last finite one is kept
        """
        if not math.isfinite(seconds) or seconds < 0.0:
            raise ClothSimError(f'cannot advance by {seconds} s: give a time of 0 s or more')
        self._target += seconds
        # The small share keeps a sum of frame times from falling just short of a step.
        due = math.floor(self._target / self.dt + 1e-6) - self.steps
        return self._make_steps(due)

    def step(self, count: int = 1) -> None:
        """Make ``count`` steps of dt; as advance, stop at the last finite state."""
        if count < 0:
            raise ClothSimError(f'cannot make {count} steps: give 0 or more')
        self._make_steps(count)
        self._target = self.time

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
        begin = self.time if start is None else start
        push = Push.checked(
            force=force, start=begin, duration=duration, region=region, center=center,
            radius=radius)
        if begin < self.time:
            raise ClothSimError(
                f'the start of the push, {begin:g} s, lies in the past, it is {self.time:g} s: '
                'give a later one, or none for now')
        self._context.make_current()
        return self._pushes.add(push, self.time)

    def clear_pushes(self) -> int:
        """End all pushes and drop those to come; return how many."""
        return self._pushes.clear()

    def pin(self, row: int, col: int) -> None:
        """Hold the node (row, col) where it is; a pin that moves stops."""
        self._context.make_current()
        self._pin_motion.hold(row, col)

    def release(self, row: int, col: int) -> None:
        """Let the node (row, col) go, with the velocity its pin has."""
        self._context.make_current()
        self._pin_motion.release(row, col)

    def move_pin(
            self, row: int, col: int, target: Sequence[float],
            speed: float | None = None) -> PinPath:
        """
        Move the pinned node (row, col) in a straight line to ``target`` [m], where it rests.

        A new target takes the place of the one before, from where the pin is by then.

        :param speed: [m/s] in simulated time; the scene's pin_speed by default
        :return: its way, which tells when it arrives
        :raises ClothSimError: when the node is not pinned or a value is wrong
        """
        self._context.make_current()
        return self._pin_motion.move(row, col, target, speed, self.time)

    @property
    def pin_moves(self) -> tuple[PinMove, ...]:
        """Return the moves of pins that are under way."""
        return self._pin_motion.under_way

    def pinned_nodes(self) -> np.ndarray:
        """Return which nodes are held now, (rows, cols) bool."""
        return self._state.pinned.copy()

    def nearest_node(
            self, point: Sequence[float], max_distance: float | None = None) -> NearNode:
        """Return the node nearest to ``point`` [m]."""
        return nearest(self.scene, self.snapshot().positions, point, max_distance)

    def nearest_pin(
            self, point: Sequence[float], max_distance: float | None = None) -> NearNode:
        """Return the pinned node nearest to ``point`` [m]."""
        return nearest(
            self.scene, self.snapshot().positions, point, max_distance, self._state.pinned)

    def set_mode(self, name: str) -> str:
        """Step with the mode ``name`` from now on, keeping the state; return the one before."""
        _check_mode(name)
        previous = self._mode.name
        self._context.make_current()
        self._mode = self._get_mode(name)
        if name != previous:
            self._mode.forget()
        return previous

    def set_state(self, positions: np.ndarray, velocities: np.ndarray) -> None:
        """
        Replace positions [m] and velocities [m/s], both (rows, cols, 3).

        Pins are at rest then: moves under way end, those of the scene that are to come don't.
        """
        self._state.check(positions, velocities)
        self._context.make_current()
        self._state.write(np.asarray(positions), np.asarray(velocities))
        self._pin_motion.drop()
        self._mode.forget()

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
        self._state.check(positions, velocities)
        self._context.make_current()
        self._state.pinned[:] = pinned
        self._state.write(np.asarray(positions), np.asarray(velocities))
        self._mode.forget()
        self._begin_run(steps)
        self._pushes.take_up(pushes, self.time)
        self._pin_motion.leave_out_before(self.time)

    def reset(self) -> None:
        """Go back to the start: pose, pins, time, the scene's pushes and moves of pins."""
        self._context.make_current()
        self._state.pinned[:] = self.scene.pinned_nodes()
        start = self.scene.start_positions()
        self._state.write(start, np.zeros_like(start))
        self._mode.forget()
        self._begin_run()

    def measure(self) -> Measures:
        """Return energies and largest strain, which is cheaper than a snapshot."""
        self._context.make_current()
        return self._observer.measure(self._state, self._forcing_now())

    def snapshot(self, *, tension: bool = False, pin_forces: bool = False) -> Snapshot:
        """
        Return everything there is to know of this instant.

        :param tension: True to have the tension of every edge in it, and the forces at the pins
        :param pin_forces: True to have these forces alone, which costs less on a large cloth
        """
        self._context.make_current()
        measures, records = self._observer.record(
            self._state, self._forcing_now(), self._mode.limit_marks())
        snapshot = Snapshot(
            **vars(measures), **self._mode.report(), records=records, mode=self.mode,
            time=self.time, steps=self.steps, dt=self.dt,
            substeps=self.substeps, stability_margin=self.stability_margin)
        if tension or pin_forces:
            return with_forces(
                snapshot, self.scene, self._mode, self._pin_motion, every_edge=tension)
        return snapshot

    def finish(self) -> None:
        """Wait until the device has done everything asked of it; for timing."""
        self._context.finish()

    def close(self) -> None:
        """Give everything on the device back."""
        self._context.make_current()
        for part in (
                self._state, self._observer, self._guard, self._pushes, *self._modes.values()):
            part.delete()
        if self._owns_context:
            self._context.close()

    def _begin_run(self, steps: int = 0) -> None:
        self.steps = steps
        self._target = self.time
        if self._pushes is not None:
            self._pushes.delete()
        self._pushes = PushField(
            self.layout, self.scene.node_mass, self.scene['gravity'],
            self._read_positions,
            self._state.pinned)
        for push in self.scene.timed_pushes():
            self._pushes.add(push, -math.inf)
        self._pin_motion = PinMotion(self.scene, self._state)

    def _make_steps(self, count: int) -> int:
        self._context.make_current()
        try:
            self._guard.make(
                self.steps, count, self._make_step, self._mode, self._pushes, [self._pin_motion])
        except NonFiniteStateError as error:
            self.steps = error.steps
            self._target = self.time
            raise
        self.steps += count
        return count

    def _make_step(self, number: int) -> None:
        begin, end = number * self.dt, (number + 1) * self.dt
        self._pin_motion.begin_step(begin, end)
        self._mode.step(self._state, begin, self._pushes)
        self._pin_motion.end_step(begin, end)

    def _read_positions(self) -> np.ndarray:
        records = self._observer.record(self._state, self._pushes.still)[1]
        return np.stack([records[axis] for axis in 'xyz'], axis=-1)

    def _forcing_now(self) -> Forcing:
        return self._pushes.acting(self.time)

    def _get_mode(self, name: str) -> modes.Mode:
        if name not in self._modes:
            self._modes[name] = modes.AVAILABLE[name](
                self.scene, self.layout, check_stability=self._check_stability)
        return self._modes[name]


def _check_mode(name: str) -> None:
    if name not in MODES:
        raise ClothSimError(f'there is no mode {name!r}: choose one of {", ".join(MODES)}')
