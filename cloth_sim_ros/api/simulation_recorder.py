# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""Record a simulation that a Python program drives."""

from collections.abc import Mapping
from contextlib import AbstractContextManager
import math
import os
import time
from typing import Any
import warnings

from cloth_sim_ros.api.run_recording import RunRecording
from cloth_sim_ros.node.inputs import Inputs
from cloth_sim_ros.node.node_fields import checked_node_values
from cloth_sim_ros.node.node_fields import NODE_FIELDS
from cloth_sim_ros.recording.recording_faults import RecordingError
from cloth_sim_ros.sim.errors import ClothSimError
from cloth_sim_ros.sim.errors import NonFiniteStateError
from cloth_sim_ros.sim.handling import InputListener
from cloth_sim_ros.sim.handling import RESET
from cloth_sim_ros.sim.scene import refuse_unknown
from cloth_sim_ros.sim.simulation import Simulation

_ROUNDING = 1e-9  # of a sum of frame times


class SimulationRecorder(AbstractContextManager['SimulationRecorder']):
    """
    Writes frames on request, and every input of the simulation automatically.

    Pushes, pins, grasps, moves of these and of colliders, switches of the mode and resets are
    recorded when the simulation gets them, so that ``cloth_sim resimulate`` and ``resimulate`` can
    make the run again. The recording is one of a node: mcap with the topics of
    docs/reference/ros_interface.md, the present instant first. As a context manager it is closed
    at the end of the block. Needs the ROS packages.

    ``path`` is the absolute path of the recording's folder.

    :param simulation: may be at any time; one recorder at a time
    :param directory: the recording's folder is made in here
    :param name: of that folder; empty for one made of the date and the time
    :param node: name that the topics begin with
    :param parameters: of the node, by name, such as ``publish.rate`` [Hz], ``frame_id`` or
        ``recording.max_size`` [bytes]
    :raises ClothSimError: when the folder is taken or can't be written, a parameter is wrong, or
        the simulation is being recorded
    """

    def __init__(
            self, simulation: Simulation, directory: str | os.PathLike[str], name: str = '', *,
            node: str = 'cloth_sim', parameters: Mapping[str, Any] | None = None) -> None:
        """Open the recording and write what it begins with."""
        if type(simulation.listener) is not InputListener:
            raise ClothSimError(
                'this simulation is already being recorded: close its recorder before creating '
                'another')
        given = {**(parameters or {}), 'recording.name': name}
        refuse_unknown(given, NODE_FIELDS)
        values = checked_node_values(given)
        self._simulation = simulation
        self._frame_seconds = max(1.0 / values['publish.rate'], simulation.dt)
        self._ending: RecordingError | None = None
        self._recording = RunRecording(
            simulation, values, os.fspath(directory), say=_warn, lost=self._keep,
            node_name=node, setting='directory')
        self.path: str = self._recording.path
        self._is_open = True
        simulation.listener = _RecordedInputs(
            self._recording, simulation, values['frame_id'], node)

    def __exit__(self, *_: object) -> None:
        """Close, however the block has ended."""
        self.close()

    def advance(self, seconds: float) -> int:
        """
        Advance the simulation by ``seconds``, and write a frame each 1 / ``publish.rate``.

        :return: steps of dt made
        :raises NonFiniteStateError: when the state is lost; the last finite one is written
        :raises RecordingError: when the recording can't go on, with all before it written
        """
        simulation = self._simulation
        first = simulation.steps
        if not 0.0 <= seconds < math.inf:
            # It has the words for what is wrong.
            simulation.advance(seconds)
        for frame in range(math.ceil(seconds / self._frame_seconds - _ROUNDING)):
            self._make_frame(min(self._frame_seconds, seconds - frame * self._frame_seconds))
        return simulation.steps - first

    def write(self, step_wall_time: float = 0.0, real_time_factor: float = 0.0) -> None:
        """
        Write the current state as a frame.

        :param step_wall_time: of a step of dt since the frame before [s]; 0 when not measured
        :param real_time_factor: simulated time per wall time since then; 0 when not measured
        :raises RecordingError: when the recording can't go on, or is closed
        """
        if not self._is_open:
            raise RecordingError(
                f'the recording {self.path} is closed: create another SimulationRecorder')
        self._recording.write(step_wall_time, real_time_factor)
        if self._ending is not None:
            raise self._ending

    def close(self) -> None:
        """
        Complete the recording; does nothing when called again.

        :raises RecordingError: when its end can't be written
        """
        if not self._is_open:
            return
        self._is_open = False
        self._simulation.listener = InputListener()
        before, self._ending = self._ending, None
        self._recording.close()
        if before is None and self._ending is not None:
            raise self._ending

    def _make_frame(self, seconds: float) -> None:
        simulation = self._simulation
        lost: NonFiniteStateError | None = None
        before, begin = simulation.steps, time.perf_counter()
        try:
            simulation.advance(seconds)
        except NonFiniteStateError as error:
            lost = error
        simulation.finish()
        wall = time.perf_counter() - begin
        made = simulation.steps - before
        if made:
            self.write(wall / made, made * simulation.dt / wall)
        if lost is not None:
            self._recording.write_stop()
            raise lost

    def _keep(self, error: RecordingError) -> None:
        self._ending = error


def _warn(sentence: str) -> None:
    warnings.warn(sentence, stacklevel=5)


class _RecordedInputs(Inputs, InputListener):
    """Records what a simulation hears of."""

    def __init__(
            self, recording: RunRecording, simulation: Simulation, frame_id: str,
            node: str) -> None:
        super().__init__(recording, simulation, frame_id, node)
        self._recording = recording

    def command(self, command: str) -> None:
        super().command(command)
        if command == RESET:
            self._recording.rewind()

    def new_state(self) -> None:
        raise ClothSimError(
            'a new state cannot be recorded, and the run could not be resimulated after one: '
            'close the recorder, set the state, and create another recorder')
