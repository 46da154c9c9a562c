# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""Where every message leaves the node, to its topic and into the recording; inputs as well."""

from collections.abc import Callable
from collections.abc import Collection
from collections.abc import Sequence
from typing import Any
from typing import Protocol

from cloth_sim_ros.messages.inputs import command_message
from cloth_sim_ros.messages.inputs import frame_target_message
from cloth_sim_ros.messages.inputs import grasp_message
from cloth_sim_ros.messages.inputs import mode_message
from cloth_sim_ros.messages.inputs import parameters_message
from cloth_sim_ros.messages.inputs import pin_message
from cloth_sim_ros.messages.inputs import pin_target_message
from cloth_sim_ros.messages.inputs import push_message
from cloth_sim_ros.messages.inputs import release_message
from cloth_sim_ros.messages.inputs import serialise_parameter_event
from cloth_sim_ros.messages.inputs import wind_message
from cloth_sim_ros.messages.topics import TOPICS
from cloth_sim_ros.node.parameters import FIELDS
from cloth_sim_ros.node.parameters import plain_value
from cloth_sim_ros.node.recording_session import RecordingSession
from cloth_sim_ros.sim.frame_paths import FrameMove
from cloth_sim_ros.sim.grasps import Grasp
from cloth_sim_ros.sim.pins import PinMove
from cloth_sim_ros.sim.push import Push
from cloth_sim_ros.sim.simulation import Simulation
from rclpy.node import Node
from rclpy.parameter import Parameter
from rclpy.publisher import Publisher
from rclpy.qos import DurabilityPolicy
from rclpy.qos import QoSProfile
from rclpy.qos import ReliabilityPolicy
from rclpy.serialization import serialize_message


class Outlet:
    """
    Publish and record messages, serialised once, and only those that somebody reads.

    :param heard_here: the topics to which the node itself subscribes, once
    """

    def __init__(
            self, node: Node, recording: RecordingSession,
            heard_here: Collection[str] = ()) -> None:
        """Make the publishers of every topic but /clock, which may belong to somebody else."""
        self._heard_here = heard_here
        self._recording = recording
        self._node = node
        self._publishers: dict[str, Publisher] = {}
        for key in TOPICS:
            if key != 'clock':
                self.open_topic(key)

    def open_topic(self, key: str) -> None:
        """Make the publisher of the topic ``key``."""
        topic = TOPICS[key]
        self._publishers[key] = self._node.create_publisher(
            topic.message, topic.name, _quality(topic))

    def close_topic(self, key: str) -> None:
        """Take the publisher of the topic ``key`` back."""
        self._node.destroy_publisher(self._publishers.pop(key))

    def is_open(self, key: str) -> bool:
        """Tell whether the topic ``key`` has a publisher here."""
        return key in self._publishers

    def wanted(self, key: str, *, by_recording: bool = True) -> bool:
        """Tell whether anybody reads the topic ``key`` now."""
        return (by_recording and self._recording.takes(key)) or self._subscribed(key)

    def send(
            self, key: str, serialise: Callable[[], bytes], sim_time: float, *,
            to_recording: bool = True) -> None:
        """
        Publish and record what ``serialise`` makes, if anybody reads it.

        :param sim_time: [s]
        :param to_recording: False for what has been sent before
        """
        # What is kept for late subscribers has readers that are not there yet.
        is_kept = TOPICS[key].transient_local
        if not is_kept and not self.wanted(key, by_recording=to_recording):
            return
        data = serialise()
        # The recording first: a publish fails when the node is being shut down.
        if to_recording and self._recording.takes(key):
            self._recording.write(key, data, sim_time)
        if key in self._publishers:
            self._publishers[key].publish(data)

    def send_message(
            self, key: str, message: Any, sim_time: float, *, to_recording: bool = True) -> None:
        """Do the same with a ROS message object; for messages that are small."""
        self.send(
            key, lambda: serialize_message(message), sim_time, to_recording=to_recording)

    def _subscribed(self, key: str) -> bool:
        publisher = self._publishers.get(key)
        return publisher is not None and (
            publisher.get_subscription_count() > int(key in self._heard_here))


def _quality(topic: Any) -> QoSProfile:
    return QoSProfile(
        depth=topic.depth,
        reliability=ReliabilityPolicy.RELIABLE if topic.reliable
        else ReliabilityPolicy.BEST_EFFORT,
        durability=DurabilityPolicy.TRANSIENT_LOCAL if topic.transient_local
        else DurabilityPolicy.VOLATILE)


class MessageSink(Protocol):
    """What takes messages to topics, a recording, or both."""

    def send(self, key: str, serialise: Callable[[], bytes], sim_time: float) -> None:
        """Take what ``serialise`` returns, of the topic ``key``, at ``sim_time`` [s]."""

    def send_message(self, key: str, message: Any, sim_time: float) -> None:
        """Take ``message`` of the topic ``key`` at ``sim_time`` [s]."""


class Inputs:
    """
    Send each input as a message, stamped with the simulated time at which it acts.

    :param node_name: with its namespace
    """

    def __init__(
            self, outlet: MessageSink, simulation: Simulation, frame_id: str,
            node_name: str) -> None:
        """Keep the parts the messages are made of."""
        self._outlet = outlet
        self._simulation = simulation
        self._frame_id = frame_id
        self._node_name = node_name

    def push(self, push: Push) -> None:
        """Tell that ``push`` was accepted."""
        now = self._simulation.stepping.edit_time
        self._outlet.send_message('inputs/push', push_message(push, now, self._frame_id), now)

    def pin(self, row: int, col: int, pinned: bool) -> None:
        """Tell that a node was pinned or released."""
        now = self._simulation.stepping.edit_time
        self._outlet.send_message(
            'inputs/pin', pin_message(row, col, pinned, now, self._frame_id), now)

    def pin_target(self, move: PinMove) -> None:
        """Tell that a pin sets off."""
        now = self._simulation.stepping.edit_time
        self._outlet.send_message(
            'inputs/pin_target', pin_target_message(move, now, self._frame_id), now)

    def grasp(self, grasp: Grasp) -> None:
        """Tell that nodes are held."""
        now = self._simulation.stepping.edit_time
        self._outlet.send_message('inputs/grasp', grasp_message(grasp, now, self._frame_id), now)

    def grasp_release(self, name: str, by_force: bool) -> None:
        """Tell that nodes are let go; ``by_force``: as the cloth has pulled too hard."""
        now = self._simulation.stepping.edit_time
        self._outlet.send_message(
            'inputs/grasp', release_message(name, by_force, now, self._frame_id), now)

    def grasp_move(self, move: FrameMove) -> None:
        """Tell that a grasp sets off."""
        self._frame_move('inputs/grasp_target', move)

    def collider_move(self, move: FrameMove) -> None:
        """Tell that a collider sets off."""
        self._frame_move('inputs/collider_target', move)

    def wind(self, velocity: Sequence[float]) -> None:
        """Tell that another steady wind blows [m/s]."""
        now = self._simulation.stepping.edit_time
        self._outlet.send_message(
            'inputs/wind', wind_message(velocity, now, self._frame_id), now)

    def mode(self, mode: str, previous: str) -> None:
        """Tell that the mode was switched."""
        now = self._simulation.stepping.edit_time
        self._outlet.send_message(
            'inputs/mode', mode_message(mode, previous, now, self._frame_id), now)

    def command(self, command: str) -> None:
        """Tell that Command.RESET or Command.CLEAR_PUSHES is about to be carried out."""
        now = self._simulation.stepping.edit_time
        self._outlet.send_message(
            'inputs/command', command_message(command, now, self._frame_id), now)

    def parameters(self, parameters: Sequence[Parameter]) -> None:
        """Tell that parameters of the running node were changed."""
        # The mode has a message of its own, which also says what it was before.
        values = {
            parameter.name: plain_value(parameter) for parameter in parameters
            if parameter.name != 'mode'}
        if values:
            now = self._simulation.stepping.edit_time
            message = parameters_message(values, FIELDS, now, self._node_name, is_change=True)
            self._outlet.send(
                'inputs/parameters', lambda: serialise_parameter_event(message), now)

    def _frame_move(self, key: str, move: FrameMove) -> None:
        now = self._simulation.stepping.edit_time
        self._outlet.send_message(key, frame_target_message(move, now, self._frame_id), now)
