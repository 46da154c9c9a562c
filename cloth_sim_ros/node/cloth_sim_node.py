# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""The ROS node: puts the parts together, and holds no physics."""

from collections.abc import Callable
from collections.abc import Sequence
from contextlib import suppress
from pathlib import Path
from typing import Any
import warnings

from cloth_sim_ros.messages.frame_messages import Pace
from cloth_sim_ros.messages.geometry import serialise_topology
from cloth_sim_ros.messages.stamp import stamp
from cloth_sim_ros.messages.state import diagnostics_message
from cloth_sim_ros.node.action_servers import MoveActions
from cloth_sim_ros.node.action_servers import StepAction
from cloth_sim_ros.node.camera_places import CameraPlaces
from cloth_sim_ros.node.device_thread import DeviceThread
from cloth_sim_ros.node.followed_time import FollowedTime
from cloth_sim_ros.node.followers import Followers
from cloth_sim_ros.node.followers import frames_of_scene
from cloth_sim_ros.node.graph_checks import ClockSource
from cloth_sim_ros.node.graph_checks import ClockTopic
from cloth_sim_ros.node.graph_checks import Namesake
from cloth_sim_ros.node.guarded_node import GuardedNode
from cloth_sim_ros.node.input_frames import InputFrames
from cloth_sim_ros.node.input_frames import OwnFrames
from cloth_sim_ros.node.load_requests import LoadRequests
from cloth_sim_ros.node.mode_switch import ModeService
from cloth_sim_ros.node.mode_switch import ModeSwitch
from cloth_sim_ros.node.motions import Motions
from cloth_sim_ros.node.node_time import NodeTime
from cloth_sim_ros.node.node_time import WallTime
from cloth_sim_ros.node.outlet import Outlet
from cloth_sim_ros.node.parameters import declare_fields
from cloth_sim_ros.node.parameters import LiveParameters
from cloth_sim_ros.node.parameters import with_reasons
from cloth_sim_ros.node.recording_session import RecordingSession
from cloth_sim_ros.node.recording_session import write_opening
from cloth_sim_ros.node.refusals import IgnoredMessages
from cloth_sim_ros.node.reports import Reports
from cloth_sim_ros.node.run_loop import PaceReport
from cloth_sim_ros.node.run_loop import Pacing
from cloth_sim_ros.node.run_loop import RunLoop
from cloth_sim_ros.node.run_services import RecordingServices
from cloth_sim_ros.node.run_services import RunServices
from cloth_sim_ros.node.shared_memory import cloud_bytes
from cloth_sim_ros.node.shared_memory import picture_cloud_bytes
from cloth_sim_ros.node.shared_memory import SharedMemory
from cloth_sim_ros.node.targets import GraspRequests
from cloth_sim_ros.node.targets import MoveRequests
from cloth_sim_ros.node.targets import PinRequests
from cloth_sim_ros.recording.bag_folder import fresh_name
from cloth_sim_ros.recording.bag_folder import RecordingOptions
from cloth_sim_ros.recording.recording_faults import RecordingError
from cloth_sim_ros.recording.recording_faults import RecordingFull
from cloth_sim_ros.recording.writer_choice import library_report
from cloth_sim_ros.sim.errors import ClothSimError
from cloth_sim_ros.sim.errors import WrongStateError
from cloth_sim_ros.sim.model.named_fields import all_fields
from cloth_sim_ros.sim.scene import Scene
from cloth_sim_ros.sim.simulation import Simulation
from cloth_sim_ros.sim.snapshot import Snapshot
from rclpy._rclpy_pybind11 import InvalidHandle
from rclpy._rclpy_pybind11 import RCLError
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
    (TFMessage, a frame for each pin, grasp, collider and camera), ~/cameras/NAME/image, depth and
    labels (Image), camera_info (CameraInfo) and points (PointCloud2), ~/state (ClothState),
    /diagnostics (DiagnosticArray), /clock (Clock, when publish.clock is true), and what was done
    to the cloth:
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

    Parameters: those of sim/model/scene_fields.py and node/node_fields.py.

    :param memory: what Fast DDS has to send clouds with

    The simulation runs on a thread of its own, see device_thread.py.

    :raises ClothSimError: when the parameters ask for what can't be
    :raises DeviceError: when there is no GL device for it
    """

    def __init__(self, memory: SharedMemory) -> None:
        """Declare the parameters and make the parts; nothing moves yet."""
        super().__init__('cloth_sim')
        self._memory = memory
        values = declare_fields(self, self._parameter_overrides)
        name = self.get_fully_qualified_name()
        self._values = values
        scene = Scene({field.name: values[field.name] for field in all_fields(values)})
        warn = self.get_logger().warning
        self._recording = RecordingSession(
            values['recording.directory'], name,
            lambda error: self._device.emit(lambda: self._on_recording_lost(error)),
            options=RecordingOptions.from_values(values), wake=self._on_recording_ended)
        said = library_report(self._recording.library)
        # A node with recording.enabled refuses to start without a recording, and reports why.
        if said and (self._recording.library or not values['recording.enabled']):
            self.get_logger().info(said)
        # The thread that writes triggers it; the check runs on the ROS thread.
        self._recording_ended = self.create_guard_condition(self._recording.check)
        self._simulated_steps: Callable[[], bool] = lambda: False
        self._is_asked_for_health = False
        self._ignored = IgnoredMessages(warn)
        self._outlet = Outlet(
            self, self._recording, heard_here=('tf',) if values['tf.listen'] else (),
            cameras=values['cameras.names'])
        if values['time.source'] == 'ros':
            self._use_clock()
        # With /clock, each frame is made as soon as that has come so far.
        self._pacing = Pacing(
            0.0 if values['time.source'] == 'ros' else values['real_time_factor'])
        self._device = DeviceThread(self._wake, self._note_fault)
        self._has_events = self.create_guard_condition(self._device.serve)
        try:
            with warnings.catch_warnings(record=True) as told:
                warnings.simplefilter('default')
                self._simulation: Simulation = self._device.start(
                    lambda: self._make_simulation(scene), self._close_simulation)
            for warning in told:
                warn(str(warning.message))
            self._switch = ModeSwitch(
                self, self._device, self._simulation, switched=self._on_switched,
                failed=self._on_mode_failed, changed=self._report_state)
            self._namesake = Namesake(self, '~/set_mode', warn)
            self._clock_topic = ClockTopic(self, self._outlet, values['publish.clock'])
            self._clock_source = ClockSource(
                self, self._outlet, is_followed=self._time.is_followed,
                is_known=lambda: self._time.is_known, warn=warn)
            LiveParameters(
                self, values, ask_mode=self._switch.ask, changed=self._on_parameters_changed)
            self._serve()
        except BaseException:
            self._device.close()
            raise
        self.create_timer(
            _WATCH_PERIOD, self._watch, clock=Clock(clock_type=ClockType.STEADY_TIME))

    def _make_simulation(self, scene: Scene) -> Simulation:
        """Make what lives on the device thread, there."""
        values, name = self._values, self.get_fully_qualified_name()
        simulation = Simulation(scene, compiles=False)
        self._time = self._make_time(simulation)
        own = OwnFrames(simulation, name, values['frame_id'], self._time.base)
        self._input_frames = InputFrames(
            self, own, values['frame_id'], self._ignored, listens=values['tf.listen'])
        log = self.get_logger()
        self._followers = Followers(
            simulation, self._input_frames, self._time.base,
            frames_of_scene(values['tf.follow'], simulation),
            lambda: (values['tf.follow_speed'], values['tf.follow_angular_speed']),
            lambda text: self._device.emit(lambda: log.warning(text)))
        self._camera_places = CameraPlaces(
            simulation, self._input_frames, self._time.base,
            lambda text: self._device.emit(lambda: log.warning(text)))
        self._reports = simulation.listener = Reports(
            self._device, simulation, self._outlet, self._recording, values, name,
            self._input_frames, self._time, place=self._camera_places.find,
            warn=log.warning, follow=lambda names: self._moves.follow(names))
        pace_report = PaceReport(
            simulation, self._pacing,
            warn=lambda text: self._device.emit(lambda: log.warning(text)),
            say=lambda text: self._device.emit(lambda: log.info(text)))
        self._run_loop = RunLoop(
            simulation, frame_seconds=1.0 / values['publish.rate'], pacing=self._pacing,
            report=pace_report, paused=values['start_paused'], on_frame=self._on_frame,
            on_stop=self._on_stop, note=self._device.note, is_due=self._device.has_jobs,
            stop=self._device.is_closing, is_held_back=self._reports.is_held_back,
            before_part=self._before_part, node_time=self._time)
        self._motions = Motions(simulation, lambda: self._run_loop.problem)
        self._device.set_turns(self._run_loop)
        return simulation

    def _make_time(self, simulation: Simulation) -> NodeTime:
        """Make the source of the time."""
        def changed(before: int) -> None:
            self._reports.time_base(before)

        if self._values['time.source'] == 'ros':
            return FollowedTime(
                self, simulation, self._device.post, begun=self._on_clock,
                went_back=self._on_clock_back,
                leapt=lambda text: self._device.emit(lambda: self.get_logger().warning(text)),
                changed=changed)
        if self._values['time.epoch'] == 'wall':
            return WallTime(simulation, changed)
        return NodeTime(simulation, changed)

    def _use_clock(self) -> None:
        """Have the clock of the node be /clock: what ROS itself stamps has that time as well."""
        given = self._parameter_overrides.get('use_sim_time')
        if given is not None and given.value is False:
            raise ClothSimError(
                'time.source: ros follows /clock and use_sim_time is false: leave use_sim_time '
                'out, or set time.source: own')
        self.set_parameters([Parameter('use_sim_time', Parameter.Type.BOOL, True)])

    def _close_simulation(self) -> None:
        self._reports.close()
        self._simulation.close()

    def _wake(self) -> None:
        """Have the ROS thread serve an event; called on any thread."""
        # While ROS is being shut down it fails: the events are served at the end.
        with suppress(InvalidHandle, RCLError):
            self._has_events.trigger()

    def _note_fault(self, error: Exception, where: str) -> None:
        # Calls in progress when ROS is shut down fail; that is no error.
        if not self.context.ok():
            raise error
        self.faults.note(error, where)

    def create_service(
            self, srv_type: type, srv_name: str, callback: Callable[[Any, Any], Any],
            **options: Any) -> Service:
        """Serve ``callback``; what is refused gets a reason in the words of this project."""
        return super().create_service(
            srv_type, srv_name, with_reasons(self, srv_type, callback), **options)

    def begin(self) -> None:
        """Say what runs where, record when the parameters say so, and run."""
        scene, now, base = self._simulation.scene, self._simulation.time, self._time.base
        self._outlet.send(
            'topology', lambda: serialise_topology(scene), now, epoch=base.epoch)
        self._device.post(lambda: self._reports.time_base(base.at(now)))
        # Before /clock has come, a recording would have no time.
        if self._values['recording.enabled'] and self._time.is_known:
            self._start_first_recording()
        else:
            self._report_state()
        sent = [picture_cloud_bytes(camera.width, camera.height) for camera in scene.cameras]
        if self._values['publish.points']:
            sent.append(cloud_bytes(scene.node_count))
        if warning := self._memory.warning(max(sent, default=0)):
            self.get_logger().warning(warning)
        self._switch.ask(self._simulation.mode)

    def close_recording(self) -> None:
        """Close the recording, if there is one; works without ROS."""
        self._device.stop()
        self._device.serve_rest()
        self._recording.close()

    def destroy_node(self) -> None:
        """Release the device's memory, and everything of ROS."""
        self._switch.close()
        self._device.close()
        super().destroy_node()

    def _serve(self) -> None:
        ModeService(self, self._simulation, self._switch)
        parts = self, self._device, self._simulation
        frames, ignored = self._input_frames, self._ignored
        LoadRequests(*parts, self._values, frames, ignored)
        PinRequests(*parts, frames, ignored)
        GraspRequests(*parts, frames, self._followers)
        self._moves = MoveRequests(*parts, frames, ignored, self._followers)
        MoveActions(*parts, frames, self._followers, self._motions)
        self._steps = StepAction(*parts, self._run_loop, self._report_state_now)
        if self._values['simulation_interfaces']:
            self._serve_simulation_interfaces()
        RunServices(
            *parts, self._run_loop, reset=self._reset, changed=self._report_state_now)
        RecordingServices(
            self, self._device, self._recording, start=self._start_recording,
            started=self._on_recording_started, stopped=self._report_state)

    def _serve_simulation_interfaces(self) -> None:
        try:
            # A ROS without that package runs a node without these services.
            from cloth_sim_ros.node.simulation_services import SimulateStepsAction
            from cloth_sim_ros.node.simulation_services import SimulationServices
        except ImportError as error:
            raise ClothSimError(
                'simulation_interfaces: true needs the package simulation_interfaces, which is '
                'not here: install ros-jazzy-simulation-interfaces, or leave it out') from error
        parts = self, self._device, self._simulation, self._run_loop
        SimulationServices(
            *parts, base=self._time.base, frame_id=self._values['frame_id'],
            is_stopped=self._values['start_paused'], reset=self._reset,
            changed=self._report_state_now)
        self._simulated_steps = SimulateStepsAction(*parts, self._report_state_now).look

    # Called on the ROS thread.

    def _start_first_recording(self) -> None:
        directory, name = self._values['recording.directory'], self._values['recording.name']
        fresh = fresh_name(directory, name) if name else ''
        path = self._on_recording_started(self._device.wait_for(
            lambda: self._start_recording(fresh)))
        # As with a launch that starts a node again after it was killed.
        if fresh != name:
            self.get_logger().warning(
                f'{Path(path).with_name(name)} already exists, and no recording is overwritten: '
                f'recording to {path} instead')

    def _on_recording_started(self, path: str) -> str:
        self.get_logger().info(f'recording to {path}')
        return path

    def _on_recording_ended(self) -> None:
        # On the thread that writes; a node that is being shut down closes the recording itself.
        with suppress(InvalidHandle, RCLError):
            self._recording_ended.trigger()

    def _on_recording_lost(self, error: RecordingError) -> None:
        if isinstance(error, RecordingFull):
            self.get_logger().warning(str(error))
        else:
            self.get_logger().error(str(error))
        self._report_state()
        self._send_diagnostics()

    def _report_state(self) -> None:
        self._device.post(self._report_state_now)

    def _on_mode_failed(self, mode: str, error: Exception) -> None:
        if not self._simulation.is_ready:
            self.fatal = error
            return
        self.get_logger().error(f'mode {mode} cannot be prepared: {error}')
        self.set_parameters(
            [Parameter('mode', Parameter.Type.STRING, self._simulation.mode)])
        self._report_state()

    def _on_parameters_changed(self, parameters: Sequence[Parameter]) -> None:
        factor = self._values['real_time_factor']

        def change() -> None:
            self._reports.parameters(parameters)
            if factor != self._pacing.factor and not self._time.is_followed:
                self._pacing.factor = factor
                self._run_loop.start()

        self._device.post(change)

    def _watch(self) -> None:
        """Once a second: the health of the run, and a still picture for those who come late."""
        self._input_frames.take_waiting()
        self._clock_topic.watch()
        self._clock_source.watch()
        self._namesake.watch()
        self._recording.check()

        def show() -> None:
            is_still = self._time.is_still()
            if not self._run_loop.running:
                self._time.catch_up()
            if self._simulation.is_ready and (is_still or not self._run_loop.running):
                self._reports.frame(Pace, to_recording=False)

        self._device.post(show)
        self._send_diagnostics()

    def _send_diagnostics(self) -> None:
        # Within a step that takes long, one request is enough.
        if not self._is_asked_for_health and self._outlet.wanted('diagnostics'):
            self._is_asked_for_health = True
            self._device.post(self._report_diagnostics)

    # Called on the device thread.

    def _start_recording(self, name: str) -> str:
        if not self._time.is_known:
            raise WrongStateError(
                'no message has come on /clock, so that a recording would have no time: start '
                'what publishes it first, or set time.source: own')
        if not self._run_loop.running:
            self._time.catch_up()
        path = self._recording.start(name, lambda: write_opening(
            self._recording, self._simulation, self._values, self.get_fully_qualified_name(),
            self._time.base))
        self._report_state_now()
        self._show()
        return path

    def _show(self) -> None:
        """Report the present moment as a frame, if there is a mode to look at it with."""
        if not self._simulation.is_ready:
            return
        try:
            self._reports.frame(Pace)
        except Exception as error:
            # The request that changed the moment is carried out all the same.
            self._device.note(error, 'a frame')

    def _before_part(self, seconds: float) -> bool:
        is_waited_for = self._motions.look()
        # Each of them has to be asked.
        is_stepped = self._steps.look() or self._simulated_steps()
        return self._followers.move(seconds) or is_waited_for or is_stepped

    def _on_clock(self) -> None:
        self._device.emit(lambda: self.get_logger().info('following /clock'))
        self._report_state_now()
        if self._values['recording.enabled']:
            self._device.emit(self._start_first_recording)

    def _on_clock_back(self, text: str) -> None:
        # Two publishers of /clock make it go back again and again.
        is_one = self.count_publishers('/clock') < 2
        if is_one and self._values['time.jump_back'] == 'reset':
            self._device.emit(lambda: self.get_logger().warning(
                f'{text}: the cloth is reset, and begins there'))
            self._reset()
            return
        reason = 'time.jump_back is refuse' if is_one else 'it has several publishers'
        self._run_loop.stop(ClothSimError(
            f'{text}, behind the cloth, and {reason}: call ~/reset to begin there, or resume to '
            'wait until it has come so far again'))

    def _on_frame(self, pace: Callable[[], Pace]) -> None:
        self._reports.frame(pace)
        self._motions.look()

    def _on_stop(self) -> None:
        self._motions.look()
        problem = self._run_loop.problem
        self._device.emit(lambda: self.get_logger().error(
            problem if '~/reset' in problem else
            f'{problem}; then resume to try again, or call ~/reset'))
        self._report_state_now()
        self._device.emit(self._watch)

    def _reset(self) -> None:
        self._simulation.reset()
        self._followers.forget_grasps()
        self._motions.look()
        self._run_loop.restart()
        self._report_state_now()
        self._show()

    def _on_switched(self, mode: str, previous: str) -> None:
        if not previous:
            simulation = self._simulation
            scene = simulation.scene
            text = (
                f'{scene.rows} x {scene.cols} nodes in mode {mode} on {simulation.device}: '
                f'dt {simulation.dt:g} s in {simulation.substeps} substeps, '
                f'{self._run_loop.run_state}')
            self._device.emit(lambda: self.get_logger().info(text))
            self._show()
            self._run_loop.start()
        self._report_state_now()

    def _report_state_now(self) -> None:
        self._reports.state(self._run_loop, self._switch)

    def _report_diagnostics(self) -> None:
        self._is_asked_for_health = False
        simulation, loop = self._simulation, self._run_loop
        snapshot = simulation.snapshot() if simulation.is_ready else None
        now, number, base = simulation.time, self._recording.number, self._time.base
        known = {
            'paused': not loop.running, 'problem': loop.problem,
            'real_time_factor': loop.real_time_factor, 'stamp': stamp(now, base.epoch),
            'source': base.source, 'behind': self._time.behind,
            'followers': [
                (each.name, each.frame, each.is_late, each.behind)
                for each in self._followers.present],
            'waiting': [*self._followers.waiting, *self._camera_places.waiting]}
        epoch = base.epoch
        self._device.emit(lambda: self._send_health(snapshot, now, number, epoch, known))

    # Called on the ROS thread.

    def _send_health(
            self, snapshot: Snapshot | None, now: float, number: int, epoch: int,
            known: dict[str, Any]) -> None:
        ending = self._recording.ending
        self._outlet.send_message('diagnostics', diagnostics_message(
            snapshot, node_name=self.get_name(),
            device=self._simulation.device, **known,
            wanted_factor=self._pacing.factor, time_problem=self._clock_source.problem,
            automatic_substeps=self._values['auto_substeps'],
            recording_path=self._recording.path, recording_error=str(ending or ''),
            recording_is_whole=isinstance(ending, RecordingFull),
            faults=self.faults.count, latest_fault=self.faults.latest,
            ignored=self._ignored.count), now, number=number, epoch=epoch)
