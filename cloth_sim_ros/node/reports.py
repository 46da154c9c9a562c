# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""Reports of the device thread: frames, accepted inputs, state and parameters, in order."""

from collections.abc import Callable
from collections.abc import Mapping
from collections.abc import Sequence
from dataclasses import replace
from typing import Any

from cloth_sim_ros.messages.frame_messages import FrameContent
from cloth_sim_ros.messages.frame_messages import FrameMessages
from cloth_sim_ros.messages.frame_messages import FrameTaker
from cloth_sim_ros.messages.frame_messages import Pace
from cloth_sim_ros.messages.inputs import input_message
from cloth_sim_ros.messages.inputs import parameters_message
from cloth_sim_ros.messages.inputs import serialise_parameter_event
from cloth_sim_ros.messages.pins import too_many_pins
from cloth_sim_ros.messages.state import state_of
from cloth_sim_ros.node.device_thread import DeviceThread
from cloth_sim_ros.node.input_frames import InputFrames
from cloth_sim_ros.node.mode_switch import ModeSwitch
from cloth_sim_ros.node.node_time import NodeTime
from cloth_sim_ros.node.outlet import Outlet
from cloth_sim_ros.node.parameters import FIELDS
from cloth_sim_ros.node.parameters import plain_value
from cloth_sim_ros.node.recording_session import RecordingSession
from cloth_sim_ros.node.run_loop import RunLoop
from cloth_sim_ros.sim.inputs import Input
from cloth_sim_ros.sim.inputs import InputListener
from cloth_sim_ros.sim.inputs import Release
from cloth_sim_ros.sim.inputs import Reset
from cloth_sim_ros.sim.inputs import TakeGrasp
from cloth_sim_ros.sim.model.cameras import CameraModel
from cloth_sim_ros.sim.model.pose import Pose
from cloth_sim_ros.sim.simulation import Simulation
import numpy as np
from rclpy.parameter import Parameter

# Frames that wait to be recorded, or published at a real_time_factor of 0, before the simulation
# is held back: one is being written while the next is made.
_MOST_WAITING = 2
_WITH_PINS = frozenset(('publish.tf', 'publish.wrenches'))


class Reports(InputListener):
    """
    Emits events that publish and record, each with the time at which it was emitted.

    Its methods are called on the device thread.

    :param values: the node's parameter values, read at each frame
    :param node_name: with its namespace
    :param frames: keeps the poses of pins, grasps and colliders of each frame
    :param node_time: has the base of all stamps
    :param place: returns where the tf frame of a camera is; None where that is not known
    :param warn: called on the ROS thread with what a user should know
    :param follow: called on the ROS thread with the names of the grasps when they have changed
    """

    def __init__(
            self, device: DeviceThread, simulation: Simulation, outlet: Outlet,
            recording: RecordingSession, values: Mapping[str, Any], node_name: str,
            frames: InputFrames, node_time: NodeTime, *,
            place: Callable[[CameraModel], Pose | None], warn: Callable[[str], None],
            follow: Callable[[Sequence[str]], None]) -> None:
        """Prepare the messages of this cloth."""
        scene = simulation.scene
        self._device = device
        self._simulation = simulation
        self._outlet = outlet
        self._recording = recording
        self._values = values
        self._node_name = node_name
        self._frame_id = values['frame_id']
        self._frames = frames
        self._time = node_time
        self._base = node_time.base
        self._told_epoch: int | None = None
        self._warn = warn
        self._follow = follow
        self._taker = FrameTaker(simulation, values, place)
        self._messages = FrameMessages(scene, node_name, self._frame_id)
        self._reason = ''

    def close(self) -> None:
        """Release the device."""
        self._taker.close()

    def is_held_back(self) -> bool:
        """Return whether frames wait that must not be left out."""
        if not (self._recording.active or self._values['real_time_factor'] == 0.0):
            return False
        return self._device.waiting_frames >= _MOST_WAITING

    def frame(self, pace: Callable[[], Pace], *, to_recording: bool = True) -> None:
        """
        Report the present moment, as far as anybody reads it.

        :param pace: returns how fast it was made, when the device is done
        :param to_recording: False to show the same moment once more
        """
        if not to_recording and self._device.waiting_frames:
            return
        number = self._recording.number if to_recording else 0
        self._frames.take_waiting()
        self._check_pins()
        frame = self._taker.take(
            lambda key: self._outlet.wanted(key, by_recording=to_recording), pace,
            self._base.epoch, ends_frame=to_recording)
        if not frame.keys:
            return
        self._frames.note(frame)
        self._device.emit_frame(
            lambda is_published: self._send_frame(frame, number, is_published),
            is_recorded=number > 0, replaces=self._values['real_time_factor'] > 0.0)

    def state(self, run_loop: RunLoop, switch: ModeSwitch) -> None:
        """Report the state as it is now."""
        number, now, epoch = self._recording.number, self._simulation.time, self._base.epoch
        state = state_of(
            self._simulation, frame_id=self._frame_id, run_state=run_loop.run_state,
            preparing=switch.preparing, compiled=switch.compiled,
            recording_path=self._recording.path, epoch=epoch)
        self._device.emit(
            lambda: self._outlet.send_message(
                'state', state, now, number=number, epoch=epoch), '~/state')

    def accept(self, given: Input, time: float) -> None:
        """Report an accepted input, and what follows from it."""
        number, epoch = self._recording.number, self._base.epoch
        made = input_message(given, time, self._frame_id, epoch)
        if made is not None:
            key, message = made
            self._device.emit(
                lambda: self._outlet.send_message(
                    key, message, time, number=number, epoch=epoch), key)
        if isinstance(given, Release) and given.by_force:
            self._device.emit(lambda: self._warn(
                f'grasp {given.name} has lost the cloth, which pulled harder than its max_force: '
                'grasp again, and move it more slowly or give it a higher max_force'))
        if isinstance(given, Reset):
            self._frames.forget()
            self._time.restart(time)
        if isinstance(given, (TakeGrasp, Release, Reset)):
            names = [grasp.name for grasp in self._simulation.grasps]
            self._device.emit(lambda: self._follow(names))

    def parameters(self, parameters: Sequence[Parameter]) -> None:
        """Report parameters of the running node that were changed."""
        # The mode has a message of its own, which has the previous mode as well.
        values = {
            parameter.name: plain_value(parameter) for parameter in parameters
            if parameter.name != 'mode'}
        if not values:
            return
        number, now, epoch = self._recording.number, self._simulation.time, self._base.epoch
        message = parameters_message(
            values, FIELDS, now, self._node_name, is_change=True, epoch=epoch)
        self._device.emit(lambda: self._outlet.send(
            'inputs/parameters', lambda: serialise_parameter_event(message), now, number=number,
            epoch=epoch))

    def time_base(self, before: int) -> None:
        """Report that the present moment had the stamp ``before`` [ns], and has another now."""
        number, now, epoch = self._recording.number, self._simulation.time, self._base.epoch
        after = self._base.at(now)
        self._device.emit(lambda: self._recording.rewind(before, number, after))
        if epoch != self._told_epoch:
            self._told_epoch = epoch
            message = self._base.message(now)
            self._device.emit(lambda: self._outlet.send_message(
                'inputs/time_base', message, now, number=number, epoch=epoch))

    def _send_frame(self, frame: FrameContent, number: int, is_published: bool) -> None:
        if not is_published:
            frame = replace(frame, keys=frozenset(filter(self._recording.takes, frame.keys)))
        for key, data in self._messages.of(frame):
            self._outlet.send_bytes(
                key, data, frame.time, number=number, to_topic=is_published, epoch=frame.epoch)

    def _check_pins(self) -> None:
        """Warn once when there are too many pins to report what each of them feels."""
        simulation = self._simulation
        wanted = any(self._values[name] for name in _WITH_PINS)
        pins = int(np.count_nonzero(
            simulation.pinned_nodes() & ~simulation.grasped_nodes())) if wanted else 0
        reason = too_many_pins(pins)
        if reason and not self._reason:
            self._device.emit(lambda: self._warn(reason))
        self._reason = reason
