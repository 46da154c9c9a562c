# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""The recording of a run that is made again."""

from typing import Any

from cloth_sim_ros.api.simulation_recorder import RunRecording
from cloth_sim_ros.resimulation.input_replay import Listener
from cloth_sim_ros.sim.inputs import Input
from cloth_sim_ros.sim.simulation import Simulation
from cloth_sim_ros.verb.termination import reporter


class ResimulatedRecording(Listener):
    """
    Records inputs and frames, so that this run can be repeated as well.

    ``recording`` is None before it begins, and ``path``, its folder, empty.

    :param node_values: the node's parameters by name
    :param directory: folder that the recording's own folder is made in
    :param node_name: of the recorded node, with its namespace
    """

    def __init__(
            self, simulation: Simulation, node_values: dict[str, Any], directory: str,
            node_name: str) -> None:
        """Keep the parts; nothing is written yet."""
        self._arguments = (simulation, node_values, directory)
        self._node_name = node_name
        self.recording: RunRecording | None = None
        self._is_written = False
        self.path = ''

    def begin(self) -> None:
        """Open the recording and write what it begins with, and its first frame."""
        self.recording = RunRecording(
            *self._arguments, node_name=self._node_name, say=reporter('resimulate'),
            setting='--out')
        self._is_written = True
        self.path = self.recording.path

    def accept(self, given: Input, time: float) -> None:
        """Write an input that acts from ``time`` [s] on."""
        self._begun.write_input(given, time)

    def frame(self, step_wall_time: float, real_time_factor: float) -> None:
        """Write the present moment, unless it is the beginning, which is written already."""
        is_written, self._is_written = self._is_written, False
        if not is_written or step_wall_time:
            self._begun.write(step_wall_time, real_time_factor)

    def stop(self) -> None:
        """Write that the run has stopped."""
        self._begun.write_stop()

    @property
    def _begun(self) -> RunRecording:
        assert self.recording is not None  # begin comes first
        return self.recording

    @property
    def problem(self) -> str:
        """Why the recording does not hold the run; empty when it does."""
        return self.recording.problem if self.recording is not None else ''

    def close(self) -> None:
        """Finish the recording."""
        if self.recording is not None:
            self.recording.close()

    def close_interrupted(self) -> None:
        """Finish the recording, and say how far it goes."""
        if self.recording is not None:
            self.recording.close_interrupted()
