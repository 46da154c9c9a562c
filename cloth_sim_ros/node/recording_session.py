# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""The recording of a node: at most one at a time, and never the end of the node."""

from __future__ import annotations

from collections.abc import Callable
from collections.abc import Mapping
from pathlib import Path
from typing import Any
from typing import TYPE_CHECKING

from cloth_sim_ros.messages.geometry import serialise_topology
from cloth_sim_ros.messages.inputs import frame_target_message
from cloth_sim_ros.messages.inputs import grasp_message
from cloth_sim_ros.messages.inputs import mode_message
from cloth_sim_ros.messages.inputs import parameters_message
from cloth_sim_ros.messages.inputs import pin_message
from cloth_sim_ros.messages.inputs import pin_target_message
from cloth_sim_ros.messages.inputs import place_message
from cloth_sim_ros.messages.inputs import push_message
from cloth_sim_ros.messages.inputs import serialise_parameter_event
from cloth_sim_ros.messages.inputs import wind_message
from cloth_sim_ros.node.missing_module import way_out
from cloth_sim_ros.node.parameters import FIELDS
from cloth_sim_ros.recording.bag_folder import DIRECTORY_SETTING
from cloth_sim_ros.recording.bag_folder import RecordingOptions
from cloth_sim_ros.recording.recording_faults import RecordingError
from cloth_sim_ros.recording.recording_faults import refusal
from cloth_sim_ros.sim.colliders import fields_with_colliders
from cloth_sim_ros.sim.errors import ClothSimError
from cloth_sim_ros.sim.simulation import Simulation
import numpy as np
from rclpy.serialization import serialize_message

if TYPE_CHECKING:
    from cloth_sim_ros.recording.recorder import Recorder


def write_opening(
        recording: RecordingSession, simulation: Simulation, values: Mapping[str, Any],
        node_name: str) -> None:
    """
    Record the rest shape, and as inputs all that holds now.

    Pins are written where they differ from the parameter, grasps where they hold nodes, colliders
    where they are not where the scene has them; targets of these where they are under way; pushes
    where they act or will act; the wind where it is not that of the parameter. Of the parameters,
    ``loads`` and ``block`` are written as they were chosen for the device.

    :param values: parameter values by name
    :param node_name: with its namespace
    """
    now = simulation.time
    frame_id = values['frame_id']
    recording.write('topology', serialise_topology(simulation.scene), now)
    parameters = parameters_message(
        {**values, **vars(simulation.layout.choice)}, fields_with_colliders(values, FIELDS), now,
        node_name)
    recording.write('inputs/parameters', serialise_parameter_event(parameters), now)
    inputs = [('inputs/mode', mode_message(simulation.mode, '', now, frame_id))]
    pinned = simulation.pinned_nodes() & ~simulation.grasped_nodes()
    for row, col in np.argwhere(pinned != simulation.scene.pinned_nodes()).tolist():
        inputs.append(
            ('inputs/pin', pin_message(row, col, bool(pinned[row, col]), now, frame_id)))
    for move in simulation.pin_moves:
        inputs.append(('inputs/pin_target', pin_target_message(move, now, frame_id)))
    for grasp in simulation.grasps:
        inputs.append(('inputs/grasp', grasp_message(grasp, now, frame_id)))
    for path in simulation.grasp_paths:
        inputs.append(('inputs/grasp_target', frame_target_message(path.move, now, frame_id)))
    for moved in simulation.moved_colliders:
        key = 'inputs/collider_target'
        inputs.append((key, place_message(moved.name, moved.pose, now, frame_id)))
        if moved.path is not None:
            inputs.append((key, frame_target_message(moved.path.move, now, frame_id)))
    for applied in simulation.pushes:
        inputs.append(('inputs/push', push_message(applied.push, now, frame_id)))
    if simulation.loads.wind not in (None, simulation.scene['air.wind']):
        inputs.append(('inputs/wind', wind_message(simulation.loads.wind, now, frame_id)))
    for key, message in inputs:
        recording.write(key, serialize_message(message), now)


class RecordingSession:
    """
    Start, feed and stop recordings.

    :param directory: folder that every recording goes into
    :param node_name: with its namespace, for the names of the topics
    :param lost: called with the reason when a recording has ended before it was stopped
    :param setting: what ``directory`` was given by, for errors
    :param options: files, limit and fsync of each recording
    :param wake: called on another thread when ``check`` has an end to report
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
        self._recorder: Recorder | None = None
        self._ending: RecordingError | None = None
        self._offset = 0.0

    @property
    def active(self) -> bool:
        """Tell whether a recording is being written."""
        return self._recorder is not None

    def takes(self, key: str) -> bool:
        """Tell whether messages of the topic ``key`` are being recorded."""
        return self._recorder is not None and self._recorder.takes(key)

    @property
    def path(self) -> str:
        """Absolute path of the folder being written to; empty when there is none."""
        return str(self._recorder.path) if self._recorder else ''

    @property
    def ending(self) -> RecordingError | None:
        """Get why the last recording has ended before it was stopped; None when it has not."""
        return self._ending

    def start(self, name: str = '') -> str:
        """Open a recording and return its path; ClothSimError when that can't be."""
        self.check()
        if self._recorder is not None:
            raise ClothSimError(
                f'a recording is being written to {self.path}: stop it first, with '
                '~/stop_recording or `cloth_sim record stop`')
        self._recorder = self._open(name)
        self._ending = None
        self._offset = 0.0
        return self.path

    def write(self, key: str, data: bytes, sim_time: float) -> None:
        """Write the serialised message of the topic ``key`` at ``sim_time`` [s]."""
        if self._recorder is None:
            return
        try:
            self._recorder.write(key, data, self._offset + sim_time)
        except RecordingError as error:
            self._end(error)

    def check(self) -> None:
        """Report an end of the recording that nobody has asked for."""
        if self._recorder is None:
            return
        try:
            self._recorder.check()
        except RecordingError as error:
            self._end(error)

    def rewind(self, sim_time: float) -> None:
        """Go on as simulated time returns from ``sim_time`` [s] to 0: players need it to grow."""
        self._offset += sim_time

    def stop(self) -> str:
        """
        Close the recording and return its path.

        :raises ClothSimError: when there is none, or when it does not go up to here
        """
        if self._recorder is None:
            raise self._ending or ClothSimError(
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
        recorder, self._recorder = self._recorder, None
        if recorder is not None:
            recorder.close()

    def _end(self, error: RecordingError) -> None:
        self._recorder = None
        self._ending = error
        self._lost(error)

    def _open(self, name: str) -> Recorder:
        try:
            # What writes recordings comes from pip, not from ROS: a node runs without it.
            from cloth_sim_ros.recording.recorder import Recorder
        except ImportError as error:
            raise ClothSimError(way_out(error)) from error
        except OSError as error:
            raise refusal(Path(self._directory), error, self._setting) from error
        return Recorder(
            self._directory, name, self._node_name, setting=self._setting,
            options=self._options, on_end=self._wake)
