# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""~/state: what the node is doing, sent when it changes and kept for late subscribers."""

from cloth_sim_ros.messages.state import state_of
from cloth_sim_ros.node.mode_switch import ModeSwitch
from cloth_sim_ros.node.outlet import Outlet
from cloth_sim_ros.node.recording_session import RecordingSession
from cloth_sim_ros.node.run_loop import RunLoop
from cloth_sim_ros.sim.simulation import Simulation


class StateTopic:
    """Send the state put together from the parts that hold it."""

    def __init__(
            self, outlet: Outlet, simulation: Simulation, run_loop: RunLoop,
            switch: ModeSwitch, recording: RecordingSession, frame_id: str) -> None:
        """Keep the parts."""
        self._switch = switch
        self._outlet = outlet
        self._simulation = simulation
        self._run_loop = run_loop
        self._recording = recording
        self._frame_id = frame_id

    def send(self) -> None:
        """Send the state as it is now."""
        state = state_of(
            self._simulation, frame_id=self._frame_id, run_state=self._run_loop.run_state,
            preparing=self._switch.preparing, compiled=self._switch.compiled,
            recording_path=self._recording.path)
        self._outlet.send_message('state', state, self._simulation.stepping.edit_time)
