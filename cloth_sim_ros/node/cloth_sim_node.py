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

"""The ROS node: puts the parts together, and holds no physics."""

from cloth_sim_interfaces.msg import Command
from cloth_sim_ros.messages.diagnostics import diagnostics_message
from cloth_sim_ros.messages.topology import serialise_topology
from cloth_sim_ros.node.clock_topic import ClockTopic
from cloth_sim_ros.node.frames import Frames
from cloth_sim_ros.node.inputs import Inputs
from cloth_sim_ros.node.large_messages import lost_clouds
from cloth_sim_ros.node.large_messages import use_profile
from cloth_sim_ros.node.live_parameters import LiveParameters
from cloth_sim_ros.node.mode_service import ModeService
from cloth_sim_ros.node.opening import write_opening
from cloth_sim_ros.node.outlet import Outlet
from cloth_sim_ros.node.pacing import Pacing
from cloth_sim_ros.node.parameters import declare_fields
from cloth_sim_ros.node.pin_service import PinService
from cloth_sim_ros.node.pin_targets import PinTargets
from cloth_sim_ros.node.push_requests import PushRequests
from cloth_sim_ros.node.recording_services import RecordingServices
from cloth_sim_ros.node.recording_session import RecordingSession
from cloth_sim_ros.node.run_loop import RunLoop
from cloth_sim_ros.node.run_services import RunServices
from cloth_sim_ros.node.state_topic import StateTopic
from cloth_sim_ros.sim.scene import Scene
from cloth_sim_ros.sim.scene_fields import SCENE_FIELDS
from cloth_sim_ros.sim.simulation import Simulation
from rclpy.clock import Clock
from rclpy.clock import ClockType
from rclpy.node import Node
from rclpy.parameter import Parameter

_WATCH_PERIOD = 1.0
_SLOW_WARNING_PERIOD = 10.0


class ClothSimNode(Node):
    """
    A cloth that ROS can watch and push. ~ stands for the node's name.

    Publishes: ~/points (PointCloud2), ~/markers (MarkerArray), ~/topology (Mesh), ~/stats
    (ClothStats), ~/pins/wrenches (WrenchStamped), /tf (TFMessage, a frame for each pin), ~/state
    (ClothState), /diagnostics (DiagnosticArray), /clock (Clock, when publish.clock is true), and
    what was done to the cloth: ~/inputs/push (Push), ~/inputs/pin (PinChange),
    ~/inputs/pin_target (PinTarget), ~/inputs/mode (ModeChange), ~/inputs/command (Command),
    ~/inputs/parameters (ParameterEvent).

    Listens to: ~/push (Push), ~/pins/target (PinTarget), /clicked_point (PointStamped).

    Serves: ~/set_mode (SetMode), ~/apply_push (ApplyPush), ~/clear_pushes (Trigger), ~/set_pin
    (SetPin), ~/move_pin (MovePin), ~/reset (Trigger), ~/pause (SetBool), ~/step (Step),
    ~/start_recording (StartRecording), ~/stop_recording (Trigger).

    Parameters: those of sim/scene_fields.py and node/node_fields.py.

    :raises ClothSimError: when the parameters ask for what can't be
    :raises DeviceError: when there is no GL device for it
    """

    def __init__(self) -> None:
        """Declare the parameters and make the parts; nothing moves yet."""
        super().__init__('cloth_sim')
        values = declare_fields(self, self._parameter_overrides)
        name = self.get_fully_qualified_name()
        self._values = values
        self._simulation = Simulation(
            Scene({field.name: values[field.name] for field in SCENE_FIELDS}))
        self._recording = RecordingSession(
            values['recording.directory'], name, self._on_recording_lost)
        self._recording_error = ''
        self._outlet = Outlet(self, self._recording)
        self._inputs = Inputs(self._outlet, self._simulation, values['frame_id'], name)
        self._frames = Frames(
            self._simulation, self._outlet, values, name, self.get_logger().warning)
        self._pacing = Pacing(values['real_time_factor'])
        self._run_loop = RunLoop(
            self, self._simulation, frame_seconds=1.0 / values['publish.rate'],
            pacing=self._pacing, paused=values['start_paused'], on_frame=self._on_frame,
            on_stop=self._on_stop)
        self._state = StateTopic(
            self._outlet, self._simulation, self._run_loop, self._recording, values['frame_id'])
        self._clock_topic = ClockTopic(self, self._outlet, values['publish.clock'])
        LiveParameters(
            self, values, set_mode=self._set_mode, changed=self._on_parameters_changed)
        self._serve()
        self.create_timer(
            _WATCH_PERIOD, self._watch, clock=Clock(clock_type=ClockType.STEADY_TIME))

    def begin(self) -> None:
        """Say what runs where, record when the parameters say so, and run."""
        simulation = self._simulation
        scene = simulation.scene
        self._outlet.send('topology', lambda: serialise_topology(scene), simulation.time)
        if self._values['recording.enabled']:
            self._start_recording(self._values['recording.name'])
        else:
            self._state.send()
            self._show()
        self.get_logger().info(
            f'{scene.rows} x {scene.cols} nodes in mode {simulation.mode} on '
            f'{simulation.device}: dt {simulation.dt:g} s in {simulation.substeps} substeps, '
            f'{self._run_loop.run_state}')
        lost = lost_clouds(scene.node_count, use_profile())
        if lost and self._values['publish.points']:
            self.get_logger().warning(lost)
        self._run_loop.start()

    def close_recording(self) -> None:
        """Close the recording, if there is one; works without ROS."""
        self._recording.close()

    def destroy_node(self) -> None:
        """Give the device's memory back, and everything of ROS."""
        self._simulation.close()
        super().destroy_node()

    def _serve(self) -> None:
        ModeService(self, self._simulation)
        PushRequests(self, self._simulation, self._inputs, self._values)
        PinService(self, self._simulation, self._inputs)
        PinTargets(self, self._simulation, self._inputs, self._values['frame_id'])
        RunServices(
            self, self._simulation, self._run_loop, reset=self._reset, changed=self._state.send)
        RecordingServices(
            self, self._recording, start=self._start_recording, changed=self._state.send)

    def _start_recording(self, name: str) -> str:
        path = self._recording.start(name)
        self._recording_error = ''
        write_opening(
            self._recording, self._simulation, self._values, self.get_fully_qualified_name())
        self._state.send()
        self._show()
        self.get_logger().info(f'recording to {path}')
        return path

    def _on_recording_lost(self, reason: str) -> None:
        self._recording_error = reason
        self.get_logger().error(reason)
        self._state.send()

    def _on_frame(self, worked: float, steps: int) -> None:
        too_slow = self._run_loop.running and self._pacing.too_slow
        self._frames.send(
            worked=worked, steps=steps, real_time_factor=self._run_loop.real_time_factor,
            too_slow=too_slow)
        if too_slow:
            self.get_logger().warning(
                f'{self._pacing.achieved:.3g} x real time is below the {self._pacing.factor:g} '
                'asked for: take fewer nodes, a longer dt or a lower real_time_factor',
                throttle_duration_sec=_SLOW_WARNING_PERIOD)

    def _show(self) -> None:
        """Send the present moment as a frame."""
        self._on_frame(0.0, 0)

    def _on_stop(self) -> None:
        self.get_logger().error(
            f'{self._run_loop.problem}; then resume to try again, or call ~/reset')
        self._state.send()
        self._watch()

    def _reset(self) -> None:
        self._inputs.command(Command.RESET)
        self._recording.rewind(self._simulation.time)
        self._simulation.reset()
        self._run_loop.restart()
        self._state.send()
        self._show()

    def _set_mode(self, mode: str) -> None:
        previous = self._simulation.set_mode(mode)
        if mode != previous:
            self._inputs.mode(mode, previous)
            self._state.send()

    def _on_parameters_changed(self, parameters: list[Parameter]) -> None:
        self._inputs.parameters(parameters)
        if self._values['real_time_factor'] != self._pacing.factor:
            self._pacing.factor = self._values['real_time_factor']
            self._run_loop.start()

    def _watch(self) -> None:
        """Once a second: the health of the run, and a still picture for those who come late."""
        self._clock_topic.watch()
        if not self._run_loop.running:
            self._frames.send(to_recording=False)
        if not self._outlet.wanted('diagnostics'):
            return
        snapshot = self._simulation.snapshot()
        self._outlet.send_message('diagnostics', diagnostics_message(
            snapshot, stamp=self.get_clock().now().to_msg(), node_name=self.get_name(),
            device=self._simulation.device,
            paused=not self._run_loop.running, problem=self._run_loop.problem,
            real_time_factor=self._run_loop.real_time_factor,
            wanted_factor=self._values['real_time_factor'],
            recording_path=self._recording.path, recording_error=self._recording_error),
            snapshot.time)
