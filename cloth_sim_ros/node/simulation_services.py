# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""The services of simulation_interfaces, which other simulators offer as well."""

from collections.abc import Awaitable
from collections.abc import Callable
import re
from typing import Any

from cloth_sim_interfaces.msg import ClothState
from cloth_sim_ros.files.errors import shown
from cloth_sim_ros.messages.body_frames import pose_message
from cloth_sim_ros.messages.body_frames import vector
from cloth_sim_ros.messages.stamp import stamp
from cloth_sim_ros.messages.time_base import TimeBase
from cloth_sim_ros.node.action_servers import Actions
from cloth_sim_ros.node.action_servers import Answer
from cloth_sim_ros.node.action_servers import handle_number
from cloth_sim_ros.node.action_servers import Steps
from cloth_sim_ros.node.device_thread import DeviceThread
from cloth_sim_ros.node.guarded_node import GuardedNode
from cloth_sim_ros.node.run_loop import RunLoop
from cloth_sim_ros.sim.errors import ClothSimError
from cloth_sim_ros.sim.errors import NotFoundError
from cloth_sim_ros.sim.model.frame_paths import FramePath
from cloth_sim_ros.sim.model.pose import NO_ROTATION
from cloth_sim_ros.sim.model.pose import Pose
from cloth_sim_ros.sim.model.pose import rotation_between
from cloth_sim_ros.sim.simulation import Simulation
from geometry_msgs.msg import Twist
import numpy as np
from rclpy.action.server import ServerGoalHandle
from rclpy.callback_groups import ReentrantCallbackGroup
from simulation_interfaces.action import SimulateSteps
from simulation_interfaces.msg import Bounds
from simulation_interfaces.msg import EntityFilters
from simulation_interfaces.msg import EntityState
from simulation_interfaces.msg import Result
from simulation_interfaces.msg import SimulationState
from simulation_interfaces.msg import SimulatorFeatures
from simulation_interfaces.srv import GetEntities
from simulation_interfaces.srv import GetEntitiesStates
from simulation_interfaces.srv import GetEntityState
from simulation_interfaces.srv import GetSimulationState
from simulation_interfaces.srv import GetSimulatorFeatures
from simulation_interfaces.srv import ResetSimulation
from simulation_interfaces.srv import SetSimulationState
from simulation_interfaces.srv import StepSimulation

CLOTH = 'cloth'
FEATURES = (
    SimulatorFeatures.ENTITY_STATE_GETTING, SimulatorFeatures.SIMULATION_RESET,
    SimulatorFeatures.SIMULATION_STATE_GETTING, SimulatorFeatures.SIMULATION_STATE_SETTING,
    SimulatorFeatures.SIMULATION_STATE_PAUSE, SimulatorFeatures.STEP_SIMULATION_SINGLE,
    SimulatorFeatures.STEP_SIMULATION_MULTIPLE, SimulatorFeatures.STEP_SIMULATION_ACTION)
_ABOUT = (
    'cloth_sim_ros: the cloth is an entity whose pose is the mean of its nodes; grasps and '
    'colliders are entities as well; a reset is of time and state together; accelerations are 0')
# Time and state together, and everything.
_RESETS = (
    ResetSimulation.Request.SCOPE_DEFAULT, ResetSimulation.Request.SCOPE_ALL,
    ResetSimulation.Request.SCOPE_TIME | ResetSimulation.Request.SCOPE_STATE,
    ResetSimulation.Request.SCOPE_TIME | ResetSimulation.Request.SCOPE_STATE
    | ResetSimulation.Request.SCOPE_SPAWNED)


class _ResultError(ClothSimError):
    """A request that ends with the constant ``code`` of Result, or of its own response."""

    def __init__(self, code: int, message: str) -> None:
        super().__init__(message)
        self.code = code


def _unsupported(message: str) -> _ResultError:
    return _ResultError(Result.RESULT_FEATURE_UNSUPPORTED, message)


class SimulationServices:
    """
    Serve get_entities, get_simulation_state and so on, relative to the namespace of the node.

    :param base: of the stamps
    :param frame_id: of the cloth
    :param is_stopped: whether the node has started paused, which they call stopped
    :param reset: puts the cloth back, on the device thread
    :param changed: called on the device thread when the run state has changed
    """

    def __init__(
            self, node: GuardedNode, device: DeviceThread, simulation: Simulation,
            run_loop: RunLoop, *, base: TimeBase, frame_id: str, is_stopped: bool,
            reset: Callable[[], None], changed: Callable[[], None]) -> None:
        """Make the services."""
        self._node = node
        self._device = device
        self._simulation = simulation
        self._run_loop = run_loop
        self._base = base
        self._frame_id = frame_id
        self._is_stopped = is_stopped
        self._reset = reset
        self._changed = changed
        self._serve(GetSimulatorFeatures, 'get_simulator_features', self._features)
        for kind, name, carry_out in (
                (GetEntities, 'get_entities', self._entities),
                (GetEntityState, 'get_entity_state', self._entity_state),
                (GetEntitiesStates, 'get_entities_states', self._entities_states),
                (GetSimulationState, 'get_simulation_state', self._state),
                (SetSimulationState, 'set_simulation_state', self._set_state),
                (ResetSimulation, 'reset_simulation', self._reset_all)):
            self._serve(kind, name, self._on_device(carry_out))
        self._serve(StepSimulation, 'step_simulation', self._step)

    def _serve(
            self, kind: type, name: str, carry_out: Callable[[Any, Any], Awaitable[None]]) -> None:
        async def callback(request: Any, response: Any) -> Any:
            result = Result(result=Result.RESULT_OK)
            try:
                await carry_out(request, response)
            except ClothSimError as error:
                result = result_of(error)
            except Exception as error:
                if not self._node.context.ok():
                    raise
                result = Result(
                    result=Result.RESULT_OPERATION_FAILED,
                    error_message=self._node.faults.note(error, name))
            if hasattr(response, 'result'):
                response.result = result
            return response

        self._node.create_service(kind, name, callback, callback_group=ReentrantCallbackGroup())

    def _on_device(
            self, carry_out: Callable[[Any, Any], None]) -> Callable[[Any, Any], Awaitable[None]]:
        async def wait_for(request: Any, response: Any) -> None:
            await self._device.ask(lambda: carry_out(request, response))

        return wait_for

    async def _features(self, _: Any, response: GetSimulatorFeatures.Response) -> None:
        response.features = SimulatorFeatures(features=list(FEATURES), custom_info=_ABOUT)

    # Entities.

    def _entities(self, request: Any, response: Any) -> None:
        response.entities = self._filtered(request.filters)

    def _entity_state(self, request: Any, response: Any) -> None:
        names = self._names()
        if request.entity not in names:
            raise NotFoundError(
                f'there is no entity {shown(request.entity)}: give one of {", ".join(names)}')
        response.state = self._state_of(request.entity)

    def _entities_states(self, request: Any, response: Any) -> None:
        response.entities = self._filtered(request.filters)
        response.states = [self._state_of(name) for name in response.entities]

    def _names(self) -> list[str]:
        simulation = self._simulation
        return [
            CLOTH, *(f'colliders/{each.name}' for each in simulation.colliders),
            *(f'grasps/{each.name}' for each in simulation.grasps)]

    def _filtered(self, filters: EntityFilters) -> list[str]:
        if filters.categories or filters.tags.tags:
            raise _unsupported(
                'entities have neither categories nor tags: filter them by their names')
        if filters.bounds.type != Bounds.TYPE_EMPTY:
            raise _unsupported('entities have no bounds: filter them by their names')
        try:
            pattern = re.compile(filters.filter)
        except re.error as error:
            raise ClothSimError(
                f'the filter {shown(filters.filter)} is no regular expression, {error}: give one, '
                'or none for all entities') from error
        return [name for name in self._names() if pattern.search(name)]

    def _state_of(self, name: str) -> EntityState:
        simulation = self._simulation
        found = EntityState()
        found.header.stamp = stamp(simulation.time, self._base.epoch)
        found.header.frame_id = self._frame_id
        if name == CLOTH:
            mean = np.nanmean(simulation.positions().reshape(-1, 3), axis=0, dtype=float)
            speed = np.nanmean(simulation.velocities().reshape(-1, 3), axis=0, dtype=float)
            x, y, z = map(float, mean)
            found.pose = pose_message(Pose((x, y, z), NO_ROTATION))
            found.twist.linear = vector(speed)
            return found
        kind, _, own = name.partition('/')
        bodies: Any = simulation.grasps if kind == 'grasps' else simulation.colliders
        found.pose = pose_message(next(body.pose for body in bodies if body.name == own))
        paths = simulation.grasp_paths if kind == 'grasps' else tuple(
            each.path for each in simulation.moved_colliders if each.path is not None)
        for path in paths:
            if path.move.name == own and path.begin <= simulation.time < path.arrival:
                found.twist = _twist(path)
        return found

    # The run.

    def _state(self, _: Any, response: GetSimulationState.Response) -> None:
        response.state.state = self._present()

    def _present(self) -> int:
        state = self._run_loop.run_state
        if state in (ClothState.RUNNING, ClothState.PREPARING):
            return int(SimulationState.STATE_PLAYING)
        if self._is_stopped and self._simulation.steps == 0:
            return int(SimulationState.STATE_STOPPED)
        return int(SimulationState.STATE_PAUSED)

    def _set_state(self, request: Any, _: Any) -> None:
        wanted = request.state.state
        if wanted not in (
                SimulationState.STATE_STOPPED, SimulationState.STATE_PLAYING,
                SimulationState.STATE_PAUSED):
            raise _unsupported(
                f'the state {wanted} cannot be set: give 0 to stop, 1 to play or 2 to pause')
        if wanted == self._present():
            raise _ResultError(
                SetSimulationState.Response.ALREADY_IN_TARGET_STATE,
                f'the simulation is in the state {wanted} already')
        if wanted == SimulationState.STATE_PLAYING:
            self._run_loop.resume()
        else:
            self._run_loop.pause()
        self._is_stopped = wanted == SimulationState.STATE_STOPPED
        if self._is_stopped:
            self._reset()
        self._changed()

    def _reset_all(self, request: Any, _: Any) -> None:
        if request.scope not in _RESETS:
            raise _unsupported(
                f'the scope {request.scope} cannot be reset alone: time and state are reset '
                'together, give 0')
        self._reset()

    async def _step(self, request: Any, _: Any) -> None:
        await self._device.ask_later(
            lambda answer: self._run_loop.step(_checked_steps(request.steps), answer))


class SimulateStepsAction(Actions):
    """Serve simulate_steps, relative to the namespace of the node."""

    def __init__(
            self, node: GuardedNode, device: DeviceThread, simulation: Simulation,
            run_loop: RunLoop, changed: Callable[[], None]) -> None:
        """Make the server."""
        super().__init__(node, device)
        self._steps = Steps(simulation, run_loop, changed)
        self.look = self._steps.look
        self.serve(SimulateSteps, 'simulate_steps', self._begin)

    def note_end(self, result: Any, message: str, error: Exception | None) -> None:
        """Write how it has ended into ``result``."""
        result.result = Result(result=Result.RESULT_OK) if error is None else result_of(error)

    def _begin(self, handle: ServerGoalHandle, _: Any, answer: Answer) -> None:
        steps = _checked_steps(handle.request.steps)

        def feedback(made: int, _: float) -> None:
            self.publish(handle, SimulateSteps.Feedback(
                completed_steps=made, remaining_steps=steps - made))

        self.stops[handle_number(handle)] = self._steps.begin(
            steps, feedback, lambda error, made, time: answer(error or f'{made} steps'))


def result_of(error: Exception) -> Result:
    """Return the result that ``error`` stands for."""
    code: int = Result.RESULT_OPERATION_FAILED
    if isinstance(error, _ResultError):
        code = error.code
    elif isinstance(error, NotFoundError):
        code = Result.RESULT_NOT_FOUND
    return Result(result=code, error_message=str(error))


def _checked_steps(steps: int) -> int:
    # Their field is wider than any number of steps that can be made.
    return min(steps, 2**32 - 1)


def _twist(path: FramePath) -> Twist:
    """Return the velocities of a frame under way."""
    axis, angle = rotation_between(path.origin.orientation, path.target.orientation)
    rate = angle / (path.arrival - path.begin)
    return Twist(linear=vector(path.velocity), angular=vector(np.array(axis) * rate))
