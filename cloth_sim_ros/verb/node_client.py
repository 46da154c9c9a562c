# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""A running cloth_sim node, as a verb sees it."""

from collections.abc import Callable
import os
import sys
import time
from typing import Any

from cloth_sim_interfaces.srv import SetMode
from cloth_sim_ros.files.errors import cut
from cloth_sim_ros.files.errors import shown
from cloth_sim_ros.node.interfaces import check_interfaces
from cloth_sim_ros.node.refusals import no_node
from cloth_sim_ros.sim.errors import ClothSimError
import rclpy
from rclpy._rclpy_pybind11 import RCLError
from rclpy.client import Client
from rclpy.context import Context
from rclpy.exceptions import InvalidTopicNameException
from rclpy.executors import SingleThreadedExecutor
from rclpy.node import Node
from rclpy.qos import QoSProfile
from rclpy.validate_full_topic_name import validate_full_topic_name

_LOOK_AGAIN = 0.05
_SETTLE = 0.1
_LONG = 0.5
_TELL_AGAIN = 1.0  # [s]
_DEPTH = 10


class NodeClient:
    """
    Call services and read topics of one node; a context manager.

    :param node: name of the node, with its namespace
    :param timeout: wall seconds to wait for an answer
    """

    def __init__(self, node: str, timeout: float) -> None:
        """Join the graph."""
        self._target = f'/{node.lstrip("/")}'
        try:
            validate_full_topic_name(self._target)
        except InvalidTopicNameException as error:
            raise ClothSimError(
                f'{shown(node)} is not a node name: give the name with its namespace, as in '
                '--node left/cloth_sim') from error
        self._timeout = timeout
        check_interfaces()
        # In a context of its own, rclpy leaves the signals alone: Ctrl-C works as in any command.
        self._context = Context()
        try:
            rclpy.init(args=[], context=self._context)
            self._node = Node(
                f'cloth_sim_verb_{os.getpid()}', context=self._context,
                start_parameter_services=False, enable_rosout=False)
        except RCLError as error:
            raise no_node(error) from error
        self._executor = SingleThreadedExecutor(context=self._context)
        self._executor.add_node(self._node)
        self._clients: dict[str, Client] = {}

    def __enter__(self) -> 'NodeClient':
        """Return itself."""
        return self

    def __exit__(self, *_: object) -> None:
        """Leave the graph."""
        self._executor.shutdown()
        self._node.destroy_node()
        rclpy.try_shutdown(context=self._context)

    def call(
            self, kind: type, name: str, request: Any, *, patient: bool = False,
            waiting: str = '') -> Any:
        """
        Return the answer of the node's service ``name``.

        :param patient: True to wait for as long as the node is there
        :param waiting: to be printed on stderr when the answer takes long
        :raises ClothSimError: when no answer comes, or when it says that the request failed
        """
        response = self.ask(kind, name, request, patient=patient, waiting=waiting)
        if not response.success:
            raise ClothSimError(response.message)
        return response

    def ask(
            self, kind: type, name: str, request: Any, *, patient: bool = False,
            waiting: str = '') -> Any:
        """Return the same, from a service whose answer does not say whether it failed."""
        client = self._client(kind, name)
        deadline = time.monotonic() + self._timeout
        future = client.call_async(request)
        asked = time.monotonic()
        while not future.done():
            if waiting and time.monotonic() > asked + _LONG:
                print(waiting, file=sys.stderr, flush=True)
                waiting = ''
            if patient and client.service_is_ready():
                deadline = time.monotonic() + self._timeout
            self._wait(deadline, f'{cut(self._target)}/{name} does not respond')
        return future.result()

    def tell(
            self, kind: type, name: str, message: Any, echo: str,
            is_taken: Callable[[Any], bool]) -> None:
        """
        Publish ``message`` on the node's topic ``name`` until the node says that it has taken it.

        :param kind: of the messages on both topics
        :param echo: name of the topic on which the node repeats what it takes
        :raises ClothSimError: when it does not
        """
        taken: list[Any] = []
        publisher = self._node.create_publisher(kind, f'{self._target}/{name}', _DEPTH)
        subscription = self._node.create_subscription(
            kind, f'{self._target}/{echo}', taken.append, _DEPTH)
        deadline = time.monotonic() + self._timeout
        while not (publisher.get_subscription_count() and subscription.get_publisher_count()):
            self._wait(deadline, f'no node listens to {cut(self._target)}/{name}')
        again = time.monotonic()
        while not any(map(is_taken, taken)):
            # The first is lost if the node has not learned of this publisher yet.
            if time.monotonic() >= again:
                publisher.publish(message)
                again = time.monotonic() + _TELL_AGAIN
            self._wait(deadline, f'{cut(self._target)} has not taken what is on {name}')
        self._node.destroy_subscription(subscription)
        self._node.destroy_publisher(publisher)

    def read(
            self, kind: type, name: str, quality: QoSProfile,
            until: Callable[[Any], bool] = lambda message: True) -> Any:
        """
        Return the first message of the node's topic ``name`` that ``until`` likes.

        :raises ClothSimError: when no message comes
        """
        received: list[Any] = []
        subscription = self._node.create_subscription(
            kind, f'{self._target}/{name}', received.append, quality)
        deadline = time.monotonic() + self._timeout
        while True:
            while received:
                message = received.pop(0)
                if until(message):
                    self._node.destroy_subscription(subscription)
                    return message
                deadline = time.monotonic() + self._timeout
            self._wait(deadline, f'no message arrives on {cut(self._target)}/{name}')

    def _client(self, kind: type, name: str) -> Client:
        if name not in self._clients:
            client = self._node.create_client(kind, f'{self._target}/{name}')
            deadline = time.monotonic() + self._timeout
            while not client.service_is_ready():
                self._wait(deadline, f'no node offers {cut(self._target)}/{name}')
            # The node has to learn of this client, too, or its answer gets lost.
            self._executor.spin_once(timeout_sec=_SETTLE)
            self._clients[name] = client
        return self._clients[name]

    def _wait(self, deadline: float, problem: str) -> None:
        if time.monotonic() > deadline:
            raise ClothSimError(f'{problem} within {self._timeout:g} s: {self._way_out()}')
        self._executor.spin_once(timeout_sec=_LOOK_AGAIN)

    def _way_out(self) -> str:
        kind = f'{SetMode.__module__.split(".")[0]}/srv/{SetMode.__name__}'
        found = sorted(
            name.rpartition('/')[0]
            for name, kinds in self._node.get_service_names_and_types()
            # A name without a server is that of a client, such as this one.
            if kind in kinds and self._node.count_services(name))
        if self._target in found:
            return 'it may be busy, so raise --timeout'
        if found:
            return f'name the node with --node, there is {", ".join(found)}'
        return 'start one with `cloth_sim_node`, or name it with --node'
