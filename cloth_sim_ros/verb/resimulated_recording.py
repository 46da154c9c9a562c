# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""The recording of a run that is made again."""

from typing import Any

from cloth_sim_interfaces.msg import Command
from cloth_sim_ros.api.simulation_recorder import RunRecording
from cloth_sim_ros.node.outlet import Inputs
from cloth_sim_ros.resimulation.input_replay import Listener
from cloth_sim_ros.sim.frame_paths import FrameMove
from cloth_sim_ros.sim.grasps import Grasp
from cloth_sim_ros.sim.pins import PinMove
from cloth_sim_ros.sim.push import Push
from cloth_sim_ros.sim.simulation import Simulation
from cloth_sim_ros.verb.termination import sayer


class ResimulatedRecording(Listener):
    """
    Records inputs and frames as they are heard of, so that this run can be made again, too.

    ``recording`` is None before it begins, and ``path``, its folder, empty.

    :param node_values: the node's parameters by name
    :param directory: folder that the recording's own folder is made in
    :param node_name: of the recorded node, with its namespace
    """

    def __init__(
            self, simulation: Simulation, node_values: dict[str, Any], directory: str,
            node_name: str) -> None:
        """Keep the parts; nothing is written yet."""
        self._simulation = simulation
        self._arguments = (simulation, node_values, directory)
        self._node_name = node_name
        self._frame_id = node_values['frame_id']
        self.recording: RunRecording | None = None
        self._is_written = False
        self.path = ''

    def begin(self) -> None:
        """Open the recording and write what it begins with, and its first frame."""
        self.recording = RunRecording(
            *self._arguments, node_name=self._node_name, say=sayer('resimulate'),
            setting='--out')
        self._is_written = True
        self.path = self.recording.path
        self._inputs = Inputs(
            self.recording, self._simulation, self._frame_id, self._node_name)

    def push(self, push: Push) -> None:
        """Write a push."""
        self._inputs.push(push)

    def pin(self, row: int, col: int, pinned: bool) -> None:
        """Write that a node was pinned or released."""
        self._inputs.pin(row, col, pinned)

    def pin_target(self, move: PinMove) -> None:
        """Write that a pin sets off."""
        self._inputs.pin_target(move)

    def grasp(self, grasp: Grasp) -> None:
        """Write a grasp."""
        self._inputs.grasp(grasp)

    def grasp_release(self, name: str, by_force: bool) -> None:
        """Write the end of a grasp."""
        self._inputs.grasp_release(name, by_force)

    def grasp_move(self, move: FrameMove) -> None:
        """Write that a grasp sets off."""
        self._inputs.grasp_move(move)

    def collider_move(self, move: FrameMove) -> None:
        """Write that a collider sets off."""
        self._inputs.collider_move(move)

    def wind(self, velocity: tuple[float, float, float]) -> None:
        """Write another steady wind."""
        self._inputs.wind(velocity)

    def mode(self, mode: str, previous: str) -> None:
        """Write a switch of the mode."""
        self._inputs.mode(mode, previous)

    def command(self, command: str) -> None:
        """Write a command."""
        self._inputs.command(command)
        if command == Command.RESET:
            self._begun.rewind()

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
