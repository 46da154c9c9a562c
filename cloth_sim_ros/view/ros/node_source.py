# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""A running node as a source: its topics are shown, requests go to its services."""

from collections.abc import Callable
from collections.abc import Sequence
from dataclasses import replace
import os
from threading import Event
from threading import Thread
from typing import Any

from builtin_interfaces.msg import Time
from cloth_sim_interfaces.msg import ClothState
from cloth_sim_interfaces.msg import TimeBase
from cloth_sim_interfaces.srv import ApplyPush
from cloth_sim_interfaces.srv import MovePin
from cloth_sim_interfaces.srv import SetMode
from cloth_sim_interfaces.srv import SetPin
from cloth_sim_interfaces.srv import Step
from cloth_sim_ros.analysis.frame import Frame
from cloth_sim_ros.messages.frame_names import collider_frame
from cloth_sim_ros.node.frame_tree import checked_pose
from cloth_sim_ros.node.frame_tree import read_transforms
from cloth_sim_ros.node.interfaces import check_interfaces
from cloth_sim_ros.node.refusals import no_node
from cloth_sim_ros.sim.errors import ClothSimError
from cloth_sim_ros.sim.model.colliders import Collider
from cloth_sim_ros.sim.model.colliders import colliders_of
from cloth_sim_ros.sim.model.colliders import NAMES
from cloth_sim_ros.sim.model.named_fields import all_fields
from cloth_sim_ros.view.source import Moment
from cloth_sim_ros.view.source import Source
from geometry_msgs.msg import Point
from geometry_msgs.msg import Vector3
from rcl_interfaces.srv import GetParameters
import rclpy
from rclpy._rclpy_pybind11 import RCLError
from rclpy.client import Client
from rclpy.context import Context
from rclpy.exceptions import InvalidTopicNameException
from rclpy.executors import SingleThreadedExecutor
from rclpy.node import Node
from rclpy.parameter import parameter_value_to_python
from rclpy.qos import DurabilityPolicy
from rclpy.qos import QoSProfile
from rclpy.validate_full_topic_name import validate_full_topic_name
from sensor_msgs.msg import PointCloud2
from std_srvs.srv import SetBool
from std_srvs.srv import Trigger
from tf2_msgs.msg import TFMessage


class NodeColliders:
    """
    Learns of the colliders of a node, in callbacks of ``node``.

    A node without colliders is asked once, and /tf is left alone.

    :param node: this program's own place in the graph
    :param name: of the node that has the colliders, with its namespace
    """

    def __init__(self, node: Node, name: str) -> None:
        """Ask for them."""
        self._node = node
        self._name = name
        self._client = node.create_client(GetParameters, f'{name}/get_parameters')
        self._by_frame: dict[str, Collider] = {}
        self._is_asked = False

    @property
    def present(self) -> tuple[Collider, ...]:
        """Return the colliders where they were last; none before it is known."""
        return tuple(self._by_frame.values())

    def ask(self) -> None:
        """Ask the node for its colliders, once, as soon as it answers requests."""
        if not self._is_asked and self._client.service_is_ready():
            self._is_asked = True
            self._get([NAMES], self._ask_for_each)

    def _ask_for_each(self, values: dict[str, Any]) -> None:
        if not values[NAMES]:
            return
        names = [
            field.name for field in all_fields(values)
            if field.name.startswith('colliders.')]
        self._get(names, self._begin)

    def _begin(self, values: dict[str, Any]) -> None:
        self._by_frame = {
            collider_frame(self._name, collider.name): collider
            for collider in colliders_of(values)}
        self._node.create_subscription(TFMessage, '/tf', self._take, 10, raw=True)

    def _take(self, data: bytes) -> None:
        try:
            for frame, _, _, place in read_transforms(data):
                if frame in self._by_frame:
                    pose = checked_pose(frame, place)
                    self._by_frame[frame] = replace(
                        self._by_frame[frame], position=pose.position,
                        orientation=pose.orientation)
        except ClothSimError:
            # The topic is everybody's.
            pass

    def _get(self, names: list[str], take: Callable[[dict[str, Any]], None]) -> None:
        def answer(future: Any) -> None:
            values = [parameter_value_to_python(value) for value in future.result().values]
            try:
                take(dict(zip(names, values)))
            except (ClothSimError, KeyError, TypeError):
                # A node of another version lacks them; its cloth is shown without.
                self._by_frame = {}

        self._client.call_async(GetParameters.Request(names=names)).add_done_callback(answer)


_SERVICES = {
    'set_mode': SetMode, 'pause': SetBool, 'step': Step, 'reset': Trigger,
    'apply_push': ApplyPush, 'set_pin': SetPin, 'move_pin': MovePin}


class NodeSource(Source):
    """
    Shows ~/points, ~/state and the colliders of a node, and calls its services.

    :param node: name of the node, with its namespace
    :param timeout: wall seconds to wait for its first message, and for an answer
    :raises ClothSimError: when the node is not there
    """

    can_act = True

    def __init__(self, node: str, timeout: float) -> None:
        """Join the graph, and return when the node has told its state."""
        self.name = f'/{node.strip("/")}'
        try:
            validate_full_topic_name(self.name)
        except InvalidTopicNameException as error:
            raise ClothSimError(
                f'{self.name} is not a node name: give the name with its namespace, as in --node '
                'left/cloth_sim') from error
        self._timeout = timeout
        self._cloud: PointCloud2 | None = None
        self._state: ClothState = ClothState()  # until one has come
        self._moment: Moment | None = None
        self._shown_cloud = self._shown_state = None
        self._epoch = Time()
        self._told = Event()
        # The calls that wait for an answer, which none gets once the view has ended.
        self._waiting: set[Event] = set()
        self._has_ended = False
        check_interfaces()
        # In a context of its own, rclpy leaves the signals alone: Ctrl-C works as in any command.
        self._context = Context()
        try:
            rclpy.init(args=[], context=self._context)
            self._node = Node(
                f'cloth_sim_view_{os.getpid()}', context=self._context,
                start_parameter_services=False, enable_rosout=False)
        except RCLError as error:
            raise no_node(error) from error
        self._colliders = NodeColliders(self._node, self.name)
        self._subscribe()
        self._clients: dict[str, Client] = {
            name: self._node.create_client(kind, f'{self.name}/{name}')
            for name, kind in _SERVICES.items()}
        self._executor = SingleThreadedExecutor(context=self._context)
        self._executor.add_node(self._node)
        self._is_spinning = True
        self._thread = Thread(target=self._spin, daemon=True)
        self._thread.start()
        if not self._told.wait(timeout):
            self.close()
            raise ClothSimError(
                f'no message arrives on {self.name}/state within {timeout:g} s: start a node with '
                '`cloth_sim_node`, or name it with --node')
        self.modes = tuple(self._state.available_modes)

    def latest(self) -> Moment | None:
        """Return the latest moment; None before the first points."""
        cloud, state, colliders = self._cloud, self._state, self._colliders.present
        if cloud is None:
            return None
        known = self._moment
        if known is None or cloud is not self._shown_cloud or (
                state is not self._shown_state or colliders != known.frame.colliders):
            self._shown_cloud, self._shown_state = cloud, state
            frame = Frame.from_points(
                self._simulated(cloud.header.stamp), cloud, colliders=colliders)
            note = f'compiling mode {state.preparing}' if state.preparing else ''
            self._moment = Moment(frame, state.mode, state.run_state, note)
        return self._moment

    def set_paused(self, is_paused: bool) -> None:
        """Pause or resume the time."""
        self._call('pause', SetBool.Request(data=is_paused))

    def set_mode(self, mode: str) -> None:
        """Step with ``mode`` as soon as it is compiled."""
        if mode != self._state.mode:
            self._call('set_mode', SetMode.Request(mode=mode, wait=False))

    def step(self, count: int) -> None:
        """Make ``count`` steps of dt while paused."""
        self._call('step', Step.Request(steps=count))

    def reset(self) -> None:
        """Go back to the start."""
        self._call('reset', Trigger.Request())

    def push(
            self, force: Sequence[float], center: Sequence[float], radius: float,
            duration: float) -> None:
        """Push the nodes within ``radius`` of ``center`` [m] with ``force`` [N] in all."""
        self._call('apply_push', ApplyPush.Request(
            force=Vector3(**dict(zip('xyz', force))), region='sphere', center=_point(center),
            radius=radius, duration=duration))

    def hold(self, row: int, col: int) -> None:
        """Pin the node (row, col) where it is."""
        self._call('set_pin', SetPin.Request(row=row, col=col))

    def release(self, row: int, col: int) -> None:
        """Release the node (row, col)."""
        self._call('set_pin', SetPin.Request(row=row, col=col, release=True))

    def move_pin(self, row: int, col: int, target: Sequence[float]) -> None:
        """Let the pin (row, col) move to ``target`` [m]."""
        self._call('move_pin', MovePin.Request(row=row, col=col, target=_point(target)))

    def close(self) -> None:
        """Leave the graph; calls that still wait for an answer raise ClothSimError."""
        # An executor shut down while it spins may wait on, without what would wake it.
        if self._thread.is_alive():
            self._executor.create_task(self._stop_spinning)
        self._thread.join()
        self._executor.shutdown()
        self._has_ended = True
        for answered in tuple(self._waiting):
            answered.set()
        self._node.destroy_node()
        rclpy.try_shutdown(context=self._context)

    def _spin(self) -> None:
        while self._is_spinning:
            self._executor.spin_once()

    def _stop_spinning(self) -> None:
        self._is_spinning = False

    def _subscribe(self) -> None:
        # The newest alone is shown: a slow browser must not be behind.
        self._node.create_subscription(
            PointCloud2, f'{self.name}/points', self._take_cloud, QoSProfile(depth=1))
        self._node.create_subscription(
            ClothState, f'{self.name}/state', self._take_state,
            QoSProfile(depth=1, durability=DurabilityPolicy.TRANSIENT_LOCAL))

        self._node.create_subscription(
            TimeBase, f'{self.name}/inputs/time_base', self._take_time_base,
            QoSProfile(depth=1, durability=DurabilityPolicy.TRANSIENT_LOCAL))

    def _simulated(self, stamp: Time) -> float:
        """Return the simulated time of ``stamp`` [s]."""
        epoch = self._epoch
        return stamp.sec - epoch.sec + 1e-9 * (stamp.nanosec - epoch.nanosec)

    def _take_time_base(self, base: TimeBase) -> None:
        self._epoch = base.epoch

    def _take_cloud(self, cloud: PointCloud2) -> None:
        self._colliders.ask()
        self._cloud = cloud

    def _take_state(self, state: ClothState) -> None:
        self._state = state
        self._colliders.ask()
        self._told.set()

    def _call(self, name: str, request: Any) -> None:
        client = self._clients[name]
        if not client.wait_for_service(self._timeout):
            raise ClothSimError(f'no node offers {self.name}/{name}: is it still running?')
        answered = Event()
        self._waiting.add(answered)
        future = client.call_async(request)
        future.add_done_callback(lambda _: answered.set())
        is_in_time = self._has_ended or answered.wait(self._timeout)
        self._waiting.discard(answered)
        if not future.done():
            client.remove_pending_request(future)
            raise ClothSimError(
                f'{self.name}/{name} has not answered before this view ended'
                if is_in_time else
                f'{self.name}/{name} does not respond within {self._timeout:g} s: it may be busy, '
                'so raise --timeout')
        response = future.result()
        if not response.success:
            raise ClothSimError(response.message)


def _point(parts: Sequence[float]) -> Point:
    return Point(**dict(zip('xyz', map(float, parts))))
