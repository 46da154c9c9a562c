# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""Apply the inputs of a recording to a simulation, and notify a listener of each."""

import math
from typing import Any

from cloth_sim_ros.resimulation.recorded_inputs import recorded_input
from cloth_sim_ros.sim.errors import ClothSimError
from cloth_sim_ros.sim.inputs import Input
from cloth_sim_ros.sim.inputs import InputListener
from cloth_sim_ros.sim.inputs import MoveGrasp
from cloth_sim_ros.sim.inputs import Release
from cloth_sim_ros.sim.inputs import Reset
from cloth_sim_ros.sim.inputs import SetMode
from cloth_sim_ros.sim.simulation import Simulation

_SECOND = 1_000_000_000  # [ns]
# Rounding of a whole number of steps, in steps of dt [1].
_ROUNDING = 1e-6


class Listener(InputListener):
    """
    Base class of listeners to the inputs and frames of a replay, in the recorded order; a no-op.

    On each call the simulation is at the time of the input or frame.

    ``path`` is where the listener writes them; empty if it does not.
    """

    path = ''

    @property
    def problem(self) -> str:
        """Why the inputs are not kept whole; empty where they are."""
        return ''

    def begin(self) -> None:
        """Note that the initial state is set."""

    def frame(self, step_wall_time: float, real_time_factor: float) -> None:
        """
        Note that now is one of the recording's frames.

        :param step_wall_time: of a step since the frame before [s]; 0 when there was none
        :param real_time_factor: simulated time per wall time in these steps
        """

    def stop(self) -> None:
        """Note that the run has stopped, at its last finite state."""

    def close_interrupted(self) -> None:
        """Note the end of an interrupted run."""

    def close(self) -> None:
        """Note the end of the run."""


class StepClock:
    """
    Counts the steps of dt before a recorded moment.

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
        return math.floor(self.recorded_time(stamp) / self._dt + _ROUNDING)

    def _recorded_steps(self, stamp: Any) -> int:
        # The whole seconds stay integers: a sum of floats would lose the last digits.
        return round((stamp.sec * _SECOND + stamp.nanosec) / (self._recorded_dt * _SECOND))


class InputReplay:
    """
    Applies inputs one by one, at the present time of ``simulation``.

    What cannot be done in this run is left out and noted in ``refused``: with other settings a
    pin may not be there, or no node be where a push was.

    ``resets`` and ``inputs`` count what was done, ``left_out_modes`` the switches not made.

    :param listener: is notified of what is accepted, and of grasps that are lost in this run
    :param keep_mode: True to make no switch of the mode
    """

    def __init__(self, simulation: Simulation, listener: Listener, *, keep_mode: bool) -> None:
        """Begin without inputs."""
        self._simulation = simulation
        self._keep_mode = keep_mode
        # When each grasp was lost that was [s].
        self._lost: dict[str, float] = {}
        simulation.listener = _WithLosses(listener, self._lost)
        self.refused: list[str] = []
        self.inputs = 0
        self.resets = 0
        self.left_out_modes = 0

    def take(self, key: str, message: Any) -> None:
        """Do what the decoded ``message`` of the topic ``key`` says."""
        now = self._simulation.time
        try:
            if key == 'inputs/parameters':
                self._refuse_physical(message)
                return
            given = recorded_input(key, message)
            if self._is_left_out(given):
                return
            before = self._simulation.mode
            self._simulation.apply(given)
        except ClothSimError as error:
            self.refused.append(f'at {now:.6g} s: {error}')
            return
        self.resets += isinstance(given, Reset)
        self.inputs += not (isinstance(given, SetMode) and given.mode == before)

    def _is_left_out(self, given: Input) -> bool:
        if isinstance(given, Release):
            # The rerun itself repeats the loss of a grasp by force.
            held = [grasp.name for grasp in self._simulation.grasps]
            return given.by_force or given.name not in held
        if isinstance(given, MoveGrasp):
            return self._lost.get(given.name) == self._simulation.time
        if isinstance(given, SetMode) and self._keep_mode:
            self.left_out_modes += 1
            return True
        return False

    def _refuse_physical(self, message: Any) -> None:
        if message.new_parameters:
            raise ClothSimError(
                'the recording restarts here: what follows is another run, record it separately')
        changed = [parameter.name for parameter in message.changed_parameters]
        physical = [name for name in changed if name in self._simulation.scene.values]
        if physical:
            raise ClothSimError(
                f'this version cannot change {", ".join(physical)} while running: the change is '
                'ignored')


class _WithLosses(InputListener):
    """
    Notes which grasps are lost, and tells ``listener`` everything.

    :param times: is given when [s], by the names of the grasps
    """

    def __init__(self, listener: Listener, times: dict[str, float]) -> None:
        self._listener = listener
        self._times = times

    def check(self, given: Input) -> None:
        self._listener.check(given)

    def accept(self, given: Input, time: float) -> None:
        if isinstance(given, Release) and given.by_force:
            self._times[given.name] = time
        self._listener.accept(given, time)
