# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""The ROS node: puts the parts together, and holds no physics."""

from collections.abc import Callable
from collections.abc import Sequence
from pathlib import Path
import time
from typing import Any
import warnings

from cloth_sim_interfaces.msg import Command
from cloth_sim_ros.messages.geometry import serialise_topology
from cloth_sim_ros.messages.state import diagnostics_message
from cloth_sim_ros.node.frames import Frames
from cloth_sim_ros.node.graph_checks import ClockTopic
from cloth_sim_ros.node.graph_checks import Namesake
from cloth_sim_ros.node.guarded_node import GuardedNode
from cloth_sim_ros.node.input_frames import InputFrames
from cloth_sim_ros.node.input_frames import OwnFrames
from cloth_sim_ros.node.load_requests import PushRequests
from cloth_sim_ros.node.load_requests import WindTopic
from cloth_sim_ros.node.mode_switch import ModeService
from cloth_sim_ros.node.mode_switch import ModeSwitch
from cloth_sim_ros.node.outlet import Inputs
from cloth_sim_ros.node.outlet import Outlet
from cloth_sim_ros.node.parameters import declare_fields
from cloth_sim_ros.node.parameters import LiveParameters
from cloth_sim_ros.node.parameters import with_reasons
from cloth_sim_ros.node.recording_session import RecordingSession
from cloth_sim_ros.node.recording_session import write_opening
from cloth_sim_ros.node.refusals import IgnoredMessages
from cloth_sim_ros.node.run_loop import PaceReport
from cloth_sim_ros.node.run_loop import Pacing
from cloth_sim_ros.node.run_loop import RunLoop
from cloth_sim_ros.node.run_services import RecordingServices
from cloth_sim_ros.node.run_services import RunServices
from cloth_sim_ros.node.run_services import StateTopic
from cloth_sim_ros.node.shared_memory import cloud_bytes
from cloth_sim_ros.node.shared_memory import SharedMemory
from cloth_sim_ros.node.targets import GraspServices
from cloth_sim_ros.node.targets import LostGrasps
from cloth_sim_ros.node.targets import MoveServices
from cloth_sim_ros.node.targets import PinService
from cloth_sim_ros.node.targets import PinTargets
from cloth_sim_ros.node.targets import PoseStreams
from cloth_sim_ros.recording.bag_folder import fresh_name
from cloth_sim_ros.recording.bag_folder import RecordingOptions
from cloth_sim_ros.recording.recording_faults import RecordingError
from cloth_sim_ros.recording.recording_faults import RecordingFull
from cloth_sim_ros.sim.colliders import fields_with_colliders
from cloth_sim_ros.sim.scene import Scene
from cloth_sim_ros.sim.simulation import Simulation
from rclpy.clock import Clock
from rclpy.clock import ClockType
from rclpy.parameter import Parameter
from rclpy.service import Service

_WATCH_PERIOD = 1.0


class ClothSimNode(GuardedNode):
    """
    A cloth that ROS can watch and push. ~ stands for the node's name.

    Publishes: ~/points (PointCloud2), ~/markers (MarkerArray), ~/topology (Mesh), ~/stats
    (ClothStats), ~/pins/wrenches, ~/grasps/wrenches and ~/colliders/wrenches (WrenchStamped), /tf
    (TFMessage, a frame for each pin, grasp and collider), ~/state (ClothState), /diagnostics
    (DiagnosticArray), /clock (Clock, when publish.clock is true), and what was done to the cloth:
    ~/inputs/push (Push), ~/inputs/pin (PinChange), ~/inputs/pin_target (PinTarget),
    ~/inputs/grasp (GraspChange), ~/inputs/grasp_target and ~/inputs/collider_target
    (FrameTarget), ~/inputs/wind (Vector3Stamped), ~/inputs/mode (ModeChange), ~/inputs/command
    (Command), ~/inputs/parameters (ParameterEvent).

    Listens to: ~/push (Push), ~/pins/target (PinTarget), ~/grasps/NAME/target and
    ~/colliders/NAME/pose (PoseStamped), ~/wind (Vector3Stamped), /clicked_point (PointStamped),
    /tf and /tf_static (TFMessage).

    Serves: ~/set_mode (SetMode), ~/apply_push (ApplyPush), ~/clear_pushes (Trigger), ~/set_pin
    (SetPin), ~/move_pin (MovePin), ~/grasp (Grasp), ~/release (Release), ~/move_grasp and
    ~/move_collider (MoveFrame), ~/reset (Trigger), ~/pause (SetBool), ~/step (Step),
    ~/start_recording (StartRecording), ~/stop_recording (Trigger).

    Parameters: those of sim/scene_fields.py and node/node_fields.py.

    :param memory: what Fast DDS has to send clouds with
    :param overlaps: whether a late node begins the next frame before it waits for the data of the
        last one; by default where the device computes meanwhile
    :raises ClothSimError: when the parameters ask for what can't be
    :raises DeviceError: when there is no GL device for it
    """

    def __init__(self, memory: SharedMemory, *, overlaps: bool | None = None) -> None:
        """Declare the parameters and make the parts; nothing moves yet."""
        super().__init__('cloth_sim')
        self._memory = memory
        values = declare_fields(self, self._parameter_overrides)
        name = self.get_fully_qualified_name()
        self._values = values
        scene = Scene({field.name: values[field.name] for field in fields_with_colliders(values)})
        with warnings.catch_warnings(record=True) as told:
            warnings.simplefilter('default')
            self._simulation = Simulation(scene, compiles=False)
        for warning in told:
            self.get_logger().warning(str(warning.message))
        self._recording = RecordingSession(
            values['recording.directory'], name, self._on_recording_lost,
            options=RecordingOptions.from_values(values), wake=self._on_recording_ended)
        # The thread that writes triggers it; the check runs where all else does.
        self._recording_ended = self.create_guard_condition(self._recording.check)
        self._ignored = IgnoredMessages(self.get_logger().warning)
        own = OwnFrames(self._simulation, name, values['frame_id'])
        self._input_frames = InputFrames(
            self, own, values['frame_id'], self._ignored, listens=values['tf.listen'])
        self._outlet = Outlet(
            self, self._recording, heard_here=('tf',) if values['tf.listen'] else ())
        self._inputs = Inputs(self._outlet, self._simulation, values['frame_id'], name)
        self._frames = Frames(
            self._simulation, self._outlet, values, name, own, self.get_logger().warning)
        self._pacing = Pacing(values['real_time_factor'])
        self._pace_report = PaceReport(
            self._simulation, self._pacing, warn=self.get_logger().warning,
            say=self.get_logger().info)
        self._run_loop = RunLoop(
            self.alarm, self._simulation, frame_seconds=1.0 / values['publish.rate'],
            pacing=self._pacing, paused=values['start_paused'],
            on_frame=self.guarded(self._on_frame, 'a frame'), on_stop=self._on_stop,
            note=self.faults.note,
            overlaps=self._simulation.layout.is_asynchronous if overlaps is None else overlaps)
        self._switch = ModeSwitch(
            self, self._simulation, switched=self._on_switched, failed=self._on_mode_failed,
            changed=self._send_state)
        self._state = StateTopic(
            self._outlet, self._simulation, self._run_loop, self._switch, self._recording,
            values['frame_id'])
        self._namesake = Namesake(self, '~/set_mode', self.get_logger().warning)
        self._clock_topic = ClockTopic(self, self._outlet, values['publish.clock'])
        LiveParameters(
            self, values, ask_mode=self._switch.ask, changed=self._on_parameters_changed)
        self._serve()
        self.create_timer(
            _WATCH_PERIOD, self._watch, clock=Clock(clock_type=ClockType.STEADY_TIME))

    def create_service(
            self, srv_type: type, srv_name: str, callback: Callable[[Any, Any], Any],
            **options: Any) -> Service:
        """Serve ``callback``; what is refused gets a reason in the words of this project."""
        return super().create_service(
            srv_type, srv_name, with_reasons(self, srv_type, callback), **options)

    def begin(self) -> None:
        """Say what runs where, record when the parameters say so, and run."""
        simulation = self._simulation
        scene = simulation.scene
        self._outlet.send('topology', lambda: serialise_topology(scene), simulation.time)
        if self._values['recording.enabled']:
            self._start_first_recording()
        else:
            self._state.send()
        sent = cloud_bytes(scene.node_count) if self._values['publish.points'] else 0
        if warning := self._memory.warning(sent):
            self.get_logger().warning(warning)
        self._switch.ask(simulation.mode)

    def close_recording(self) -> None:
        """Close the recording, if there is one; works without ROS."""
        self._recording.close()

    def destroy_node(self) -> None:
        """Give the device's memory back, and everything of ROS."""
        self._run_loop.close()
        self._switch.close()
        self._simulation.close()
        super().destroy_node()

    def _serve(self) -> None:
        ModeService(self, self._simulation, self._switch)
        frames = self._input_frames
        PushRequests(
            self, self._simulation, self._inputs, self._values, frames, self._ignored)
        PinService(self, self._simulation, self._inputs, frames)
        for topic in (PinTargets, WindTopic):
            topic(self, self._simulation, self._inputs, frames, self._ignored)
        self._streams = PoseStreams(
            self, self._simulation, self._inputs, frames, self._ignored)
        MoveServices(self, self._simulation, self._inputs, frames)
        GraspServices(
            self, self._simulation, self._inputs, frames, self._streams.follow_grasps)
        self._simulation.listener = LostGrasps(
            self._inputs, self.get_logger().warning, self._streams.follow_grasps)
        RunServices(
            self, self._simulation, self._run_loop, reset=self._reset, changed=self._state.send)
        RecordingServices(
            self, self._simulation, self._recording, start=self._start_recording,
            changed=self._state.send)

    def _start_first_recording(self) -> None:
        directory, name = self._values['recording.directory'], self._values['recording.name']
        fresh = fresh_name(directory, name) if name else ''
        path = self._start_recording(fresh)
        # As with a launch that starts a node again after it was killed.
        if fresh != name:
            self.get_logger().warning(
                f'{Path(path).with_name(name)} already exists, and no recording is overwritten: '
                f'recording to {path} instead')

    def _start_recording(self, name: str) -> str:
        path = self._recording.start(name)
        write_opening(
            self._recording, self._simulation, self._values, self.get_fully_qualified_name())
        self._state.send()
        self._show()
        self.get_logger().info(f'recording to {path}')
        return path

    def _on_recording_ended(self) -> None:
        # On the thread that writes; a node that is being shut down closes the recording itself.
        if self.context.ok():
            self._recording_ended.trigger()

    def _on_recording_lost(self, error: RecordingError) -> None:
        if isinstance(error, RecordingFull):
            self.get_logger().warning(str(error))
        else:
            self.get_logger().error(str(error))
        self._state.send()
        self._send_diagnostics()

    def _on_frame(
            self, worked: float, steps: int, later: bool = False) -> Callable[[], None] | None:
        self._input_frames.take_waiting()
        too_slow = self._run_loop.running and self._pacing.too_slow
        send = self._frames.send(
            worked=worked, steps=steps, real_time_factor=self._run_loop.real_time_factor,
            too_slow=too_slow, later=later)
        if self._run_loop.running:
            self._pace_report.look(time.monotonic())
        return self.guarded(send, 'a frame') if send is not None else None

    def _show(self) -> None:
        """Send the present moment as a frame, as soon as there is a mode to look at it with."""
        if self._simulation.is_ready:
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
        self._input_frames.forget()
        self._streams.follow_grasps()
        self._run_loop.restart()
        self._state.send()
        self._show()

    def _send_state(self) -> None:
        self._state.send()

    def _on_switched(self, mode: str, previous: str) -> None:
        if not previous:
            simulation = self._simulation
            scene = simulation.scene
            self.get_logger().info(
                f'{scene.rows} x {scene.cols} nodes in mode {mode} on {simulation.device}: '
                f'dt {simulation.dt:g} s in {simulation.substeps} substeps, '
                f'{self._run_loop.run_state}')
            self._show()
            self._run_loop.start()
        elif mode != previous:
            self._inputs.mode(mode, previous)
        self._state.send()

    def _on_mode_failed(self, mode: str, error: Exception) -> None:
        if not self._simulation.is_ready:
            self.fatal = error
            return
        self.get_logger().error(f'mode {mode} cannot be prepared: {error}')
        self.set_parameters(
            [Parameter('mode', Parameter.Type.STRING, self._simulation.mode)])
        self._state.send()

    def _on_parameters_changed(self, parameters: Sequence[Parameter]) -> None:
        self._inputs.parameters(parameters)
        if self._values['real_time_factor'] != self._pacing.factor:
            self._pacing.factor = self._values['real_time_factor']
            self._run_loop.start()

    def _watch(self) -> None:
        """Once a second: the health of the run, and a still picture for those who come late."""
        self._input_frames.take_waiting()
        self._clock_topic.watch()
        self._namesake.watch()
        self._recording.check()
        simulation = self._simulation
        is_still = not self._run_loop.running and not simulation.stepping.is_mid_step
        if simulation.is_ready and is_still:
            self._frames.send(to_recording=False)
        self._send_diagnostics()

    def _send_diagnostics(self) -> None:
        simulation = self._simulation
        if not self._outlet.wanted('diagnostics'):
            return
        snapshot = simulation.snapshot() if simulation.is_ready else None
        ending = self._recording.ending
        self._outlet.send_message('diagnostics', diagnostics_message(
            snapshot, stamp=self.get_clock().now().to_msg(), node_name=self.get_name(),
            device=simulation.device,
            paused=not self._run_loop.running, problem=self._run_loop.problem,
            real_time_factor=self._run_loop.real_time_factor,
            wanted_factor=self._values['real_time_factor'],
            automatic_substeps=self._values['auto_substeps'],
            recording_path=self._recording.path, recording_error=str(ending or ''),
            recording_is_whole=isinstance(ending, RecordingFull),
            faults=self.faults.count, latest_fault=self.faults.latest,
            ignored=self._ignored.count),
            simulation.time)
