# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""The recording of a node: at most one at a time, and never the end of the node."""

from __future__ import annotations

from collections.abc import Callable
from collections.abc import Mapping
from pathlib import Path
import threading
from typing import Any
from typing import TYPE_CHECKING

from cloth_sim_ros.messages.geometry import serialise_topology
from cloth_sim_ros.messages.inputs import input_message
from cloth_sim_ros.messages.inputs import parameters_message
from cloth_sim_ros.messages.inputs import place_message
from cloth_sim_ros.messages.inputs import serialise_parameter_event
from cloth_sim_ros.messages.time_base import TimeBase
from cloth_sim_ros.node.missing_module import way_out
from cloth_sim_ros.node.parameters import FIELDS
from cloth_sim_ros.recording.bag_folder import DIRECTORY_SETTING
from cloth_sim_ros.recording.bag_folder import RecordingOptions
from cloth_sim_ros.recording.recording_faults import RecordingError
from cloth_sim_ros.recording.recording_faults import refusal
from cloth_sim_ros.recording.writer_choice import chosen_library
from cloth_sim_ros.sim.errors import ClothSimError
from cloth_sim_ros.sim.errors import WrongStateError
from cloth_sim_ros.sim.inputs import Input
from cloth_sim_ros.sim.inputs import MoveCollider
from cloth_sim_ros.sim.inputs import MoveGrasp
from cloth_sim_ros.sim.inputs import MovePin
from cloth_sim_ros.sim.inputs import Pin
from cloth_sim_ros.sim.inputs import PushNodes
from cloth_sim_ros.sim.inputs import SetMode
from cloth_sim_ros.sim.inputs import SetWind
from cloth_sim_ros.sim.inputs import TakeGrasp
from cloth_sim_ros.sim.inputs import Unpin
from cloth_sim_ros.sim.model.named_fields import all_fields
from cloth_sim_ros.sim.simulation import Simulation
import numpy as np
from rclpy.serialization import serialize_message

if TYPE_CHECKING:
    from cloth_sim_ros.recording.recorder import Recorder


def write_opening(
        recording: RecordingSession, simulation: Simulation, values: Mapping[str, Any],
        node_name: str, base: TimeBase = TimeBase()) -> None:
    """
    Record the rest shape, and as inputs all that holds now.

    Pins are written where they differ from the parameter, grasps where they hold nodes, colliders
    where they are not where the scene has them; targets of these where they are under way; pushes
    where they act or will act; the wind where it is not that of the parameter. Of the parameters,
    ``loads`` and ``block`` are written as they were chosen for the device, and ``shape.mask`` as
    an image instead of its path.

    :param values: parameter values by name
    :param node_name: with its namespace
    :param base: of the stamps
    """
    now, epoch = simulation.time, base.epoch
    frame_id = values['frame_id']
    recording.write('topology', serialise_topology(simulation.scene), now, epoch=epoch)
    recording.write(
        'inputs/time_base', serialize_message(base.message(now)), now, epoch=epoch)
    parameters = parameters_message(
        {**values, **vars(simulation.layout.choice),
         'shape.mask': simulation.scene['shape.mask']}, all_fields(values, FIELDS), now,
        node_name, epoch=epoch)
    recording.write(
        'inputs/parameters', serialise_parameter_event(parameters), now, epoch=epoch)
    held: list[Input] = []
    pinned = simulation.pinned_nodes() & ~simulation.grasped_nodes()
    for row, col in np.argwhere(pinned != simulation.scene.pinned_nodes()).tolist():
        held.append(Pin(row, col) if pinned[row, col] else Unpin(row, col))
    held += [MovePin.of(move) for move in simulation.pin_moves]
    held += [TakeGrasp.of(grasp) for grasp in simulation.grasps]
    held += [MoveGrasp.of(path.move) for path in simulation.grasp_paths]
    later: list[Input] = [PushNodes(applied.push) for applied in simulation.pushes]
    if simulation.loads.wind not in (None, simulation.scene['air.wind']):
        later.append(SetWind(simulation.loads.wind))
    inputs = [
        input_message(SetMode(simulation.mode), now, frame_id, epoch),
        *(input_message(given, now, frame_id, epoch) for given in held)]
    for moved in simulation.moved_colliders:
        inputs.append((
            'inputs/collider_target', place_message(
                moved.name, moved.pose, now, frame_id, epoch)))
        if moved.path is not None:
            inputs.append(input_message(
                MoveCollider.of(moved.path.move), now, frame_id, epoch))
    inputs += [input_message(given, now, frame_id, epoch) for given in later]
    for made in filter(None, inputs):
        key, message = made
        recording.write(key, serialize_message(message), now, epoch=epoch)


class RecordingSession:
    """
    Start, feed and stop recordings.

    :param directory: folder that every recording goes into
    :param node_name: with its namespace, for the names of the topics
    :param lost: called with the reason when a recording has ended before it was stopped
    :param setting: what ``directory`` was given by, for errors
    :param options: files, limit and fsync of each recording
    :param wake: called on another thread when ``check`` has an end to report

    ``library`` is which of LIBRARIES writes them, empty for none.
    """

    def __init__(
            self, directory: str, node_name: str, lost: Callable[[RecordingError], None],
            setting: str = DIRECTORY_SETTING, *,
            options: RecordingOptions = RecordingOptions(),
            wake: Callable[[], None] | None = None) -> None:
        """Prepare; nothing is written yet."""
        self._directory = directory
        self._node_name = node_name
        self._lost = lost
        self._setting = setting
        self._options = options
        self._wake = wake
        # Chosen once: a library that is installed meanwhile would be half of another choice.
        self.library = chosen_library()
        # Recordings begin on the device thread, and are written and end on that of ROS.
        self._lock = threading.RLock()
        self._number = 0
        self._recorder: Recorder | None = None
        self._latest: Recorder | None = None
        self._ending: RecordingError | None = None
        self._offset = 0  # [ns]

    @property
    def active(self) -> bool:
        """Return whether a recording is being written."""
        return self._recorder is not None

    def takes(self, key: str) -> bool:
        """Return whether messages of the topic ``key`` are being recorded."""
        recorder = self._recorder
        return recorder is not None and recorder.takes(key)

    @property
    def path(self) -> str:
        """Absolute path of the folder being written to; empty when there is none."""
        recorder = self._recorder
        return str(recorder.path) if recorder else ''

    @property
    def ending(self) -> RecordingError | None:
        """Get why the last recording has ended before it was stopped; None when it has not."""
        return self._ending

    @property
    def number(self) -> int:
        """Get a number that the recording being written has, and no other; 0 for none."""
        return self._number if self._recorder is not None else 0

    def start(self, name: str = '', opening: Callable[[], None] | None = None) -> str:
        """
        Open a recording and return its path; ClothSimError when that can't be.

        :param opening: called to write what it begins with, before anything else is written
        """
        with self._lock:
            self.check()
            if self._recorder is not None:
                raise WrongStateError(
                    f'a recording is being written to {self.path}: stop it first, with '
                    '~/stop_recording or `cloth_sim record stop`')
            self._recorder = self._latest = self._open(name)
            self._number += 1
            self._ending = None
            self._offset = 0
            path = self.path
            if opening is not None:
                opening()
            return path

    def write(
            self, key: str, data: bytes, sim_time: float, number: int | None = None,
            epoch: int = 0) -> None:
        """
        Write the serialised message of the topic ``key`` at ``sim_time`` [s].

        :param number: of the recording that it belongs to; None for the present one
        :param epoch: stamp of simulated time 0 [ns]
        """
        with self._lock:
            if self._recorder is None or number not in (None, self._number):
                return
            try:
                self._recorder.write(key, data, sim_time, self._offset + epoch)
            except RecordingError as error:
                self._end(error)

    def written(self, key: str) -> int:
        """Return how many messages of the topic ``key`` the latest recording has."""
        return self._latest.written(key) if self._latest is not None else 0

    def check(self) -> None:
        """Report that the recording has ended by itself."""
        with self._lock:
            if self._recorder is None:
                return
            try:
                self._recorder.check()
            except RecordingError as error:
                self._end(error)

    def rewind(self, before: int, number: int | None = None, after: int = 0) -> None:
        """
        Go on as stamps return from ``before`` to ``after`` [ns]: players need them to grow.

        :param number: as of ``write``
        """
        with self._lock:
            if number in (None, self._number):
                self._offset += max(before - after, 0)

    def stop(self) -> str:
        """
        Close the recording and return its path.

        :raises ClothSimError: when there is none, or when it does not go up to here
        """
        with self._lock:
            if self._recorder is None:
                raise self._ending or WrongStateError(
                    'no recording is being written: start one first, with ~/start_recording or '
                    '`cloth_sim record start`')
            path = self.path
            try:
                self._recorder.close()
            except RecordingError as error:
                self._end(error)
                raise
            self._recorder = None
            return path

    def close(self) -> None:
        """Close the recording, if there is one, without the help of ROS."""
        with self._lock:
            recorder, self._recorder = self._recorder, None
            if recorder is not None:
                recorder.close()

    def _end(self, error: RecordingError) -> None:
        self._recorder = None
        self._ending = error
        self._lost(error)

    def _open(self, name: str) -> Recorder:
        try:
            # What writes recordings need not be there: a node runs without it.
            from cloth_sim_ros.recording.recorder import Recorder
            return Recorder(
                self._directory, name, self._node_name, setting=self._setting,
                options=self._options, on_end=self._wake, library=self.library)
        except ImportError as error:
            raise ClothSimError(way_out(error)) from error
        except OSError as error:
            raise refusal(Path(self._directory), error, self._setting) from error
