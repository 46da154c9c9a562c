# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""Record a run that has no node, as the node would have, and one that a program drives."""

from collections.abc import Callable
from collections.abc import Mapping
from contextlib import AbstractContextManager
import math
import os
import time
from typing import Any
import warnings

from cloth_sim_interfaces.msg import ClothState
from cloth_sim_ros.files.errors import shown
from cloth_sim_ros.messages.frame_messages import FrameMessages
from cloth_sim_ros.messages.frame_messages import FrameTaker
from cloth_sim_ros.messages.frame_messages import Pace
from cloth_sim_ros.messages.inputs import input_message
from cloth_sim_ros.messages.pins import too_many_pins
from cloth_sim_ros.messages.stamp import nanoseconds
from cloth_sim_ros.messages.state import state_of
from cloth_sim_ros.node.node_fields import checked_node_values
from cloth_sim_ros.node.node_fields import NODE_FIELDS
from cloth_sim_ros.node.recording_session import RecordingSession
from cloth_sim_ros.node.recording_session import write_opening
from cloth_sim_ros.recording.bag_folder import RecordingOptions
from cloth_sim_ros.recording.recording_faults import RecordingError
from cloth_sim_ros.recording.recording_faults import RecordingFull
from cloth_sim_ros.sim.arguments import instance
from cloth_sim_ros.sim.arguments import mapping
from cloth_sim_ros.sim.arguments import path as checked_path
from cloth_sim_ros.sim.arguments import vector
from cloth_sim_ros.sim.arguments import word
from cloth_sim_ros.sim.errors import ClothSimError
from cloth_sim_ros.sim.errors import NonFiniteStateError
from cloth_sim_ros.sim.inputs import Input
from cloth_sim_ros.sim.inputs import InputListener
from cloth_sim_ros.sim.inputs import ReplaceState
from cloth_sim_ros.sim.inputs import Reset
from cloth_sim_ros.sim.model.cameras import CameraModel
from cloth_sim_ros.sim.scene import refuse_unknown
from cloth_sim_ros.sim.simulation import Simulation
import numpy as np
from rclpy.serialization import serialize_message


class RunRecording:
    """
    A recording of points, stats, pins, grasps, colliders and inputs.

    ``problem`` says why it is not whole; it is empty when it is, or when it was completed at the
    size that was requested.

    :param directory: folder that the recording's own folder is made in
    :param lost: called with the reason when the recording has ended before it was closed; by
        default that is said
    :param node_name: for the names of the topics, with its namespace
    :param say: is given each thing that a user should know, one sentence
    :param setting: what ``directory`` was given by, for errors
    """

    def __init__(
            self, simulation: Simulation, node_values: dict[str, Any], directory: str, *,
            say: Callable[[str], None], lost: Callable[[RecordingError], None] | None = None,
            node_name: str = 'cloth_sim',
            setting: str = '--record') -> None:
        """Open the recording and write what it begins with, the start pose too."""
        self._simulation = simulation
        self._say = say
        self._lost = lost or (lambda error: say(str(error)))
        self._node_values = node_values
        self._node_name = node_name
        self._unplaced: set[str] = set()
        self._frame_id = node_values['frame_id']
        self._taker = FrameTaker(simulation, {
            **node_values, 'publish.clock': False, 'publish.points': True, 'publish.stats': True},
            self._place_camera)
        self._messages = FrameMessages(simulation.scene, node_name, self._frame_id)
        self.problem = ''
        self._session = RecordingSession(
            directory, node_name, self._on_lost, setting,
            options=RecordingOptions.from_values({**simulation.scene.values, **node_values}))
        self.path = self._session.start(node_values['recording.name'])
        values = {**simulation.scene.values, **node_values}
        write_opening(self._session, simulation, values, f'/{node_name.strip("/")}')
        self._write_state(ClothState.RUNNING)
        reason = too_many_pins(int(np.count_nonzero(
            simulation.pinned_nodes() & ~simulation.grasped_nodes())))
        if reason and (node_values['publish.wrenches'] or node_values['publish.tf']):
            self._say(reason)
        # How many frames have been begun, and the times of the last but one and the last [s].
        self._begun = (0, 0.0, 0.0)
        self.write(0.0, 0.0)

    def write(self, step_wall_time: float, real_time_factor: float) -> None:
        """Write the present instant."""
        if not self._session.active:
            return
        frame = self._taker.take(
            self._session.takes,
            lambda: Pace(step_wall_time, steps=1, achieved=real_time_factor))
        count, _, before = self._begun
        # At once, as an interrupt may come between any two statements.
        self._begun = (count + 1, before, frame.time)
        for key, data in self._messages.of(frame):
            self._session.write(key, data, frame.time)

    def write_input(self, given: Input, time: float) -> None:
        """Write an accepted input, which acts from ``time`` [s] on."""
        made = input_message(given, time, self._frame_id)
        if made is not None:
            key, message = made
            self._session.write(key, serialize_message(message), time)
        if isinstance(given, Reset):
            self._session.rewind(nanoseconds(time))

    def write_stop(self) -> None:
        """Write that the run has stopped before its end."""
        self._write_state(ClothState.STOPPED)

    def close(self) -> None:
        """Finish the recording; where that fails, ``problem`` says so."""
        self._taker.close()
        try:
            self._session.close()
        except RecordingError as error:
            self._on_lost(error)

    def close_interrupted(self) -> None:
        """Finish the recording of a run that was interrupted, and say how far it goes."""
        is_whole = self._session.active
        try:
            self.close()
        finally:
            if is_whole and not self.problem:
                # A frame is there once its statistics are.
                count, before, last = self._begun
                end = last if self._session.written('stats') == count else before
                self._say(
                    f'interrupted; the recording {self.path} is complete up to {end:.6g} s')

    def _write_state(self, run_state: str) -> None:
        state = state_of(
            self._simulation, frame_id=self._frame_id, run_state=run_state,
            recording_path=self.path)
        self._session.write('state', serialize_message(state), self._simulation.time)

    def _place_camera(self, camera: CameraModel) -> None:
        """Say once that there is no tf to attach ``camera`` to."""
        if camera.name not in self._unplaced:
            self._unplaced.add(camera.name)
            self._say(
                f'camera {camera.name} takes no pictures, as only a node knows its frame '
                f'{shown(camera.frame)}: leave cameras.{camera.name}.frame out')

    def _on_lost(self, error: RecordingError) -> None:
        if not isinstance(error, RecordingFull):
            self.problem = str(error)
        self._lost(error)


# Record a simulation that a Python program drives.

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
        instance(simulation, Simulation, 'what is recorded', 'give a Simulation')
        folder = checked_path(directory, 'the directory')
        word(name, 'the name of a recording', 'leave it out for one of date and time')
        word(node, 'the name of the node', "give one like 'cloth_sim'")
        parameters = {} if parameters is None else mapping(
            parameters, 'the parameters', "give them by name, {'publish.rate': 50.0}")
        if type(simulation.listener) is not InputListener:
            raise ClothSimError(
                'this simulation is already being recorded: close its recorder before creating '
                'another')
        given = {**parameters, 'recording.name': name}
        refuse_unknown(given, NODE_FIELDS)
        values = checked_node_values(given)
        self._simulation = simulation
        self._frame_seconds = max(1.0 / values['publish.rate'], simulation.dt)
        self._ending: RecordingError | None = None
        self._recording = RunRecording(
            simulation, values, os.fspath(folder), say=_warn, lost=self._keep,
            node_name=node, setting='directory')
        self.path: str = self._recording.path
        self._is_open = True
        simulation.listener = _RecordedInputs(self._recording)

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
        seconds = simulation.stepping.checked_seconds(seconds)
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
        measured = vector(
            (step_wall_time, real_time_factor), 'step_wall_time and real_time_factor', '',
            length=2, hint='give 0 where it was not measured')
        self._recording.write(*measured)
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


class _RecordedInputs(InputListener):
    """Records the inputs that a simulation accepts."""

    def __init__(self, recording: RunRecording) -> None:
        self._recording = recording

    def check(self, given: Input) -> None:
        if isinstance(given, ReplaceState):
            raise ClothSimError(
                'a new state cannot be recorded, and the run could not be resimulated after one: '
                'close the recorder, set the state, and create another recorder')

    def accept(self, given: Input, time: float) -> None:
        self._recording.write_input(given, time)
