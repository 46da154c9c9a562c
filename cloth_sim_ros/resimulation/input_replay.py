# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""Apply the inputs of a recording to a simulation, and notify a listener of each."""

import math
from typing import Any

from cloth_sim_ros.analysis.recorded_values import parts
from cloth_sim_ros.files.errors import shown
from cloth_sim_ros.sim.errors import ClothSimError
from cloth_sim_ros.sim.handling import CLEAR_PUSHES
from cloth_sim_ros.sim.handling import InputListener
from cloth_sim_ros.sim.handling import RESET
from cloth_sim_ros.sim.push import Push
from cloth_sim_ros.sim.simulation import Simulation


class Listener(InputListener):
    """
    Base class of listeners to the inputs and frames of a replay, in the recorded order; a no-op.

    On each call the simulation is at the time of the input or frame.

    ``path`` is where the listener writes them; empty if it does not.
    """

    path = ''

    @property
    def problem(self) -> str:
        """Why what was heard is not kept whole; empty where it is."""
        return ''

    def begin(self) -> None:
        """Hear that all is set that holds at the beginning."""

    def frame(self, step_wall_time: float, real_time_factor: float) -> None:
        """
        Hear that the present moment is one of the recording's frames.

        :param step_wall_time: of a step since the frame before [s]; 0 when there was none
        :param real_time_factor: simulated time per wall time in these steps
        """

    def stop(self) -> None:
        """Hear that the run has stopped, at its last finite state."""

    def close_interrupted(self) -> None:
        """Hear that there is no more to come, since somebody broke it off."""

    def close(self) -> None:
        """Hear that there is no more to come."""


# Give a simulation the inputs of a recording.

_SECOND = 1_000_000_000
_NOTHING = 1e-6
_LARGEST = 2**32 - 1


def recorded_push(message: Any) -> Push:
    """Return the push of a decoded Push message of ~/inputs/push; ClothSimError if it is none."""
    return Push.checked(
        force=parts(message.force), start=message.start, duration=message.duration,
        region=message.region, center=parts(message.center), radius=message.radius)


def recorded_nodes(message: Any) -> list[tuple[int, int]]:
    """Return the nodes of a decoded GraspChange message; ClothSimError if it has none."""
    rows, cols = list(message.rows), list(message.cols)
    try:
        nodes = [(int(row), int(col)) for row, col in zip(rows, cols)]
    except (OverflowError, TypeError, ValueError):  # the bag has defined them in another way
        nodes = []
    if not nodes or len(rows) != len(cols) or max(map(max, nodes)) > _LARGEST:
        raise ClothSimError(
            f'a recorded grasp has {len(rows)} rows and {len(cols)} columns of nodes: it needs as '
            'many numbers of each, record it again')
    return nodes


class StepClock:
    """
    Tell how many steps of dt lie before a recorded moment.

    A stamp has whole nanoseconds and dt need not, so the recorded step is the nearest one.

    :param recorded_dt: of the recorded run [s]
    :param dt: of the run that is made now [s]; with another one, a moment within a step is taken
        at the beginning of that step
    """

    def __init__(self, recorded_dt: float, dt: float) -> None:
        """Keep both."""
        self._recorded_dt = recorded_dt
        self._dt = dt

    def recorded_time(self, stamp: Any) -> float:
        """Return the simulated time of ``stamp`` [s], with all the digits of the recorded run."""
        return self._recorded_steps(stamp) * self._recorded_dt

    def steps(self, stamp: Any) -> int:
        """Return the steps made before the moment of ``stamp``, a ROS time."""
        if self._dt == self._recorded_dt:
            return self._recorded_steps(stamp)
        return math.floor(self.recorded_time(stamp) / self._dt + _NOTHING)

    def _recorded_steps(self, stamp: Any) -> int:
        # The whole seconds stay integers: a sum of floats would lose the last digits.
        return round((stamp.sec * _SECOND + stamp.nanosec) / (self._recorded_dt * _SECOND))


class InputReplay:
    """
    Takes inputs one by one, at the present moment of ``simulation``.

    What cannot be done in this run is left out and noted in ``refused``: with other settings a
    pin may not be there, or no node be where a push was.

    ``resets`` and ``inputs`` count what was done, ``left_out_modes`` the switches not made.

    :param keep_mode: True to make no switch of the mode
    """

    def __init__(self, simulation: Simulation, listener: Listener, *, keep_mode: bool) -> None:
        """Begin without inputs."""
        self._simulation = simulation
        self._listener = listener
        self._keep_mode = keep_mode
        # When each grasp was lost that was [s].
        self._lost: dict[str, float] = {}
        simulation.listener = _Losses(simulation, listener, self._lost)
        self._takers = {
            'inputs/push': self._push, 'inputs/pin': self._pin,
            'inputs/pin_target': self._pin_target, 'inputs/grasp': self._grasp,
            'inputs/grasp_target': self._grasp_target,
            'inputs/collider_target': self._collider_target, 'inputs/mode': self._mode,
            'inputs/wind': self._wind, 'inputs/command': self._command,
            'inputs/parameters': self._parameters}
        self.refused: list[str] = []
        self.inputs = 0
        self.resets = 0
        self.left_out_modes = 0

    def take(self, key: str, message: Any) -> None:
        """Do what the decoded ``message`` of the topic ``key`` says."""
        now = self._simulation.time
        try:
            self._takers[key](message)
        except ClothSimError as error:
            self.refused.append(f'at {now:.6g} s: {error}')

    def _push(self, message: Any) -> None:
        push = recorded_push(message)
        self._simulation.push(
            push.force, duration=push.duration, region=push.region, center=push.center,
            radius=push.radius, start=push.start)
        self.inputs += 1
        self._listener.push(push)

    def _pin(self, message: Any) -> None:
        row, col = int(message.row), int(message.col)
        if message.pinned:
            self._simulation.pin(row, col)
        else:
            self._simulation.release(row, col)
        self.inputs += 1
        self._listener.pin(row, col, bool(message.pinned))

    def _pin_target(self, message: Any) -> None:
        path = self._simulation.move_pin(
            int(message.row), int(message.col), parts(message.target), message.speed)
        self.inputs += 1
        self._listener.pin_target(path.move)

    def _grasp(self, message: Any) -> None:
        # The rerun itself repeats the loss of a grasp by force.
        if message.by_force:
            return
        if not message.grasped:
            if message.name not in self._names_held():
                return
            self._simulation.release_grasp(message.name)
            self._listener.grasp_release(message.name, False)
        else:
            grasp = self._simulation.grasp(
                message.name, parts(message.pose.position),
                (*parts(message.pose.orientation), message.pose.orientation.w),
                max_force=message.max_force, nodes=recorded_nodes(message))
            self._listener.grasp(grasp)
        self.inputs += 1

    def _grasp_target(self, message: Any) -> None:
        if self._lost.get(message.name) == self._simulation.time:
            return
        path = self._simulation.move_grasp(*_frame_move(message))
        self.inputs += 1
        self._listener.grasp_move(path.move)

    def _collider_target(self, message: Any) -> None:
        path = self._simulation.move_collider(*_frame_move(message))
        self.inputs += 1
        self._listener.collider_move(path.move)

    def _names_held(self) -> list[str]:
        return [grasp.name for grasp in self._simulation.grasps]

    def _wind(self, message: Any) -> None:
        velocity = parts(message.vector)
        self._simulation.set_wind(velocity)
        self.inputs += 1
        self._listener.wind(velocity)

    def _mode(self, message: Any) -> None:
        if self._keep_mode:
            self.left_out_modes += 1
            return
        previous = self._simulation.set_mode(message.mode)
        if message.mode != previous:
            self.inputs += 1
            self._listener.mode(message.mode, previous)

    def _command(self, message: Any) -> None:
        if message.command not in (RESET, CLEAR_PUSHES):
            raise ClothSimError(
                f'this version has no command {shown(message.command)}: it is ignored')
        self.inputs += 1
        self._listener.command(message.command)
        if message.command == RESET:
            self._simulation.reset()
            self.resets += 1
        else:
            self._simulation.clear_pushes()

    def _parameters(self, message: Any) -> None:
        if message.new_parameters:
            raise ClothSimError(
                'the recording restarts here: what follows is another run, record it separately')
        changed = [parameter.name for parameter in message.changed_parameters]
        physical = [name for name in changed if name in self._simulation.scene.values]
        if physical:
            raise ClothSimError(
                f'this version cannot change {", ".join(physical)} while running: the change is '
                'ignored')


def _frame_move(message: Any) -> tuple[Any, ...]:
    """Return the arguments of move_grasp and move_collider; a speed of 0 is any speed."""
    orientation = None if message.keep_orientation else (
        *parts(message.pose.orientation), message.pose.orientation.w)
    return (
        message.name, parts(message.pose.position), orientation, message.speed or None,
        message.angular_speed or None)


class _Losses(InputListener):
    """
    Is notified of grasps that are lost in this run.

    :param times: is given when [s], by the names of the grasps
    """

    def __init__(
            self, simulation: Simulation, listener: Listener, times: dict[str, float]) -> None:
        self._simulation = simulation
        self._listener = listener
        self._times = times

    def grasp_release(self, name: str, by_force: bool) -> None:
        if by_force:
            self._times[name] = self._simulation.time
            self._listener.grasp_release(name, True)
