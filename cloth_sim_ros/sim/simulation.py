# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""A running cloth: its state on the device, inputs, steps and snapshots."""

from collections.abc import Callable
from collections.abc import Mapping
from collections.abc import Sequence
from contextlib import AbstractContextManager
from contextlib import suppress
import math
from typing import Any

from cloth_sim_ros.files.errors import shown
from cloth_sim_ros.gl.buffer import shader_writes_visible
from cloth_sim_ros.gl.context import Context
from cloth_sim_ros.sim import modes
from cloth_sim_ros.sim.contact.contacts import ContactForce
from cloth_sim_ros.sim.contact.start_inside import warn_of_start_inside
from cloth_sim_ros.sim.contact.thin_bodies import warn_of_thin_bodies
from cloth_sim_ros.sim.device.layout import choose_layout
from cloth_sim_ros.sim.engine import Engines
from cloth_sim_ros.sim.engine import Preparation
from cloth_sim_ros.sim.errors import ClothSimError
from cloth_sim_ros.sim.errors import NonFiniteStateError
from cloth_sim_ros.sim.held.force_window import forces_at
from cloth_sim_ros.sim.held.force_window import ForceWindow
from cloth_sim_ros.sim.held.force_window import ForceWindows
from cloth_sim_ros.sim.held.force_window import FrameForces
from cloth_sim_ros.sim.held.force_window import grasp_forces
from cloth_sim_ros.sim.held.forces import lost_grasps
from cloth_sim_ros.sim.held.forces import pulled_too_hard
from cloth_sim_ros.sim.held.forces import with_forces
from cloth_sim_ros.sim.held.grasps import Grasp
from cloth_sim_ros.sim.held.grasps import GraspForce
from cloth_sim_ros.sim.held.grasps import Grasps
from cloth_sim_ros.sim.held.held_impulses import HeldImpulses
from cloth_sim_ros.sim.held.held_impulses import Impulses
from cloth_sim_ros.sim.held.pin_forces import PinForces
from cloth_sim_ros.sim.held.pin_motion import PinMotion
from cloth_sim_ros.sim.inputs import ClearPushes
from cloth_sim_ros.sim.inputs import Input
from cloth_sim_ros.sim.inputs import InputListener
from cloth_sim_ros.sim.inputs import MoveCollider
from cloth_sim_ros.sim.inputs import MoveGrasp
from cloth_sim_ros.sim.inputs import MovePin
from cloth_sim_ros.sim.inputs import Pin
from cloth_sim_ros.sim.inputs import PushNodes
from cloth_sim_ros.sim.inputs import Release
from cloth_sim_ros.sim.inputs import ReplaceState
from cloth_sim_ros.sim.inputs import Reset
from cloth_sim_ros.sim.inputs import SetMode
from cloth_sim_ros.sim.inputs import SetWind
from cloth_sim_ros.sim.inputs import TakeGrasp
from cloth_sim_ros.sim.inputs import Unpin
from cloth_sim_ros.sim.loads.loads import Loads
from cloth_sim_ros.sim.loads.push_field import AppliedPush
from cloth_sim_ros.sim.model.colliders import Collider
from cloth_sim_ros.sim.model.frame_paths import FramePath
from cloth_sim_ros.sim.model.frame_paths import MovedFrame
from cloth_sim_ros.sim.model.grid import near_node
from cloth_sim_ros.sim.model.grid import NearNode
from cloth_sim_ros.sim.model.grid import usual_reach
from cloth_sim_ros.sim.model.pins import PinMove
from cloth_sim_ros.sim.model.pins import PinPath
from cloth_sim_ros.sim.model.pose import Pose
from cloth_sim_ros.sim.model.push import Push
from cloth_sim_ros.sim.model.scene_fields import ALL_LAYERS
from cloth_sim_ros.sim.scene import Scene
from cloth_sim_ros.sim.simulation_arguments import check_callable
from cloth_sim_ros.sim.simulation_arguments import check_creation
from cloth_sim_ros.sim.simulation_arguments import check_flags
from cloth_sim_ros.sim.simulation_arguments import checked_run
from cloth_sim_ros.sim.simulation_arguments import checked_snapshot
from cloth_sim_ros.sim.snapshot import Measures
from cloth_sim_ros.sim.snapshot import Snapshot
from cloth_sim_ros.sim.state import start_state
from cloth_sim_ros.sim.state import StoredPositions
from cloth_sim_ros.sim.stepping import Stepping
from cloth_sim_ros.sim.stop import never
from cloth_sim_ros.sim.stop import Stop
import numpy as np

# Below this many nodes llvmpipe is faster without its worker threads (docs/notes/performance.md).
SINGLE_THREAD_NODES = 128 * 128
# Rounding of a whole number of steps, in steps of dt [1].
_ROUNDING = 1e-6
_NONE_MOVED: Mapping[str, Pose] = {}


class Simulation(AbstractContextManager['Simulation']):
    """
    A simulated cloth. Use it only on the thread that created it.

    As a context manager it is closed at the end of the block. What modes need is compiled
    beforehand by ``engines``.

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
        """Compile, allocate and set the start pose."""
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
        # Is notified of every accepted input, and may refuse one.
        self.listener = InputListener()
        # Grasps that the cloth has pulled too hard at in the present step.
        self._lost: list[str] = []
        self._is_closed = False
        self.loads = Loads(scene, self.layout, self._state)
        self._begin_run()
        warn_of_thin_bodies(scene, scene['mode'])
        warn_of_start_inside(scene)

    def __exit__(self, *_: object) -> None:
        """Close, however the block has ended."""
        self.close()

    @property
    def is_ready(self) -> bool:
        """Return whether there is a mode to advance with."""
        return self.engines.current is not None

    @property
    def mode(self) -> str:
        """Return the name of the mode that steps now, or will be the first to."""
        return self.engines.mode

    @property
    def available_modes(self) -> tuple[str, ...]:
        """Return the modes ``set_mode`` takes."""
        return tuple(modes.AVAILABLE)

    @property
    def steps(self) -> int:
        """Return the steps of dt made since the start or the last reset."""
        return self.stepping.steps

    @property
    def time(self) -> float:
        """Return the simulated time since the start or the last reset [s]."""
        return self.stepping.time

    @property
    def substeps(self) -> int:
        """Return the substeps in a step of dt; 0 before there is a mode."""
        return self.engines.in_use.mode.substeps if self.is_ready else 0

    @property
    def stability_limit(self) -> float:
        """Return the longest stable substep of the mode [s]; infinite before there is one."""
        return self.engines.in_use.mode.stability_limit if self.is_ready else math.inf

    @property
    def stability_margin(self) -> float:
        """Return the substep over its upper bound, see Snapshot."""
        return self.engines.in_use.mode.substep_margin if self.is_ready else 0.0

    @property
    def colliders(self) -> tuple[Collider, ...]:
        """Return the colliders of the scene where they are now."""
        contacts = self.loads.contacts
        return () if contacts is None else contacts.present(self.time)

    def warm_up(self) -> None:
        """Compile all that the present mode can need, not each part when it is first used."""
        self.engines.compile_all()

    # Steps.

    def advance(self, seconds: float) -> int:
        """
        Simulate ``seconds`` more; a remainder below dt is carried over to the next call.

        :return: steps of dt made
        :raises NonFiniteStateError: when the state is lost; the last finite one is kept
        """
        first = self.steps
        self.stepping.aim(seconds)
        self.work()
        return self.steps - first

    def step(self, count: int = 1) -> None:
        """Make ``count`` steps of dt; as advance, stop at the last finite state."""
        self.stepping.aim_steps(count)
        self.work()

    def work(self, is_due: Callable[[], bool] = never, stop: Stop = never) -> None:
        """
        Make steps towards the aim of ``stepping``.

        :param is_due: asked after steps; True ends with the step that was made
        :param stop: asked within steps; True abandons those since the last check of the state
        :raises NonFiniteStateError: when the state is lost; the last finite one is kept
        :raises StepAbandoned: when ``stop`` has requested it
        """
        check_callable(is_due=is_due, stop=stop)
        while self.stepping.is_behind:
            self._make_checked_steps(is_due, stop)
            if is_due():
                return

    def _make_checked_steps(self, is_due: Callable[[], bool], stop: Stop) -> None:
        """Make steps up to the aim, the next timed input or the loss of a grasp."""
        engine = self.engines.in_use
        engine.context.make_current()
        goal = int(min(self.stepping.goal, self._next_timed_step))
        try:
            engine.guard.make(
                self.steps, goal - self.steps, self._make_steps, engine.mode, self.loads,
                [self.pin_motion, self._impulses, self._windows],
                is_due=lambda: bool(self._lost) or is_due(), stop=stop, settle=self._settle)
        except NonFiniteStateError as error:
            self._lost.clear()
            self.stepping.steps = error.steps
            self.stepping.drop_aim()
            self._apply_timed()
            raise
        except BaseException:
            self._lost.clear()
            self.stepping.drop_aim()
            raise
        self._apply_timed()
        for name in self._lost:
            if self.held.holds(name):
                self.apply(Release(name, by_force=True))
        self._lost.clear()

    def _settle(self, steps: int) -> None:
        self.stepping.steps = steps

    def _make_steps(self, number: int, most: int, stop: Stop) -> int:
        """Make up to ``most`` steps from that of ``number`` on; return how many."""
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
                self.pin_motion.rest()
                return made
        self._make_step(number, stop)
        return 1

    def _quiet_steps(self, number: int) -> float:
        """Return how many steps there are before anything but gravity acts."""
        now = number * self.dt
        if self.held.can_be_lost:
            return 0
        until = min(self.loads.still_until(now), self.pin_motion.rests_until(now))
        # By its number from the start, the last of them is the same wherever they begin.
        last = math.floor(until / self.dt + _ROUNDING) if math.isfinite(until) else math.inf
        return last - number

    def _make_step(self, number: int, stop: Stop) -> None:
        begin, end = number * self.dt, (number + 1) * self.dt
        mode, pins = self.engines.in_use.mode, self.pin_motion
        pins.begin_step(begin, end, pulled_too_hard(self.scene, self._state, mode, pins))
        self._lost = lost_grasps(self.scene, self._state, mode, self.held, begin)
        self._begin_impulses(begin, records=self._records(number))
        self.loads.begin_step(begin, end)
        mode.step(self._state, begin, self.loads, stop)
        pins.end_step(begin, end)
        self._end_impulses(number, 1)

    @property
    def _next_timed_step(self) -> float:
        """Return how many steps are made before the next timed input; infinite for none."""
        return self._timed[0][0] if self._timed else math.inf

    def _apply_timed(self) -> None:
        """Apply the scene's timed inputs up to now; one that can't be applied does nothing."""
        while self._timed and self._timed[0][0] <= self.steps:
            given = self._timed.pop(0)[1]
            with suppress(ClothSimError):
                given.apply(self)

    # Inputs.

    def apply(self, given: Input) -> Any:
        """
        Apply an input now, and notify the listener of the accepted input.

        :return: its outcome
        :raises ClothSimError: when it can't be applied; nothing is changed then
        """
        if not isinstance(given, Input):
            raise ClothSimError(
                f'an input must be one of the classes of sim.inputs, got {shown(given)}: give '
                'one, such as Pin(row, col)')
        self.listener.check(given)
        self.engines.context.make_current()
        time = self.time
        accepted, outcome = given.apply(self)
        self.listener.accept(accepted, time)
        return outcome

    @property
    def pushes(self) -> tuple[AppliedPush, ...]:
        """Return the pushes that act or will act."""
        return self.loads.pushes.applied

    def push(
            self, force: Sequence[float], *, duration: float, region: str = 'all',
            center: Sequence[float] = (0.0, 0.0, 0.0), radius: float = 0.0,
            start: float | None = None) -> AppliedPush:
        """
        Push the cloth with a total ``force`` [N] for ``duration`` [s] of simulated time.

        :param region: all, or sphere: the free nodes within ``radius`` of ``center`` [m]
            when the push begins; a scheduled one that finds none does nothing
        :param start: simulated time at which it begins [s]; now by default
        :raises ClothSimError: when a value is wrong or no free node is in the region
        """
        push = Push.checked(
            force=force, start=0.0 if start is None else start, duration=duration,
            region=region, center=center, radius=radius)
        return self.apply(PushNodes(push, starts_now=start is None))

    def clear_pushes(self) -> int:
        """Cancel all active and scheduled pushes; return how many."""
        return int(self.apply(ClearPushes()))

    def set_wind(self, velocity: Sequence[float]) -> None:
        """Replace the steady wind by ``velocity`` [m/s]; gusts of the scene stay."""
        self.apply(SetWind(velocity))

    def pin(self, row: int, col: int) -> None:
        """Pin the node (row, col) where it is; a moving pin stops."""
        self.apply(Pin(row, col))

    def release(self, row: int, col: int) -> None:
        """Release the node (row, col), with the velocity of its pin."""
        self.apply(Unpin(row, col))

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
        return self.apply(MovePin(row, col, target, speed))

    @property
    def pin_moves(self) -> tuple[PinMove, ...]:
        """Return the moves of pins in progress."""
        return self.pin_motion.under_way

    def pinned_nodes(self) -> np.ndarray:
        """Return which nodes are held, (rows, cols) bool."""
        return self._state.pinned.copy()

    def nearest_node(
            self, point: Sequence[float], max_distance: float | None = None) -> NearNode:
        """Return the node nearest to ``point`` [m]."""
        return self._nearest(point, max_distance)

    def nearest_pin(
            self, point: Sequence[float], max_distance: float | None = None) -> NearNode:
        """Return the pinned node nearest to ``point`` [m]."""
        return self._nearest(point, max_distance, self.pinned_nodes())

    def _nearest(
            self, point: Sequence[float], max_distance: float | None,
            pinned: np.ndarray | None = None) -> NearNode:
        if max_distance is None:
            max_distance = usual_reach(self.scene.rows, self.scene.cols, self.scene.spacing)
        return near_node(self.positions(), point, max_distance, pinned)

    @property
    def grasps(self) -> tuple[Grasp, ...]:
        """Return the grasps that hold nodes."""
        return self.held.present(self.time)

    def grasped_nodes(self) -> np.ndarray:
        """Return which nodes grasps hold, (rows, cols) bool."""
        held = np.zeros((self.scene.rows, self.scene.cols), dtype=bool)
        for grasp in self.grasps:
            held[tuple(grasp.nodes.T)] = True
        return held

    def grasp(
            self, name: str, position: Sequence[float],
            orientation: Sequence[float] | None = None, *, radius: float = 0.0, count: int = 0,
            layers: str = ALL_LAYERS, max_force: float = 0.0,
            nodes: Sequence[Sequence[int]] | None = None) -> Grasp:
        """
        Hold free nodes rigidly to a frame at ``position`` [m], where they are.

        :param name: of the grasp
        :param orientation: of its frame, quaternion x y z w; that of the world by default
        :param radius: hold the nodes within it [m]
        :param count: hold that many nodes, the nearest ones; 1 where there is no radius either
        :param layers: 'all' for nodes of every layer within reach, 'top' for the highest one
        :param max_force: pull of the cloth at which it is lost [N]; 0 for never
        :param nodes: rows and columns of the nodes to hold instead of the nearest ones
        :raises ClothSimError: when the name holds nodes, a value is wrong or no node is there
        """
        return self.apply(
            TakeGrasp(name, position, orientation, radius, count, max_force, nodes, layers))

    def release_grasp(self, name: str) -> Grasp:
        """Release the nodes of a grasp, with the velocity that they have; return what it held."""
        return self.apply(Release(name))

    def move_grasp(
            self, name: str, target: Sequence[float], orientation: Sequence[float] | None = None,
            speed: float | None = None, angular_speed: float | None = None, *,
            duration: float = 0.0) -> FramePath:
        """
        Move a grasp in a straight line to ``target`` [m], and turn it; there it rests.

        A new target replaces the previous one, from where the grasp is at that time.

        :param orientation: at the target, quaternion x y z w; the present one by default
        :param speed: [m/s] in simulated time; the scene's motion.speed by default
        :param angular_speed: [rad/s]; the scene's motion.angular_speed by default
        :param duration: in which to arrive, where these speeds are high enough [s]; 0 to have
            these speeds themselves
        :return: its path, with the time of arrival
        :raises ClothSimError: when it holds nothing or a value is wrong
        """
        return self.apply(
            MoveGrasp(name, target, orientation, speed, angular_speed, duration))

    def move_collider(
            self, name: str, target: Sequence[float], orientation: Sequence[float] | None = None,
            speed: float | None = None, angular_speed: float | None = None, *,
            duration: float = 0.0) -> FramePath:
        """Move a collider as ``move_grasp`` does a grasp."""
        return self.apply(
            MoveCollider(name, target, orientation, speed, angular_speed, duration))

    @property
    def grasp_paths(self) -> tuple[FramePath, ...]:
        """Return the paths of moving grasps."""
        return self.held.under_way(self.time)

    @property
    def moved_colliders(self) -> tuple[MovedFrame, ...]:
        """Return the colliders that are not where the scene alone has them."""
        contacts = self.loads.contacts
        return () if contacts is None else contacts.moved(self.time)

    def set_mode(self, name: str) -> str:
        """Step with the mode ``name`` from now on, keeping the state; return the one before."""
        before = str(self.apply(SetMode(name)))
        warn_of_thin_bodies(self.scene, name)
        return before

    def take_over(self, prepared: Preparation) -> str:
        """Step with a mode that ``engines.preparation`` has compiled; return the one before."""
        self.engines.add(prepared)
        return self.set_mode(prepared.mode)

    def set_state(self, positions: np.ndarray, velocities: np.ndarray) -> None:
        """
        Replace positions [m] and velocities [m/s], both (rows, cols, 3).

        Pins are at rest then: moves in progress end, pending ones of the scene stay.
        """
        self.apply(ReplaceState(positions, velocities))

    def replace_state(self, positions: np.ndarray, velocities: np.ndarray) -> None:
        """Carry out ReplaceState."""
        positions, velocities = self._state.checked(positions, velocities)
        self._settle_windows()
        self._impulses.forget()
        self._state.write(positions, velocities)
        self.held.stop(self.time)
        self.pin_motion.drop()
        self.loads.forget()
        self.engines.forget()

    def reset(self) -> None:
        """Go back to the start: pose, pins, time, the scene's pushes and moves of pins."""
        self.apply(Reset())

    def begin_anew(self) -> None:
        """Carry out Reset."""
        self._state.pinned[:] = self.scene.pinned_nodes()
        start = self.scene.start_positions()
        self._state.write(start, np.zeros_like(start))
        self.engines.forget()
        self._begin_run()

    def go_on_from(
            self, steps: int, positions: np.ndarray, velocities: np.ndarray, *,
            pinned: np.ndarray, pushes: Sequence[Push] = (),
            colliders: Mapping[str, Pose] = _NONE_MOVED) -> None:
        """
        Go on from the middle of a run, as far as that is known.

        Grasps and moves in progress are not: call ``grasp``, ``move_pin``, ``move_grasp`` and
        ``move_collider`` for them. What the mode kept from earlier steps is dropped, and pushes
        in progress act on the free nodes in their region now.

        :param steps: of dt made before
        :param positions: (rows, cols, 3) [m]
        :param velocities: (rows, cols, 3) [m/s]; pins are at rest
        :param pinned: (rows, cols) bool
        :param pushes: all that act or will act, those of the scene as well
        :param colliders: where those are, by name, that are not where the scene has them
        """
        positions, velocities = self._state.checked(positions, velocities)
        steps, pinned, pushes = checked_run(self.scene, steps, pinned, pushes, colliders)
        self.listener.check(ReplaceState(positions, velocities))
        self.engines.context.make_current()
        self._state.pinned[:] = pinned
        self._state.write(positions, velocities)
        self.engines.forget()
        self._begin_run(steps)
        self.loads.pushes.take_up(pushes, self.time)
        if self.loads.contacts is not None:
            for name, pose in colliders.items():
                self.loads.contacts.place(name, pose, self.time)
        self.pin_motion.leave_out_before(self.time)

    def _begin_run(self, steps: int = 0) -> None:
        self.stepping = Stepping(self.dt, steps)
        self._impulses.forget()
        self._windows.clear()
        self._furthest = steps
        self.loads.begin_run()
        for push in self.scene.timed_pushes():
            self.loads.pushes.add(push, -math.inf)
        self.pin_motion = PinMotion(self.scene, self._state)
        self.held = Grasps(self._state, self.pin_motion)
        self._lost.clear()
        self._timed = self._timed_inputs()
        self._apply_timed()

    def _timed_inputs(self) -> list[tuple[int, Input]]:
        """Return the scene's grasps, with how many steps are made before each."""
        timed: list[tuple[float, Input]] = []
        for request in self.scene.timed_grasps():
            timed.append((request.start, TakeGrasp.asked_by(request)))
            if request.release:
                timed.append((request.release, Release(request.name)))
        timed += [(move.start, MoveGrasp.of(move)) for move in self.scene.timed_grasp_moves()]
        numbered = [
            (math.ceil(time / self.dt - _ROUNDING), given) for time, given in timed]
        # On the way, those that are no later than now have been applied.
        return sorted(
            (entry for entry in numbered if entry[0] > self.steps or self.steps == 0),
            key=lambda entry: entry[0])

    # What it shows.

    def positions(self) -> np.ndarray:
        """Return all positions [m], (rows, cols, 3) float32; NaN where a shape has no node."""
        self.engines.context.make_current()
        return self._state.read_positions()

    def stored_positions(self) -> StoredPositions:
        """
        Return where the device has all positions, for a context beside that of the cloth.

        The device is done with them; they are those of now until the next step or input.
        """
        context = self.engines.context
        context.make_current()
        shader_writes_visible()
        context.finish()
        return self._state.stored_positions

    def velocities(self) -> np.ndarray:
        """Return all velocities [m/s], (rows, cols, 3) float32; a pinned node has its pin's."""
        self.engines.context.make_current()
        return self._state.read_velocities()

    def measure(self) -> Measures:
        """Return energies and largest strain, which is cheaper than a snapshot."""
        engine = self.engines.in_use
        engine.context.make_current()
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
        self.held.mark(snapshot.records['flags'])
        if self.loads.contacts is not None:
            snapshot = self.loads.contacts.with_contacts(snapshot)
        if tension or pin_forces:
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
        if self.held.present(self.time) or self.loads.contacts is not None:
            snapshot = self.snapshot()
            return lambda: snapshot
        make = self._look(later=True)

        def finish() -> Snapshot:
            # Closed, the cloth has read what was pending.
            if not self._is_closed:
                self.engines.context.make_current()
            return make()

        return finish

    def _look(self, *, later: bool) -> Callable[[], Snapshot]:
        engine = self.engines.in_use
        engine.context.make_current()
        return engine.snapshot(
            self._state, self.loads, time=self.time, steps=self.steps, dt=self.dt,
            stalled_pins=self.pin_motion.stalled, later=later)

    # Forces, each that of the cloth on what holds or touches it. They are means over time, so that
    # force times time adds up to what the momentum of the cloth has lost.

    @property
    def knows_forces(self) -> bool:
        """
        Return whether the forces on pins and grasps in the last step of dt are known.

        They are recorded in the last step of each call of ``step`` and ``advance``, unless
        ``records_forces`` is False, and in all steps while a force window is open.
        """
        return self._impulses.knows_last_step or not self._state.pinned.any()

    def pin_forces(self) -> PinForces:
        """
        Return the force of the cloth on what holds each pinned node.

        It is the mean over the last step of dt, with the strongest of its substeps beside it.

        :raises ClothSimError: when that was not recorded, see ``knows_forces``
        """
        forces = self.snapshot(pin_forces=True).pin_forces
        assert forces is not None
        return forces

    def contact_forces(self) -> tuple[ContactForce, ...]:
        """
        Return the force of the cloth on each collider, in the order of ``colliders.names``.

        It is the mean over the last step of dt.
        """
        contacts = self.loads.contacts
        return () if contacts is None else contacts.forces(self.positions(), self.time)

    def grasp_forces(self, snapshot: Snapshot | None = None) -> tuple[GraspForce, ...]:
        """
        Return the force of the cloth on each grasp, and its torque.

        They are the means over the last step of dt, with the strongest force of its substeps.

        :param snapshot: of this time; made here by default
        """
        positions = (
            self.positions() if snapshot is None
            else checked_snapshot(snapshot, self.time).positions)
        return grasp_forces(
            self._last_impulses(), self.held.present(self.time), positions,
            self.scene.node_mass, self.dt)

    def open_force_window(self) -> ForceWindow:
        """
        Return what adds up forces from now on, for ``frame_forces``; close it in the end.

        The forces of all frames together add up to the change of momentum, however many steps of
        dt a frame has.
        """
        self._settle_windows()
        self._windows.open.append(ForceWindow())
        self._windows.has_contacts = True
        return self._windows.open[-1]

    def close_force_window(self, window: ForceWindow) -> None:
        """Stop adding up forces in ``window``."""
        self._check_open(window)
        self._windows.open.remove(window)

    def frame_forces(
            self, window: ForceWindow, snapshot: Snapshot | None = None) -> FrameForces:
        """
        Return the forces of the cloth, means over the steps since ``window`` was asked last.

        Where no step was made since, they are those of the last step of dt.

        :param snapshot: of this time; made here by default
        """
        self._check_open(window)
        if snapshot is not None:
            checked_snapshot(snapshot, self.time)
        if not window.steps and window.latest is not None:
            return window.latest
        snapshot = snapshot or self.snapshot(pin_forces=True)
        self._windows.add(self._impulses.take())
        present = self.held.present(self.time)
        contacts = self.contact_forces()
        if not window.steps:
            nodes = np.argwhere(self._state.pinned & ~self.grasped_nodes())
            last, mass = self._last_impulses(), self.scene.node_mass
            return FrameForces(
                self.dt, forces_at(last, nodes, mass, self.dt),
                grasp_forces(last, present, snapshot.positions, mass, self.dt), contacts)
        self._windows.add_contacts(contacts)
        seconds, mass = window.steps * self.dt, self.scene.node_mass
        found = FrameForces(
            seconds, window.pins(mass, seconds),
            window.grasps(present, snapshot.positions, mass, seconds), window.contacts(contacts))
        window.clear()
        window.latest = found
        return found

    def _last_impulses(self) -> Impulses | None:
        if not self.knows_forces:
            raise ClothSimError(
                'the forces on pins and grasps in the last step were not recorded: make the '
                'Simulation with records_forces=True and end a call of step or advance, or open '
                'a force window before the step')
        return self._impulses.of_last_step()

    def _records(self, number: int) -> bool:
        """Return whether the forces of step ``number`` can be read."""
        if self._windows.open:
            return True
        # Steps that are made again may end at any of them.
        return self._records_forces and (
            self.stepping.is_last(number) or number < self._furthest)

    def _check_open(self, window: ForceWindow) -> None:
        if not any(window is each for each in self._windows.open):
            raise ClothSimError(
                'the window must be an open one of open_force_window, got '
                f'{shown(window)}: open one first')

    def _begin_impulses(self, begin: float, *, records: bool) -> None:
        if not records:
            # A small cloth makes a step in the time of some hundred of these lines.
            if self._impulses.knows_last_step:
                self._impulses.leave_out_step()
            return
        self._take_contacts(begin)
        self._windows.add(self._impulses.begin_step(
            self._state.pinned, self.held.present(begin), self.pin_motion.velocities,
            self.pin_motion.caught, edits=self._state.edits))

    def _end_impulses(self, number: int, steps: int) -> None:
        self._furthest = max(self._furthest, number + steps)
        pins, impulses = self.pin_motion, self._impulses
        if impulses.is_within_step or pins.velocities or impulses.velocities:
            impulses.end_step(pins.velocities)
        pins.caught.clear()
        if self._windows.open:
            self._windows.count(steps)

    def _settle_windows(self) -> None:
        self._windows.add(self._impulses.take())
        self._take_contacts(self.time)

    def _take_contacts(self, now: float) -> None:
        """Add what colliders had in the last step to the open windows, before it is gone."""
        contacts = self.loads.contacts
        if contacts is not None and not self._windows.has_contacts:
            self._windows.add_contacts(contacts.forces(self._state.read_positions(), now))

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
