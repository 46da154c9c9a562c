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

"""The recording of a node: at most one at a time, and never the end of the node."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING

from cloth_sim_ros.node.missing_module import way_out
from cloth_sim_ros.recording.bag_folder import DIRECTORY_SETTING
from cloth_sim_ros.recording.recording_error import RecordingError
from cloth_sim_ros.sim.errors import ClothSimError

if TYPE_CHECKING:
    from cloth_sim_ros.recording.recorder import Recorder


class RecordingSession:
    """
    Start, feed and stop recordings.

    :param directory: folder that every recording goes into
    :param node_name: with its namespace, for the names of the topics
    :param lost: called with the reason when a recording ends because it can't be written to
    :param setting: what ``directory`` was given by, for errors
    """

    def __init__(
            self, directory: str, node_name: str, lost: Callable[[str], None],
            setting: str = DIRECTORY_SETTING) -> None:
        """Prepare; nothing is written yet."""
        self._directory = directory
        self._node_name = node_name
        self._lost = lost
        self._setting = setting
        self._recorder: Recorder | None = None
        self._offset = 0.0

    @property
    def active(self) -> bool:
        """Tell whether a recording is being written."""
        return self._recorder is not None

    @property
    def path(self) -> str:
        """Absolute path of the folder being written to; empty when there is none."""
        return str(self._recorder.path) if self._recorder else ''

    def start(self, name: str = '') -> str:
        """Open a recording and return its path; ClothSimError when that can't be."""
        if self._recorder is not None:
            raise ClothSimError(
                f'a recording is being written to {self.path}: stop it first, by ~/stop_recording '
                'or `cloth_sim record stop`')
        self._recorder = self._open(name)
        self._offset = 0.0
        return self.path

    def write(self, key: str, data: bytes, sim_time: float) -> None:
        """Write the serialised message of the topic ``key`` at ``sim_time`` [s]."""
        if self._recorder is None:
            return
        try:
            self._recorder.write(key, data, self._offset + sim_time)
        except RecordingError as error:
            self._recorder = None
            self._lost(str(error))

    def rewind(self, sim_time: float) -> None:
        """Go on as simulated time returns from ``sim_time`` [s] to 0: players need it to grow."""
        self._offset += sim_time

    def stop(self) -> str:
        """Close the recording and return its path; ClothSimError when there is none."""
        if self._recorder is None:
            raise ClothSimError(
                'no recording is being written: start one first, by ~/start_recording or '
                '`cloth_sim record start`')
        path = self.path
        self.close()
        return path

    def close(self) -> None:
        """Close the recording, if there is one, without the help of ROS."""
        recorder, self._recorder = self._recorder, None
        if recorder is not None:
            recorder.close()

    def _open(self, name: str) -> Recorder:
        try:
            # What writes recordings comes from pip, not from ROS: a node runs without it.
            from cloth_sim_ros.recording.recorder import Recorder
        except ImportError as error:
            raise ClothSimError(way_out(error)) from error
        return Recorder(
            self._directory, name, self._node_name, setting=self._setting)
