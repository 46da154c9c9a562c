# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""Convert frames to messages and record them, as a node does, but without a node."""

from collections.abc import Collection
from pathlib import Path

from cloth_sim_ros.messages.frame import PointsMessage
from cloth_sim_ros.messages.frame import stats_message
from cloth_sim_ros.messages.markers import MarkersMessage
from cloth_sim_ros.messages.pins import too_many_pins
from cloth_sim_ros.messages.pins import WrenchMessages
from cloth_sim_ros.recording.recorder import Recorder
from cloth_sim_ros.sim.simulation import Simulation
import numpy as np
from rclpy.serialization import serialize_message

_NODE_NAME = 'cloth_sim'
_FRAME_ID = 'world'
_TOPICS = {'wrenches': 'pins/wrenches'}


class FrameMaker:
    """
    Serialises the wanted messages of the moment.

    :param outputs: of points, markers, stats, wrenches and recording; a recording keeps what is
        made, but for markers
    :param folder: for the recording
    """

    def __init__(self, run: Simulation, outputs: Collection[str], folder: Path) -> None:
        """Prepare the messages."""
        scene = run.scene
        self._run = run
        self._outputs = outputs
        self._points = PointsMessage(
            scene.rows, scene.cols, _FRAME_ID, is_dense=not scene.has_gaps)
        self._markers = MarkersMessage(
            scene.rows, scene.cols, _FRAME_ID, present=scene.cut_cells)
        self._wrenches = WrenchMessages(_NODE_NAME)
        self._has_wrenches = 'wrenches' in outputs and not too_many_pins(
            int(np.count_nonzero(run.pinned_nodes())))
        self._folder = folder
        self._recorder: Recorder | None = None

    def begin(self) -> None:
        """Begin a recording, if there is to be one."""
        if 'recording' in self._outputs:
            self._recorder = Recorder(self._folder)

    def make(self) -> int:
        """Make the messages of the present frame and return their bytes."""
        if not set(self._outputs) - {'recording'}:
            return 0
        snapshot = self._run.snapshot(pin_forces=self._has_wrenches)
        made: list[tuple[str, bytes]] = []
        if 'points' in self._outputs:
            made.append(('points', self._points.serialise(snapshot)))
        if 'markers' in self._outputs:
            made.append(('markers', self._markers.serialise(
                snapshot, [applied.push for applied in self._run.pushes])))
        if 'stats' in self._outputs:
            made.append(('stats', serialize_message(stats_message(snapshot, _FRAME_ID))))
        if self._has_wrenches:
            pins = snapshot.pin_forces
            assert pins is not None  # requested above
            made += [('wrenches', data) for data in self._wrenches.serialise(
                pins.nodes, pins.forces, snapshot.time)]
        if self._recorder is not None:
            for key, data in made:
                self._recorder.write(_TOPICS.get(key, key), data, snapshot.time)
        return sum(len(data) for _, data in made)

    def close(self) -> None:
        """Finish the recording: wait until all is on its way to the disk."""
        recorder, self._recorder = self._recorder, None
        if recorder is not None:
            recorder.close()
